// <strata-tour>: an introduction to a model's page, shown when a user opens the first model in this
// browser. A card explains one element at a time. The page stays usable. The keyboard focus stays
// in its position until the user moves it to the card.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { besideBar, type Box, type Size } from "../../ui/beside";
import { dockedIsOpen, modalIsOpen } from "../../ui/dialog";
import { followSession } from "../../session/follow-session";
import { hasKeyboard } from "../../ui/keyboard";
import type { ModelSession } from "../../session/model-session";
import { hasFingersOnly } from "../../ui/pointers";
import { keepTourOver, tourIsOver } from "../../ui/preferences";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import {
  kSteps,
  nearestStep,
  seenBox,
  stepsFor,
  thingOf,
  type StepName,
  type OnboardingTarget,
} from "./onboarding-steps";

const words = texts.tour;
const kGapPx = 12;
const kLargePx = 100; // the outline around a wider element is farther from the element
const kNarrow = "(max-width: 820px)"; // as in modelStyles

@customElement("strata-tour")
export class StrataOnboarding extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** Whether another dialog is open, so the introduction does not start automatically. */
  @property({ type: Boolean }) held = false;
  @state() private _step: StepName | null = null;
  @query("section") private _card!: HTMLElement | null;
  @query(".ring") private _ring!: HTMLElement | null;
  @query("button.primary") private _next!: HTMLButtonElement | null;
  private _opener: HTMLElement | null = null; // the focused element before the introduction started
  private _hasKeyboard = false;

  constructor() {
    super();
    followSession(this, "view", "comments");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: contents;
      }
      section {
        position: fixed;
        z-index: 9; /* above the page, and below menus and dialogs */
        display: grid;
        gap: var(--space-2);
        overflow-y: auto;
        width: min(25rem, calc(100vw - 1.5rem));
        padding: var(--space-3) var(--space-4) var(--space-3);
        border: var(--edge) solid var(--accent);
        border-radius: var(--radius);
        background: var(--raised);
        box-shadow: var(--shadow);
        animation: appear var(--fast);
      }
      @keyframes appear {
        from {
          opacity: 0;
        }
      }
      section.wide {
        width: min(32.5rem, calc(100vw - 1.5rem));
      }
      .head {
        align-items: baseline;
      }
      h2 {
        flex: 1;
        font-size: var(--text-large);
      }
      section > p {
        font-size: var(--text-small);
      }
      .choices {
        flex-wrap: wrap;
        justify-content: flex-end;
        gap: var(--space-2);
      }
      .choices button {
        min-height: 2.125rem;
        padding: 0 var(--space-3);
      }
      .choices .skip {
        margin: 0 auto 0 calc(-1 * var(--space-3));
        outline-offset: -3px; /* keeps the outline inside the card */
      }
      .ring {
        position: fixed;
        z-index: 8;
        border: 3px solid var(--accent);
        border-radius: var(--radius);
        pointer-events: none;
      }
      @media (pointer: coarse) {
        .choices button {
          min-height: var(--control-touch);
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    addEventListener("resize", this._moved);
    // receives the events of every scrolling element
    addEventListener("scroll", this._moved, { capture: true, passive: true });
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    removeEventListener("resize", this._moved);
    removeEventListener("scroll", this._moved, { capture: true });
  }
  private readonly _moved = (): void => {
    if (this._step !== null) this.requestUpdate();
  };

  /**
   * Starts on request. Moves the keyboard focus to the card; at the end, the focus returns to its
   * previous element.
   */
  async start(): Promise<void> {
    this._opener = hasKeyboard();
    this.go(kSteps[0]);
    await this.updateComplete;
    this._next?.focus({ preventScroll: true });
  }

  /** Ends the introduction permanently in this browser. Returns false if it was not running. */
  end(): boolean {
    if (this._step === null) return false;
    const { isAtKeyboard } = this;
    this._step = null;
    keepTourOver();
    if (isAtKeyboard && this._opener?.isConnected) this._opener.focus({ preventScroll: true });
    this._opener = null;
    return true;
  }

  override willUpdate(changed: PropertyValues<this>): void {
    super.willUpdate(changed);
    this._hasKeyboard = this.isAtKeyboard;
    if (this._step !== null) this._step = nearestStep(this._step, this.there());
    else if (this.mayBegin()) this.go(kSteps[0]);
  }

  private get isAtKeyboard(): boolean {
    return (this.shadowRoot?.activeElement ?? null) !== null;
  }

  private mayBegin(): boolean {
    const { session } = this;
    return (
      session.view.framesDrawn > 0 &&
      session.comments.card === null &&
      !this.held &&
      !modalIsOpen() &&
      !dockedIsOpen() &&
      !tourIsOver()
    );
  }

  private thing(name: StepName): OnboardingTarget | null {
    return thingOf(name, this.getRootNode() as ShadowRoot);
  }
  private there(): StepName[] {
    return stepsFor(this.session.canPaint).filter((name) => this.thing(name) !== null);
  }

  private go(name: StepName): void {
    this._step = nearestStep(name, this.there());
    const thing = this._step && this.thing(this._step);
    if (thing && !thing.isRoom) bringIntoBar(thing);
  }

  /** Shows the next or previous step. After the last step the introduction ends. */
  private step(by: 1 | -1): void {
    const there = this.there();
    const to = there[there.indexOf(this._step!) + by];
    if (to) this.go(to);
    else if (by === 1) this.end();
  }

  override render(): TemplateResult {
    const { _step: step } = this;
    const there = step === null ? [] : this.there();
    const thing = step === null ? null : this.thing(step);
    const text = step === null || !thing ? "" : this.text(step, thing);
    return html`<p class="visually-hidden" role="status">${step === null ? "" : `${words.steps[step].title}. ${text}`}</p>
      ${step === null || !thing ? nothing : this.card(step, text, there, thing)}`;
  }

  private card(
    step: StepName,
    text: string,
    there: readonly StepName[],
    thing: OnboardingTarget,
  ): TemplateResult {
    const at = there.indexOf(step);
    const last = at === there.length - 1;
    return html`${thing.isRoom ? nothing : html`<div class="ring" aria-hidden="true"></div>`}
      <section class=${thing.isRoom ? "wide" : ""} role="dialog" aria-modal="false" aria-labelledby="heading" aria-describedby="text" data-step=${step} @keydown=${this.onKey}>
        <div class="row head">
          <h2 id="heading">${words.steps[step].title}</h2>
          <span class="hint">${words.progress(at + 1, there.length)}</span>
        </div>
        <p id="text">${text}</p>
        <div class="row choices">
          ${last ? nothing : html`<button class="quiet skip" @click=${() => this.end()}>${words.skip}</button>`}
          ${at === 0 ? nothing : html`<button @click=${() => this.step(-1)}>${words.back}</button>`}
          <button class="primary" @click=${() => this.step(1)}>${last ? words.done : words.next}</button>
        </div>
      </section>`;
  }

  private text(step: StepName, { isWay }: OnboardingTarget): string {
    const hand = hasFingersOnly() ? "touch" : "mouse";
    switch (step) {
      case "layers": {
        const { way, paint, look } = words.steps.layers;
        return [isWay ? way : "", this.session.canPaint ? paint : look].filter(Boolean).join(" ");
      }
      case "share":
        return words.steps.share.text;
      default:
        return words.steps[step][hand];
    }
  }

  private onKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
    if (event.key === "Escape") this.end();
    else if (event.key === "ArrowRight") this.stepFromKey(1);
    else if (event.key === "ArrowLeft") this.stepFromKey(-1);
    else return;
    event.preventDefault();
  }

  /**
   * Arrow keys do not end the introduction, because one key press too many would close the card.
   */
  private stepFromKey(by: 1 | -1): void {
    const there = this.there();
    if (there[there.indexOf(this._step!) + by]) this.step(by);
  }

  override updated(): void {
    const { _card: card, _ring: ring, _step: step } = this;
    const thing = step === null ? null : this.thing(step);
    if (!card || !thing) return;
    // the focused button was removed
    if (this._hasKeyboard && !this.isAtKeyboard) this._next?.focus({ preventScroll: true });
    const box = seenBox(thing);
    card.style.maxHeight = ""; // measures the natural height
    const place = placeOf(thing, box, { width: card.offsetWidth, height: card.offsetHeight });
    Object.assign(card.style, {
      left: `${place.left}px`,
      top: `${place.top}px`,
      maxHeight: `${place.mostHeight}px`,
    });
    if (ring) {
      const around = box.width > kLargePx ? 9 : 4;
      const [x, y] = [Math.max(0, box.left - around), Math.max(0, box.top - around)];
      Object.assign(ring.style, {
        left: `${x}px`,
        top: `${y}px`,
        width: `${Math.min(innerWidth, box.left + box.width + around) - x}px`,
        height: `${Math.min(innerHeight, box.top + box.height + around) - y}px`,
      });
    }
  }
}

/** Scrolls the element into its bar if it is hidden or barely visible at the edge. */
function bringIntoBar(thing: OnboardingTarget): void {
  const enough = Math.min(thing.element.clientHeight, 0.8 * thing.bar.clientHeight);
  thing.element.scrollIntoView({
    block: seenBox(thing).height >= enough ? "nearest" : "start",
    inline: "nearest",
  });
}

/**
 * Positions the card next to the bar of the element. For the model, the card is at the top of the
 * stage, if the middle stays free. On phones it is at the bottom, near the hand.
 */
function placeOf(
  { bar, isRoom }: OnboardingTarget,
  thing: Box,
  card: Size,
): ReturnType<typeof besideBar> {
  const outer = bar.getBoundingClientRect();
  const free = outer.height - card.height - 2 * kGapPx;
  if (!isRoom || free < outer.height / 2)
    return besideBar(
      thing,
      isRoom ? thing : outer,
      card,
      { width: innerWidth, height: innerHeight },
      kGapPx,
    );
  const top = matchMedia(kNarrow).matches
    ? outer.bottom - kGapPx - card.height
    : outer.top + kGapPx;
  return { left: outer.left + (outer.width - card.width) / 2, top, mostHeight: card.height };
}
