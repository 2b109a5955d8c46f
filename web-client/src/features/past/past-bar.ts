// <strata-past-bar>: the history of the model at the lower edge of the 3D view. It has the slider
// and the authors of the state, and controls to play, compare and restore.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { called } from "../../domain/people";
import { formatArea } from "../../domain/measure";
import { labelOf } from "../../domain/cells";
import { toldTime } from "../../domain/times";
import { formatFixed } from "../../core/locale";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { icon } from "../../ui/icons";
import { personMark, personMarkStyles } from "../../ui/person-mark";
import { sharedStyles } from "../../ui/styles";
import { withKey } from "../../ui/keys/command-keys";
import { texts } from "../../texts";
import { ChangedArea } from "./changed-area";
import { kSpeeds } from "./past";
import { Snapshots } from "./snapshots";
import "./past-restore";
import "./past-slider";
import "./snapshot-list";
import { layersText, peopleText } from "./past-slider";

const words = texts.past;

@customElement("strata-past-bar")
export class StrataPastBar extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _restores = false;
  @state() private _listsSnapshots = false;
  private _snapshots!: Snapshots;
  private _snapshotChanges = 0;
  private _changed!: ChangedArea;
  /** The 3D view ends above the bar. */
  private readonly _observer = new ResizeObserver(() =>
    document.documentElement.style.setProperty("--past-height", `${this.offsetHeight}px`),
  );

  constructor() {
    super();
    followSession(this, "past", "layers");
  }

  static override styles = [
    sharedStyles,
    personMarkStyles,
    css`
      :host {
        position: absolute;
        z-index: 5;
        inset: auto 0 0;
        display: block;
      }
      section {
        display: grid;
        gap: var(--space-2);
        padding: var(--space-2) var(--space-3) var(--space-2);
        border-top: var(--edge) solid var(--line);
        background: var(--surface);
        color: var(--ink);
        box-shadow: var(--shadow);
      }
      .line {
        display: flex;
        flex-wrap: wrap;
        align-items: center;
        gap: var(--space-2) var(--space-2);
        min-width: 0;
      }
      .group {
        display: flex;
        align-items: center;
        gap: var(--space-1);
      }
      .state {
        display: flex;
        flex: 1 1 11rem;
        align-items: center;
        gap: var(--space-2);
        min-width: 0;
        min-height: 2.25rem;
      }
      .state > div {
        display: grid;
        min-width: 0;
      }
      .state small {
        font-size: var(--text-tiny);
        color: var(--ink-soft);
      }
      select {
        width: auto;
      }
      .group button:not(.icon) {
        padding-inline: var(--space-3);
        white-space: nowrap;
      }
      @media (max-width: 820px) {
        section {
          padding: var(--space-2) var(--space-2);
        }
        .state {
          order: -2;
          flex-basis: calc(100% - 3.5rem);
        }
        .close {
          order: -1;
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this._observer.observe(this);
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._observer.disconnect();
    if (this.hasUpdated) this._changed.stop();
    document.documentElement.style.removeProperty("--past-height");
  }

  override willUpdate(): void {
    if (this._snapshots) return;
    const { session } = this;
    this._snapshots = new Snapshots(session.api, session.modelId, {
      user: () => session.user,
      canCurate: () => session.canCurate,
      changed: () => this.requestUpdate(),
    });
    this._snapshotChanges = session.past.snapshotChanges;
    void this._snapshots.load();
    this._changed = new ChangedArea(session.lit, () => this.requestUpdate());
  }

  override updated(): void {
    const { layers, past } = this.session;
    if (this._snapshotChanges !== past.snapshotChanges) {
      this._snapshotChanges = past.snapshotChanges;
      void this._snapshots.load();
    }
    const visible = layers.all.filter((layer) => layers.visible(layer));
    this._changed.follow(
      past.changesFrom,
      visible.map(({ slug, sequence }) => ({ slug, sequence })),
    );
  }

  override render(): TemplateResult {
    const { past } = this.session;
    return html`<section
      aria-label=${words.title}
      @keydown=${(event: KeyboardEvent) => this.onKey(event)}
    >
      ${
        past.failed
          ? html`<div class="line">
            <p class="error" role="alert">${words.failed}</p>
            <button @click=${() => void past.load()}>${texts.try_again}</button>${this.closeButton()}
          </div>`
          : past.timeline === null
            ? html`<div class="line"><p class="hint" role="status">${texts.loading}</p>${this.closeButton()}</div>`
            : past.timeline.edits === 0 && !past.isZoomed
              ? html`<div class="line"><p class="hint">${words.none}</p>${this.closeButton()}</div>`
              : this.controls()
      }
    </section>`;
  }

  private controls(): TemplateResult {
    const { session } = this;
    const { past } = session;
    return html`<div class="line">
        <div class="group">
        <button class="icon quiet" aria-label=${words.previous} title=${words.previous} ?disabled=${past.at === 0} @click=${() => void past.goBy(false)}>
          ${icon("step_back")}
        </button>
        <button class="icon quiet" aria-label=${past.playing ? words.pause : words.play} title=${past.playing ? words.pause : words.play} @click=${() => past.togglePlay()}>
          ${icon(past.playing ? "pause" : "play")}
        </button>
        <button class="icon quiet" aria-label=${words.next} title=${words.next} ?disabled=${past.at === null} @click=${() => void past.goBy(true)}>
          ${icon("step_on")}
        </button>
        <select
          aria-label=${words.speed}
          title=${words.speed}
          @change=${(event: Event) => past.setSpeed(Number((event.target as HTMLSelectElement).value) as (typeof kSpeeds)[number])}
        >
          ${kSpeeds.map((speed) => html`<option value=${speed} ?selected=${speed === past.speed}>${formatFixed(speed, speed < 1 ? 1 : 0)}×</option>`)}
        </select>
        </div>
        <div class="state" role="status">${this.state()}</div>
        ${past.changesFrom === null ? nothing : html`<p class="hint" role="status">${this.changed()}</p>`}
        <div class="group">
          ${past.isActive ? html`<button class="primary" @click=${() => past.goNow()}>${words.back}</button>` : nothing}
          <button aria-expanded=${this._listsSnapshots} @click=${() => (this._listsSnapshots = !this._listsSnapshots)}>${texts.snapshots.title}</button>
          <button aria-pressed=${past.changesFrom !== null} ?disabled=${!past.isActive && past.changesFrom === null} @click=${() => past.setShowsChanges(past.changesFrom === null)}>${words.changes_show}</button>
          <button aria-pressed=${past.compares} title=${words.compare_hint} ?disabled=${!past.isActive} @click=${() => past.setCompares(!past.compares)}>${words.compare}</button>
          ${
            session.canPaint
              ? html`<button aria-expanded=${this._restores && past.isActive} ?disabled=${!past.isActive} @click=${() => this.toggleRestore()}>${words.restore}</button>`
              : nothing
          }
        </div>
        ${this.closeButton()}
      </div>
      ${
        this._restores && past.isActive
          ? html`<strata-past-restore .session=${session} @closed=${() => this.toggleRestore()}></strata-past-restore>`
          : nothing
      }
      ${
        this._listsSnapshots
          ? html`<strata-snapshot-list .session=${session} .snapshots=${this._snapshots}></strata-snapshot-list>`
          : nothing
      }
      <strata-past-slider .session=${session} .snapshots=${this._snapshots.all}></strata-past-slider>`;
  }

  private closeButton(): TemplateResult {
    return html`<button class="icon quiet close" aria-label=${words.close} title=${withKey(words.close, "past")} @click=${() => this.session.past.close()}>
      ${icon("close")}
    </button>`;
  }

  /** Renders the time, the authors and the kind of the state. */
  private state(): TemplateResult {
    const { session } = this;
    const { past } = session;
    if (past.at === null) return html`<div><b>${words.now}</b><small>${words.lead}</small></div>`;
    const { step, interval, time } = past;
    if (time === null) return html`<div><b>${words.before_first}</b></div>`;
    if (step && (!interval || step.last >= interval.first)) {
      const layer = session.layers.find(step.layer);
      const did =
        (texts.activity.done as Readonly<Record<string, string>>)[`edit ${step.op}`] ??
        texts.activity.done.other;
      return html`${personMark(step)}
        <div>
          <b class="ellipsis numeric">${toldTime(step.time)}</b>
          <small class="ellipsis">${called(step) || words.several} ${did} ${layer ? labelOf(layer) : ""}</small>
        </div>`;
    }
    return html`<div>
      <b class="ellipsis numeric">${toldTime(time)}</b>
      ${
        interval
          ? html`<small class="ellipsis">${[peopleText(interval), layersText(session, interval.layers)].filter(Boolean).join(" · ")}</small>`
          : nothing
      }
    </div>`;
  }

  private changed(): string {
    const { measured, problem } = this._changed;
    if (problem) return problem;
    if (!measured) return texts.loading;
    const { texels, area_m2: areaM2, share } = measured;
    return texels === 0
      ? words.changes_none
      : words.changes_area(
          formatArea(areaM2),
          `${formatFixed(share * 100, share < 0.01 ? 2 : 1)} %`,
        );
  }

  private toggleRestore(): void {
    this._restores = !this._restores;
    this.session.past.setPart(null);
  }

  private onKey(event: KeyboardEvent): void {
    if (event.key !== "Escape" || event.defaultPrevented) return;
    event.preventDefault();
    if (this.session.past.isActive) this.session.past.goNow();
    else this.session.past.close();
  }
}
