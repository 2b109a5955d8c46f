// <strata-tour>: the first time somebody opens a model at this browser, a card beside one thing
// after the other says what it is for. It takes nothing away: all that is there can be used
// meanwhile, and the keyboard stays where it is until somebody goes to the card.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { beside_bar, type Box, type Size } from "../../ui/beside";
import { docked_is_open, modal_is_open } from "../../ui/dialog";
import { follow_session } from "../../session/follow-session";
import { has_keyboard } from "../../ui/keyboard";
import type { ModelSession } from "../../session/model-session";
import { has_fingers_only } from "../../ui/pointers";
import { keep_tour_over, tour_is_over } from "../../ui/preferences";
import { shared_styles } from "../../ui/styles";
import { texts } from "../../texts";
import {
  kSteps,
  nearest_step,
  seen_box,
  steps_for,
  thing_of,
  type StepName,
  type TourThing,
} from "./onboarding-steps";

const words = texts.tour;
const kGap_px = 12;
const kLarge_px = 100; // things that get room within their ring
const kNarrow = "(max-width: 820px)"; // as in model_styles

@customElement("strata-tour")
export class StrataTour extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** The page asks something else now: the tour does not begin by itself. */
  @property({ type: Boolean }) held = false;
  @state() private step_: StepName | null = null;
  @query("section") private card_!: HTMLElement | null;
  @query(".ring") private ring_!: HTMLElement | null;
  @query("button.primary") private next_!: HTMLButtonElement | null;
  private opener_: HTMLElement | null = null; // had the keyboard before
  private has_keyboard_ = false;

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    css`
      :host {
        display: contents;
      }
      section {
        position: fixed;
        z-index: 9; /* over everything of the page, under menus and dialogs */
        display: grid;
        gap: 0.5rem;
        overflow-y: auto;
        width: min(25rem, calc(100vw - 1.5rem));
        padding: 0.875rem 1rem 0.75rem;
        border: var(--edge) solid var(--accent);
        border-radius: var(--radius);
        background: var(--raised);
        box-shadow: var(--shadow);
        animation: appear 160ms;
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
        font-size: 1.08rem;
      }
      section > p {
        font-size: 0.92rem;
      }
      .choices {
        flex-wrap: wrap;
        justify-content: flex-end;
        gap: 0.375rem;
      }
      .choices button {
        min-height: 2.125rem;
        padding: 0 0.75rem;
      }
      .choices .skip {
        margin: 0 auto 0 -0.75rem;
        outline-offset: -3px; /* within the card */
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
          min-height: 2.75rem;
        }
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    addEventListener("resize", this.moved_);
    // of whatever scrolls
    addEventListener("scroll", this.moved_, { capture: true, passive: true });
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    removeEventListener("resize", this.moved_);
    removeEventListener("scroll", this.moved_, { capture: true });
  }
  private readonly moved_ = (): void => {
    if (this.step_ !== null) this.requestUpdate();
  };

  /** Because somebody asked for it: it has the keyboard, and gives it back. */
  async start(): Promise<void> {
    this.opener_ = has_keyboard();
    this.go(kSteps[0]);
    await this.updateComplete;
    this.next_?.focus({ preventScroll: true });
  }

  /** For good: at this browser it does not begin by itself again. False: there was none. */
  end(): boolean {
    if (this.step_ === null) return false;
    const { is_at_keyboard } = this;
    this.step_ = null;
    keep_tour_over();
    if (is_at_keyboard && this.opener_?.isConnected) this.opener_.focus({ preventScroll: true });
    this.opener_ = null;
    return true;
  }

  override willUpdate(changed: PropertyValues<this>): void {
    super.willUpdate(changed);
    this.has_keyboard_ = this.is_at_keyboard;
    if (this.step_ !== null) this.step_ = nearest_step(this.step_, this.there());
    else if (this.may_begin()) this.go(kSteps[0]);
  }

  private get is_at_keyboard(): boolean {
    return (this.shadowRoot?.activeElement ?? null) !== null;
  }

  private may_begin(): boolean {
    const { session } = this;
    return (
      session.view.frames_drawn > 0 &&
      session.comments.card === null &&
      !this.held &&
      !modal_is_open() &&
      !docked_is_open() &&
      !tour_is_over()
    );
  }

  private thing(name: StepName): TourThing | null {
    return thing_of(name, this.getRootNode() as ShadowRoot);
  }
  private there(): StepName[] {
    return steps_for(this.session.can_paint).filter((name) => this.thing(name) !== null);
  }

  private go(name: StepName): void {
    this.step_ = nearest_step(name, this.there());
    const thing = this.step_ && this.thing(this.step_);
    if (thing && !thing.is_room) bring_into_bar(thing);
  }

  /** To the step after or before; past the last one it is over. */
  private step(by: 1 | -1): void {
    const there = this.there();
    const to = there[there.indexOf(this.step_!) + by];
    if (to) this.go(to);
    else if (by === 1) this.end();
  }

  override render(): TemplateResult {
    const { step_: step } = this;
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
    thing: TourThing,
  ): TemplateResult {
    const at = there.indexOf(step);
    const last = at === there.length - 1;
    return html`${thing.is_room ? nothing : html`<div class="ring" aria-hidden="true"></div>`}
      <section class=${thing.is_room ? "wide" : ""} role="dialog" aria-modal="false" aria-labelledby="heading" aria-describedby="text" data-step=${step} @keydown=${this.on_key}>
        <div class="row head">
          <h2 id="heading">${words.steps[step].title}</h2>
          <span class="hint numeric">${words.progress(at + 1, there.length)}</span>
        </div>
        <p id="text">${text}</p>
        <div class="row choices">
          ${last ? nothing : html`<button class="quiet skip" @click=${() => this.end()}>${words.skip}</button>`}
          ${at === 0 ? nothing : html`<button @click=${() => this.step(-1)}>${words.back}</button>`}
          <button class="primary" @click=${() => this.step(1)}>${last ? words.done : words.next}</button>
        </div>
      </section>`;
  }

  private text(step: StepName, { is_way }: TourThing): string {
    const hand = has_fingers_only() ? "touch" : "mouse";
    switch (step) {
      case "layers": {
        const { way, paint, look } = words.steps.layers;
        return [is_way ? way : "", this.session.can_paint ? paint : look].filter(Boolean).join(" ");
      }
      case "share":
        return words.steps.share.text;
      default:
        return words.steps[step][hand];
    }
  }

  private on_key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.altKey || event.metaKey || event.shiftKey) return;
    if (event.key === "Escape") this.end();
    else if (event.key === "ArrowRight") this.step_from_key(1);
    else if (event.key === "ArrowLeft") this.step_from_key(-1);
    else return;
    event.preventDefault();
  }

  /** The arrows end nothing: one too many would take the card away. */
  private step_from_key(by: 1 | -1): void {
    const there = this.there();
    if (there[there.indexOf(this.step_!) + by]) this.step(by);
  }

  override updated(): void {
    const { card_: card, ring_: ring, step_: step } = this;
    const thing = step === null ? null : this.thing(step);
    if (!card || !thing) return;
    // the button that had it is gone
    if (this.has_keyboard_ && !this.is_at_keyboard) this.next_?.focus({ preventScroll: true });
    const box = seen_box(thing);
    card.style.maxHeight = ""; // as high as it would like to be
    const place = place_of(thing, box, { width: card.offsetWidth, height: card.offsetHeight });
    Object.assign(card.style, {
      left: `${place.left}px`,
      top: `${place.top}px`,
      maxHeight: `${place.most_height}px`,
    });
    if (ring) {
      const around = box.width > kLarge_px ? 9 : 4;
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

/** What was scrolled out of it, or is hardly seen at its end. */
function bring_into_bar(thing: TourThing): void {
  const enough = Math.min(thing.element.clientHeight, 0.8 * thing.bar.clientHeight);
  thing.element.scrollIntoView({
    block: seen_box(thing).height >= enough ? "nearest" : "start",
    inline: "nearest",
  });
}

/**
 * Beside the bar of the thing; of the model at the upper edge of its stage (on phones the lower
 * one, which is nearer to the hand), where that leaves it the middle.
 */
function place_of(
  { bar, is_room }: TourThing,
  thing: Box,
  card: Size,
): ReturnType<typeof beside_bar> {
  const outer = bar.getBoundingClientRect();
  const free = outer.height - card.height - 2 * kGap_px;
  if (!is_room || free < outer.height / 2)
    return beside_bar(
      thing,
      is_room ? thing : outer,
      card,
      { width: innerWidth, height: innerHeight },
      kGap_px,
    );
  const top = matchMedia(kNarrow).matches
    ? outer.bottom - kGap_px - card.height
    : outer.top + kGap_px;
  return { left: outer.left + (outer.width - card.width) / 2, top, most_height: card.height };
}
