// <strata-kiosk-player>: an image, sound or video of a stop over the whole screen, with large
// controls in the lower half. The tap that opens a sound or video also starts it. Nothing plays
// without a tap.

import { css, html, LitElement, nothing, svg, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { styled } from "../ui/styled";
import type { KioskSession } from "./kiosk-session";
import type { ShownMedium } from "./media";

const playSign = svg`<svg viewBox="0 0 24 24" aria-hidden="true"><path d="M7 4.5v15l12-7.5z" fill="currentColor" /></svg>`;
const pauseSign = svg`<svg viewBox="0 0 24 24" aria-hidden="true"><path d="M7 5h3.4v14H7zM13.6 5H17v14h-3.4z" fill="currentColor" /></svg>`;

const clock = (seconds: number): string =>
  `${Math.floor(seconds / 60)}:${String(Math.floor(seconds % 60)).padStart(2, "0")}`;

@customElement("strata-kiosk-player")
export class StrataKioskPlayer extends LitElement {
  @property({ attribute: false }) session!: KioskSession;
  @property({ attribute: false }) medium!: ShownMedium;
  @property() language = "";
  @state() private _atS = 0;
  @state() private _lengthS = 0;
  @state() private _playing = false;
  @state() private _failed = false;
  @query("video, audio") private _media!: HTMLMediaElement | null;

  static override styles = css`
    :host {
      position: fixed;
      inset: 0;
      z-index: 5;
      display: flex;
      flex-direction: column;
      gap: var(--gap);
      padding: var(--rim);
      background: rgb(12 15 15 / 0.96);
      color: #f4f1ea;
    }
    .seen {
      flex: 1;
      min-height: 0;
      display: grid;
      place-items: center;
    }
    img,
    video {
      max-width: 100%;
      max-height: 100%;
      min-height: 0;
      border-radius: calc(var(--round) / 3);
    }
    video {
      width: 100%;
      height: 100%;
      object-fit: contain;
    }
    video::cue {
      font: 600 1em var(--sans);
      background: rgb(0 0 0 / 0.72);
    }
    p {
      flex: none;
      max-height: 22dvh;
      max-width: 46em;
      margin: 0;
      overflow: auto;
      align-self: center;
      text-align: center;
      white-space: pre-line;
      overflow-wrap: anywhere;
    }
    .title {
      font: 600 1.9em/1.4 var(--heading); /* with a smaller line height, the text would scroll */
    }
    .controls {
      flex: none;
      display: flex;
      flex-wrap: wrap;
      align-items: center;
      gap: var(--gap);
    }
    button {
      display: inline-flex;
      align-items: center;
      justify-content: center;
      gap: 0.4em;
      min-width: calc(1.6 * var(--target));
      min-height: var(--target);
      padding: 0.3em 1em;
      border: 2px solid rgb(255 255 255 / 0.35);
      border-radius: 99px;
      background: none;
      color: inherit;
      font: 600 1em/1.2 var(--sans);
      touch-action: manipulation;
    }
    button.main {
      border-color: var(--accent);
      background: var(--accent);
      color: var(--accent-ink);
    }
    :is(button, input):focus-visible {
      outline: 4px solid #fff;
      outline-offset: 3px;
    }
    svg {
      width: 1.5em;
      height: 1.5em;
    }
    .time {
      font-variant-numeric: tabular-nums;
    }
    /* The control is as high as a finger. The visible line is only the middle of the control. */
    input {
      flex: 1 1 12em;
      min-width: 8em;
      height: var(--target);
      margin: 0;
      appearance: none;
      background: none;
    }
    input::-webkit-slider-runnable-track {
      height: 0.5em;
      border-radius: 99px;
      background: linear-gradient(
        to right,
        var(--accent) var(--share),
        rgb(255 255 255 / 0.3) var(--share)
      );
    }
    input:dir(rtl)::-webkit-slider-runnable-track {
      background: linear-gradient(
        to left,
        var(--accent) var(--share),
        rgb(255 255 255 / 0.3) var(--share)
      );
    }
    input::-moz-range-track {
      height: 0.5em;
      border-radius: 99px;
      background: rgb(255 255 255 / 0.3);
    }
    input::-moz-range-progress {
      height: 0.5em;
      border-radius: 99px;
      background: var(--accent);
    }
    input::-webkit-slider-thumb {
      appearance: none;
      width: 1.7em;
      height: 1.7em;
      margin-top: -0.6em;
      border: 0;
      border-radius: 50%;
      background: #fff;
    }
    .close {
      margin-inline-start: auto;
    }
  `;

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._media?.pause(); // a removed element may continue to play for a moment
  }

  /** Focuses the first control. */
  override focus(): void {
    this.renderRoot.querySelector<HTMLElement>("button")?.focus({ preventScroll: true });
  }

  override firstUpdated(): void {
    // Browsers permit sound after a touch. If a browser does not, the visitor presses Play.
    void this._media?.play().catch(() => (this._playing = false));
  }

  override render(): TemplateResult {
    const { medium, session } = this;
    const { words } = session;
    return html`<div class="seen">${this.content()}</div>
      ${medium.kind !== "sound" && medium.caption ? html`<p>${medium.caption}</p>` : nothing}
      ${this._failed ? html`<p role="alert">${words.not_playable}</p>` : nothing}
      <div class="controls">
        ${medium.kind === "picture" || this._failed ? nothing : this.controls()}
        <button class="close" @click=${() => session.showMedium(null)}>${words.close}</button>
      </div>`;
  }

  private content(): TemplateResult {
    const { medium } = this;
    if (medium.kind === "picture")
      return html`<img src=${medium.url} alt=${medium.alt} draggable="false" @error=${this.onFailed} />`;
    const tracks = repeat(
      medium.subtitles,
      ({ url }) => url,
      ({ url, language }) =>
        html`<track kind="subtitles" src=${url} srclang=${language} ?default=${language === this.language} />`,
    );
    return medium.kind === "video"
      ? html`<video src=${medium.url} aria-label=${medium.alt} playsinline preload="metadata" disablepictureinpicture @play=${this.onPlay} @pause=${this.onPause} @timeupdate=${this.onTime} @durationchange=${this.onTime} @error=${this.onFailed} @click=${this.toggle}>${tracks}</video>`
      : html`<p class="title">${medium.caption || medium.alt}</p>
          <audio src=${medium.url} preload="metadata" @play=${this.onPlay} @pause=${this.onPause} @timeupdate=${this.onTime} @durationchange=${this.onTime} @error=${this.onFailed}></audio>`;
  }

  private controls(): TemplateResult {
    const { words } = this.session;
    const share = this._lengthS > 0 ? (100 * this._atS) / this._lengthS : 0;
    return html`<button class="main" @click=${this.toggle}>
        ${this._playing ? pauseSign : playSign}${this._playing ? words.pause : words.play}
      </button>
      <input
        type="range"
        min="0"
        max=${Math.max(1, Math.ceil(this._lengthS))}
        step="1"
        aria-label=${words.position}
        aria-valuetext=${clock(this._atS)}
        .value=${String(Math.round(this._atS))}
        ${styled({ "--share": `${share.toFixed(1)}%` })}
        @input=${(event: Event) => this.seek(Number((event.target as HTMLInputElement).value))}
      />
      <span class="time" aria-hidden="true">${clock(this._atS)} / ${clock(this._lengthS)}</span>`;
  }

  private readonly toggle = (): void => {
    const { _media: media } = this;
    if (media?.paused) void media.play().catch(() => {});
    else media?.pause();
  };
  private seek(toS: number): void {
    if (this._media) this._media.currentTime = toS;
  }
  private readonly onPlay = (): void => void (this._playing = true);
  private readonly onPause = (): void => void (this._playing = false);
  private readonly onTime = (): void => {
    const { _media: media } = this;
    if (!media) return;
    this._atS = media.currentTime;
    this._lengthS = Number.isFinite(media.duration) ? media.duration : 0;
    // Visitors who watch do not touch the screen, so playing restarts the idle time.
    if (!media.paused) this.session.touched();
  };
  private readonly onFailed = (): void => void (this._failed = true);
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-kiosk-player": StrataKioskPlayer;
  }
}
