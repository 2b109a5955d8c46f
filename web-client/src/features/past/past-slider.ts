// <strata-past-slider>: the edits of the model over time as bars, with a handle at the displayed
// state.

import { css, html, LitElement, nothing, svg, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { marksOf } from "../../domain/snapshot-marks";
import { intervalAtPlace, placeOfTime } from "../../domain/timeline";
import { called } from "../../domain/people";
import { formatList } from "../../core/locale";
import { labelOf } from "../../domain/cells";
import { toldDate, toldTime } from "../../domain/times";
import type { Snapshot, TimelineInterval } from "../../core/protocol.gen";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { icon } from "../../ui/icons";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";

const words = texts.past;
const kHeight = 100; // the height of the drawing
const kLeast = 0.14; // share of the height for an interval with one edit

/** Returns a text such as "Ada, Ben and 2 more". */
export function peopleText({
  people,
  others,
}: Pick<TimelineInterval, "people" | "others">): string {
  const names = people.map((person) => called(person));
  return formatList(others > 0 ? [...names, words.others(others)] : names);
}

/** Returns the names of the layers. Omits layers that were deleted later. */
export const layersText = (session: ModelSession, layers: readonly number[]): string =>
  formatList(
    layers.flatMap((id) => {
      const layer = session.layers.find(id);
      return layer ? [labelOf(layer)] : [];
    }),
  );

@customElement("strata-past-slider")
export class StrataPastSlider extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** The snapshots, shown as marks above the bars. */
  @property({ attribute: false }) snapshots: readonly Snapshot[] = [];
  @state() private _hover: TimelineInterval | null = null;
  private _drags = false;

  constructor() {
    super();
    followSession(this, "past", "layers");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: block;
        min-width: 0;
      }
      .track {
        position: relative;
        height: 2.75rem;
        border-radius: var(--radius-small);
        background: var(--paper);
        cursor: ew-resize;
        touch-action: none;
      }
      .track > svg {
        position: absolute;
        inset: 0;
        width: 100%;
        height: 100%;
        overflow: visible;
        pointer-events: none;
      }
      .bar {
        stroke: var(--ink-soft);
        stroke-width: 3px;
        vector-effect: non-scaling-stroke;
      }
      .bar.later {
        opacity: 0.4;
      }
      .marks {
        position: relative;
        height: 1.5rem;
        overflow: hidden;
      }
      .marks button {
        position: absolute;
        display: flex;
        align-items: center;
        gap: var(--space-half);
        min-height: 1.5rem;
        padding: 0 var(--space-1);
        border: 0;
        border-inline-start: 2px solid var(--accent);
        border-radius: 0;
        background: none;
        font-size: var(--text-tiny);
        font-weight: 400;
      }
      .marks button.ends-here {
        border-inline: 0 2px solid var(--accent);
        transform: translateX(-100%);
      }
      .marks button[aria-current="true"] {
        background: var(--accent-soft);
        font-weight: 600;
      }
      .handle {
        position: absolute;
        top: -0.25rem;
        bottom: -0.25rem;
        width: 3px;
        transform: translateX(-50%);
        border-radius: var(--radius-tiny);
        background: var(--accent);
        pointer-events: none;
      }
      .handle::before {
        content: "";
        position: absolute;
        top: 50%;
        left: 50%;
        width: 1rem;
        height: 1.5rem;
        border: 2px solid var(--surface);
        border-radius: var(--radius-small);
        background: var(--accent);
        transform: translate(-50%, -50%);
      }
      .ends {
        display: flex;
        justify-content: space-between;
        gap: var(--space-2);
        margin-top: var(--space-half);
        font-size: var(--text-tiny);
        color: var(--ink-soft);
        white-space: nowrap;
      }
      .ends,
      .zoom {
        align-items: center;
      }
      .zoom {
        display: flex;
      }
      .zoom button {
        width: 1.75rem;
        height: 1.75rem;
        min-height: 0;
      }
      @media (hover: none) {
        .zoom button {
          width: 2.5rem;
          height: 2.5rem;
        }
      }
      .ends .hover {
        min-width: 0;
        color: var(--ink);
      }
    `,
  ];

  override render(): TemplateResult {
    const { past } = this.session;
    const { timeline } = past;
    if (!timeline) return html``;
    const { intervals } = timeline;
    const most = Math.max(1, ...intervals.map(({ edits }) => edits));
    const shown = past.at ?? Infinity;
    const marks = marksOf(timeline, this.snapshots);
    return html`${
      marks.length > 0
        ? html`<div class="marks">
            ${marks.map(
              ({ snapshot, place, room }) =>
                html`<button
                class="quiet ${place > 0.8 ? "ends-here" : ""}"
                aria-label=${words.state_named(snapshot.name)}
                aria-current=${past.at === snapshot.sequence}
                title=${snapshot.name}
                ${styled({ left: `${place * 100}%`, "max-width": `${room * 100}%` })}
                @click=${() => past.goTo(snapshot.sequence)}
              >
                <span class="ellipsis">${snapshot.name}</span>
              </button>`,
            )}
          </div>`
        : nothing
    }
      <div
        class="track"
        role="slider"
        tabindex="0"
        aria-label=${words.slider}
        aria-valuemin="0"
        aria-valuemax=${past.newest}
        aria-valuenow=${past.at ?? past.newest}
        aria-valuetext=${this.valueText()}
        @pointerdown=${this.onDown}
        @pointermove=${this.onMove}
        @pointerup=${this.onUp}
        @pointercancel=${this.onUp}
        @pointerleave=${() => (this._hover = null)}
        @keydown=${this.onKey}
      >
        <svg viewBox="0 0 1000 ${kHeight}" preserveAspectRatio="none" aria-hidden="true">
          ${intervals.map((interval) => {
            const x = placeOfTime(timeline, interval.ended) * 1000;
            const height =
              (kLeast + (1 - kLeast) * Math.sqrt(interval.edits / most)) * kHeight * 0.9;
            const color = interval.people[0]?.color;
            return svg`<line class="bar ${interval.first > shown ? "later" : ""}" x1=${x} x2=${x} y1=${kHeight} y2=${kHeight - height}
              ${styled({ stroke: color ?? null })} />`;
          })}
        </svg>
        <div class="handle" ${styled({ left: `${past.place * 100}%` })}></div>
      </div>
      <div class="ends numeric">
        <span>${timeline.from === undefined ? "" : toldDate(timeline.from)}</span>
        ${this._hover ? html`<span class="hover ellipsis">${this.describe(this._hover)}</span>` : nothing}
        <span class="zoom">
          <button class="icon quiet" aria-label=${words.closer} title=${words.closer} @click=${() => void past.zoom(1 / 4)}>${icon("plus")}</button>
          <button class="icon quiet" aria-label=${words.farther} title=${words.farther} ?disabled=${!past.isZoomed} @click=${() => void past.zoom(4)}>${icon("minus")}</button>
          ${past.isZoomed && timeline.to !== undefined ? toldDate(timeline.to) : words.now}
        </span>
      </div>`;
  }

  private valueText(): string {
    const { past } = this.session;
    if (past.at === null) return words.now;
    const { time } = past;
    return time === null ? words.before_first : toldTime(time);
  }

  private describe(interval: TimelineInterval): string {
    return [
      toldTime(interval.ended),
      peopleText(interval),
      layersText(this.session, interval.layers),
      words.edits(interval.edits),
    ]
      .filter(Boolean)
      .join(" · ");
  }

  private placeOf(event: PointerEvent): number {
    const { left, width } = (event.currentTarget as HTMLElement).getBoundingClientRect();
    return width > 0 ? Math.min(1, Math.max(0, (event.clientX - left) / width)) : 1;
  }

  private readonly onDown = (event: PointerEvent): void => {
    if (event.button !== 0) return;
    (event.currentTarget as HTMLElement).setPointerCapture(event.pointerId);
    this._drags = true;
    this.session.past.stop();
    this.follow(event);
  };

  private readonly onMove = (event: PointerEvent): void => {
    const { timeline } = this.session.past;
    if (this._drags) this.follow(event);
    else if (timeline) this._hover = intervalAtPlace(timeline, this.placeOf(event));
  };

  private readonly onUp = (): void => {
    this._drags = false;
  };

  private follow(event: PointerEvent): void {
    const { past } = this.session;
    const { timeline } = past;
    if (!timeline) return;
    const place = this.placeOf(event);
    const interval = intervalAtPlace(timeline, place);
    this._hover = null;
    if (interval ? interval.last >= past.newest : timeline.intervals.length === 0) past.goNow();
    else if ((interval?.last ?? 0) !== past.at) past.goToInterval(interval);
  }

  private readonly onKey = (event: KeyboardEvent): void => {
    const { past } = this.session;
    const far = event.shiftKey || event.key.startsWith("Page");
    switch (event.key) {
      case "ArrowLeft":
      case "ArrowDown":
      case "PageDown":
        void past.goBy(false, far);
        break;
      case "ArrowRight":
      case "ArrowUp":
      case "PageUp":
        void past.goBy(true, far);
        break;
      case "Home":
        past.goTo(0);
        break;
      case "End":
        past.goNow();
        break;
      case " ":
      case "Enter":
        past.togglePlay();
        break;
      case "+":
        void past.zoom(1 / 4);
        break;
      case "-":
        void past.zoom(4);
        break;
      default:
        return;
    }
    event.preventDefault();
  };
}
