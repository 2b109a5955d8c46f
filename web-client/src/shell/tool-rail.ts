// <strata-tool-rail>: the tools, undo and redo.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { kChangingTools, kRailTools, type ToolName } from "../tools/tool";
import { followSession } from "../session/follow-session";
import { withKey } from "../ui/keys/command-keys";
import { icon } from "../ui/icons";
import type { OpenModelSession } from "./open-model-session";
import { hasPart } from "./page-parts";
import { ScrollFade } from "../ui/scroll-fade";
import { sharedStyles } from "../ui/styles";
import { texts } from "../texts";
import type { StepName } from "../features/onboarding/onboarding-steps";

/** The steps of the page's tour that point to tools. */
const kOfTour: Partial<Record<ToolName, StepName>> = { brush: "brush", pick: "values" };

@customElement("strata-tool-rail")
export class StrataToolRail extends LitElement {
  @property({ attribute: false }) session!: OpenModelSession;
  @state() private _showsSteps = false;
  @query(".steps") private _stepsButton!: HTMLElement;

  constructor() {
    super();
    followSession(this, "tools", "layers", "marks", "tables", "past");
    new ScrollFade(this);
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: flex;
        flex-direction: column;
        align-items: center;
        gap: var(--space-1);
        padding: var(--space-2) var(--space-2);
        background: var(--surface);
        border-right: var(--edge) solid var(--line);
      }
      button.icon {
        width: 2.625rem;
        min-height: 2.625rem;
      }
      button[aria-pressed="true"] {
        background: var(--accent);
        border-color: var(--accent);
        color: var(--accent-ink);
      }
      button[aria-pressed="true"]:hover:not(:disabled) {
        background: var(--accent);
      }
      .turns {
        display: contents;
      }
      button.icon.steps {
        min-height: 1.5rem;
      }
      .steps svg {
        transform: rotate(90deg);
      }
      hr {
        width: 1.75rem;
        margin: var(--space-1) 0;
        border: 0;
        border-top: var(--edge) solid var(--line);
      }
      @media (max-width: 820px) {
        :host {
          flex-direction: row;
          justify-content: safe center;
          overflow-x: auto;
          gap: var(--space-half);
          padding: var(--space-2);
          border-right: 0;
          border-top: var(--edge) solid var(--line);
          --fade: 2.125rem;
          --from: 0px;
          --to: 0px;
          --turns: 0px; /* width of the fixed part */
          /* keeps the focus visible */
          scroll-padding-inline: var(--fade) calc(var(--fade) + var(--turns));
        }
        :host([paints]) {
          --turns: calc(3 * 2.75rem + 1.125rem);
        }
        /* Undo and redo stay visible, and the tools scroll below them. */
        .turns {
          position: sticky;
          z-index: 1;
          right: 0;
          order: 1;
          display: flex;
          flex: none;
          align-items: center;
          justify-content: end;
          box-sizing: border-box;
          width: var(--turns);
          margin-right: calc(-1 * var(--space-2));
          padding-right: var(--space-2);
          background: var(--surface);
        }
        :host([more-before]) {
          --from: var(--fade);
        }
        :host([more-after]) {
          --to: var(--fade);
        }
        :host([more-before]),
        :host([more-after]) {
          mask-image: linear-gradient(to right, transparent, black var(--from), black calc(100% - var(--turns) - var(--to)), transparent calc(100% - var(--turns))),
            linear-gradient(to right, transparent calc(100% - var(--turns)), black calc(100% - var(--turns)));
        }
        hr {
          width: 0;
          height: 1.625rem;
          margin: 0 var(--space-1);
          border-left: var(--edge) solid var(--line);
          border-top: 0;
        }
        button.icon {
          flex: 1 1 0;
          width: auto;
          min-width: 2.125rem;
          max-width: 3.25rem;
        }
      }
    `,
  ];

  override willUpdate(): void {
    this.toggleAttribute("paints", this.session.canPaint);
  }

  override render(): TemplateResult {
    const { session } = this;
    const words = texts.model;
    const shown = kRailTools.filter((name) => this.shows(name));
    return html`${shown.map(
      (name) =>
        html`<button
            class="icon quiet"
            data-tour=${kOfTour[name] ?? nothing}
            aria-pressed=${session.tools.active === name}
            aria-label=${texts.tools[name]}
            title=${withKey(texts.tools[name], `tool.${name}`)}
            @click=${() => session.chooseTool(name)}
          >
            ${icon(name)}
          </button>`,
    )}
      ${
        session.canPaint
          ? html`<div class="turns">
            <hr />
            <button
              class="icon quiet"
              data-tour="undo"
              aria-label=${words.undo}
              title=${withKey(words.undo, "undo")}
              ?disabled=${!session.layers.selected}
              @click=${() => session.undo()}
            >
              ${icon("undo")}
            </button>
            <button
              class="icon quiet"
              aria-label=${words.redo}
              title=${withKey(words.redo, "redo")}
              ?disabled=${!session.layers.selected}
              @click=${() => session.redo()}
            >
              ${icon("redo")}
            </button>
            <button
              class="icon quiet steps"
              aria-label=${texts.steps.title}
              title=${texts.steps.title}
              aria-haspopup="dialog"
              aria-expanded=${this._showsSteps}
              @click=${() => (this._showsSteps = true)}
            >
              ${icon("chevron")}
            </button>
            ${
              this._showsSteps && hasPart("past", this)
                ? html`<strata-step-list .session=${session} .anchor=${this._stepsButton} @closed=${() => (this._showsSteps = false)}></strata-step-list>`
                : nothing
            }
          </div>`
          : nothing
      }
      <hr />
      <button
        class="icon quiet"
        aria-label=${texts.past.title}
        aria-pressed=${session.past.isOpen}
        title=${withKey(texts.past.title, "past")}
        @click=${() => session.past.toggle()}
      >
        ${icon("history")}
      </button>`;
  }

  /**
   * Whether the tool is shown. The line and point tools are shown only if the layer's table has
   * columns for lines or points.
   */
  private shows(name: ToolName): boolean {
    const { session } = this;
    if (kChangingTools.includes(name) && !session.canPaint) return false;
    return (
      (name !== "line" && name !== "point") ||
      session.tools.active === name ||
      session.marks.column(name) !== null
    );
  }
}
