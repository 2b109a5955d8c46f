// <strata-picture-bar>: the bar over the 3D view, with the view cube, fit to view, light, section
// and parts. The controls of the last three open next to the bar. They stay open while the user
// works on the model.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { Kept } from "../../core/kept";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { icon, type IconName } from "../../ui/icons";
import "../../ui/menu";
import { sharedStyles } from "../../ui/styles";
import { keyCapsOf, withKey, type KeyedCommand } from "../../ui/keys/command-keys";
import { texts } from "../../texts";
import { kStandardViews } from "../../math/view-cube";
import "./light-controls";
import "./section-controls";
import "./view-cube";

const words = texts.picture_bar;

/** The controls that open next to the bar, in the order of its buttons. */
const kParts = {
  light: {
    glyph: "bulb",
    key: "light.next",
    content: (session: ModelSession) =>
      html`<strata-light-controls .session=${session}></strata-light-controls>`,
    isOn: ({ appearance }: ModelSession) => appearance.light.mode !== "museum",
  },
  section: {
    glyph: "section",
    key: "section.next",
    content: (session: ModelSession) =>
      html`<strata-section-controls .session=${session}></strata-section-controls>`,
    isOn: ({ appearance }: ModelSession) => appearance.section.mode !== "off",
  },
  // Only for models that were imported from several scans.
  model_parts: {
    glyph: "parts",
    key: null,
    content: (session: ModelSession) =>
      html`<strata-part-tree .session=${session}></strata-part-tree>`,
    isOn: ({ appearance }: ModelSession) => appearance.hiddenParts.size > 0,
  },
} satisfies Record<
  string,
  {
    glyph: IconName;
    key: KeyedCommand | null;
    content(session: ModelSession): TemplateResult;
    isOn(session: ModelSession): boolean;
  }
>;
type Part = keyof typeof kParts;

@customElement("strata-picture-bar")
export class StrataPictureBar extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  /** Whether the model has parts, and <strata-part-tree> is loaded. */
  @property({ attribute: false }) hasParts = false;
  private readonly _open = new Kept<Part[]>(() => localStorage, "strata.picture_bar", []);

  constructor() {
    super();
    followSession(this, "appearance", "view");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: flex;
        flex-direction: row-reverse;
        align-items: flex-start;
        gap: var(--space-2);
        pointer-events: none;
      }
      /* the controls scroll if a tall table leaves little space; the padding shows their shadows */
      .column,
      .beside {
        box-sizing: border-box;
        max-height: calc(100% + 2rem);
        margin: calc(-1 * var(--space-4));
        padding: var(--space-4);
        overflow: hidden auto;
        scrollbar-width: thin;
      }
      .column {
        display: grid;
        flex: none;
        justify-items: center;
        gap: var(--space-2);
      }
      .column > *,
      section {
        pointer-events: auto;
      }
      .bar,
      section {
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
        box-shadow: var(--shadow);
      }
      .bar {
        display: grid;
        gap: var(--space-half);
        padding: var(--space-1);
      }
      .bar button[aria-expanded="true"] {
        background: var(--accent-soft);
      }
      .bar button.on {
        background: var(--accent);
        color: var(--accent-ink);
      }
      section {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-2);
        box-sizing: border-box;
        padding: var(--space-2) var(--space-3) var(--space-3);
      }
      .beside {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-2);
        width: 22.5rem; /* includes the space for shadows */
        min-width: 0;
      }
      section .row {
        justify-content: space-between;
      }
      h2 {
        font-size: var(--text-large);
      }
      section button.icon {
        width: 1.75rem;
        min-height: var(--control-small);
      }
      kbd {
        margin-left: auto;
        padding-left: var(--space-4);
        color: var(--ink-soft);
        font: var(--text-tiny) var(--mono);
      }
    `,
  ];

  override render(): TemplateResult {
    const { session } = this;
    const names = (Object.keys(kParts) as Part[]).filter(
      (part) => part !== "model_parts" || this.hasParts,
    );
    const open = names.filter((part) => this._open.value.includes(part));
    return html`<div class="column">
        <strata-view-cube .session=${session}></strata-view-cube>
        <div class="bar" role="toolbar" aria-label=${words.title} aria-orientation="vertical">
          <button class="icon quiet" aria-label=${texts.views.first} title=${withKey(texts.views.first, "view.first")} @click=${() => session.view.flyToFirst()}>
            ${icon("home")}
          </button>
          <button class="icon quiet" aria-label=${texts.views.fit} title=${withKey(texts.views.fit, "view.fit")} @click=${() => session.view.fit()}>
            ${icon("fit")}
          </button>
          ${this.viewMenu()} ${names.map((part) => this.button(part))}
        </div>
      </div>
      ${open.length > 0 ? html`<div class="beside">${open.map((part) => this.controls(part))}</div>` : nothing}`;
  }

  private button(part: Part): TemplateResult {
    const { glyph, key } = kParts[part];
    const isOn = kParts[part].isOn(this.session);
    const label = texts.view[part];
    return html`<button
      class="icon quiet ${isOn ? "on" : ""}"
      aria-label=${label}
      data-part=${part}
      aria-expanded=${this._open.value.includes(part)}
      title=${key ? withKey(label, key) : label}
      @click=${() => this.toggle(part)}
    >
      ${icon(glyph)}
    </button>`;
  }

  private controls(part: Part): TemplateResult {
    const close = words.close(texts.view[part]);
    return html`<section aria-label=${texts.view[part]} @keydown=${(event: KeyboardEvent) => this.onKey(event, part)}>
      <div class="row">
        <h2>${texts.view[part]}</h2>
        <button class="icon quiet" aria-label=${close} title=${close} @click=${() => this.toggle(part)}>${icon("close")}</button>
      </div>
      ${kParts[part].content(this.session)}
    </section>`;
  }

  private viewMenu(): TemplateResult {
    const { view } = this.session;
    return html`<strata-menu label=${texts.model.view} glyph="cube">
      ${kStandardViews.map(
        (each) =>
          html`<button class="quiet" role="menuitem" @click=${() => view.standardView(each)}>${texts.views[each]}<kbd>${keyCapsOf(`view.${each}`)}</kbd></button>`,
      )}
      <hr />
      ${this.projection(true, texts.views.perspective)} ${this.projection(false, texts.views.orthographic)}
    </strata-menu>`;
  }

  private projection(perspective: boolean, label: string): TemplateResult {
    const { view } = this.session;
    const isChosen = view.camera.perspective === perspective;
    return html`<button class="quiet" role="menuitemradio" aria-checked=${isChosen} @click=${() => view.setPerspective(perspective)}>
      ${label}${isChosen ? icon("check") : nothing}<kbd>${keyCapsOf(perspective ? "view.perspective" : "view.orthographic")}</kbd>
    </button>`;
  }

  private onKey(event: KeyboardEvent, part: Part): void {
    if (event.key !== "Escape") return;
    event.preventDefault();
    this.toggle(part);
    this.renderRoot.querySelector<HTMLElement>(`[data-part="${part}"]`)?.focus();
  }

  private toggle(part: Part): void {
    const open = this._open.value;
    this._open.value = open.includes(part) ? open.filter((each) => each !== part) : [...open, part];
    this.requestUpdate();
  }
}
