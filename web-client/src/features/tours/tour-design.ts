// <strata-tour-design>: the appearance of a tour on kiosks: a light or dark room, colors, font and
// logo, with a preview. It refuses colors that visitors could not read.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { formatNumber } from "../../domain/measure";
import type { TourFile, TourFont, TourMode, TourTheme } from "../../core/protocol.gen";
import { kModeColors, modeOf, problemOfTheme, propertiesOf } from "../../domain/tour-theme";
import type { ModelSession } from "../../session/model-session";
import { icon } from "../../ui/icons";
import { radioGroup } from "../../ui/radio-group";
import { styled } from "../../ui/styled";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "./tour-file-add";

const words = texts.tours;
const kModes: readonly TourMode[] = ["light", "dark"];
const kFonts: readonly TourFont[] = ["serif", "sans"];

@customElement("strata-tour-design")
export class StrataTourDesign extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @property({ attribute: false }) tour: number | null = null;
  @property({ attribute: false }) theme: TourTheme = {};
  @property({ attribute: false }) files: readonly TourFile[] = [];
  @property() heading = ""; // the heading of the preview
  /** The text of the server's refusal. */
  @property() problem = "";

  static override styles = [
    sharedStyles,
    css`
      summary {
        padding: var(--space-2) 0;
        font-weight: 600;
        cursor: pointer;
      }
      .parts {
        display: grid;
        grid-template-columns: minmax(0, 1fr) minmax(12rem, 16rem);
        gap: var(--space-4) var(--space-6);
        padding: var(--space-2) 0 var(--space-1);
      }
      .fields {
        display: grid;
        align-content: start;
        gap: var(--space-3);
        min-width: 0;
      }
      .pair {
        display: grid;
        grid-template-columns: repeat(auto-fit, minmax(11rem, 1fr));
        gap: var(--space-3);
      }
      .color {
        display: flex;
        align-items: center;
        gap: var(--space-2);
      }
      input[type="color"] {
        width: 3rem;
        height: 2.375rem;
        padding: var(--space-half);
      }
      .segments {
        justify-self: start;
      }
      /* the same variables as on the kiosk */
      .preview {
        display: grid;
        grid-template-rows: 5.5rem auto;
        overflow: hidden;
        align-self: start;
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: linear-gradient(var(--room-top), var(--room) 60%);
        color: var(--ink);
      }
      .preview .stage {
        padding: var(--space-3);
      }
      .preview img {
        max-width: 60%;
        max-height: 2.5rem;
      }
      .preview .sheet {
        display: grid;
        gap: var(--space-2);
        justify-items: start;
        padding: var(--space-4);
        border-radius: var(--radius-large) var(--radius-large) 0 0;
        background: var(--surface);
      }
      .preview b {
        font-family: var(--heading);
        font-size: var(--text-title-2);
        font-weight: 600;
        line-height: 1.15;
        overflow-wrap: anywhere;
      }
      .preview i {
        padding: var(--space-2) var(--space-4);
        border-radius: var(--radius-round);
        background: var(--accent);
        color: var(--accent-ink);
        font-style: normal;
        font-weight: 600;
      }
      @media (max-width: 760px) {
        .parts {
          grid-template-columns: minmax(0, 1fr);
        }
      }
    `,
  ];

  override render(): TemplateResult {
    const { theme, session, tour, files } = this;
    const logo = files.find(({ id }) => id === theme.logo);
    const refusal = this.refusal();
    return html`<details ?open=${refusal !== ""}>
      <summary>${words.design}</summary>
      <div class="parts">
        <div class="fields">
          ${radioGroup<TourMode>({
            label: words.mode,
            class: "segments",
            choices: kModes.map((value) => ({ value, content: words.modes[value] })),
            chosen: modeOf(theme),
            choose: (mode) => this.change({ mode, background: undefined, accent: undefined }),
          })}
          <div class="pair">
            ${this.color("background", words.background)} ${this.color("accent", words.accent)}
          </div>
          ${refusal ? html`<p class="error" role="alert">${refusal}</p>` : nothing}
          ${radioGroup<TourFont>({
            label: words.font,
            class: "segments",
            choices: kFonts.map((value) => ({ value, content: words.fonts[value] })),
            chosen: theme.font ?? "serif",
            choose: (font) => this.change({ font }),
          })}
          <span class="caption">${words.logo}</span>
          ${
            logo
              ? html`<div class="color">
                    <span>${logo.name}</span>
                    <button type="button" class="icon quiet" aria-label=${texts.ordered_choice.remove(logo.name)} @click=${() => this.change({ logo: undefined })}>${icon("trash")}</button>
                  </div>
                  <label class="field">
                    <span>${words.logo_alt}</span>
                    <input type="text" maxlength="200" .value=${theme.logo_alt ?? ""} @input=${(event: Event) => this.change({ logo_alt: (event.target as HTMLInputElement).value })} />
                  </label>`
              : html`<strata-tour-file-add .session=${session} .tour=${tour} label=${words.logo_add} accept=".png,.webp,.jpg,.jpeg" @added=${({ detail }: CustomEvent<TourFile>) => this.takeLogo(detail)}></strata-tour-file-add>`
          }
        </div>
        <div class="preview" role="img" aria-label=${words.design_preview} ${styled(propertiesOf(theme))}>
          <div class="stage">${logo && tour !== null ? html`<img src=${session.tours.addressOf(tour, logo.id)} alt="" />` : nothing}</div>
          <div class="sheet"><b>${this.heading || words.name_hint}</b><i>${words.preview_button}</i></div>
        </div>
      </div>
    </details>`;
  }

  private color(member: "background" | "accent", label: string): TemplateResult {
    const { theme } = this;
    const wrong = problemOfTheme(theme)?.field === member;
    return html`<label class="field">
      <span>${label}</span>
      <span class="color">
        <input type="color" aria-invalid=${wrong ? "true" : "false"} .value=${theme[member] ?? kModeColors[modeOf(theme)][member]} @input=${(event: Event) => this.change({ [member]: (event.target as HTMLInputElement).value })} />
        ${
          theme[member] === undefined
            ? nothing
            : html`<button type="button" class="quiet" @click=${() => this.change({ [member]: undefined })}>${words.color_default}</button>`
        }
      </span>
    </label>`;
  }

  private refusal(): string {
    const problem = problemOfTheme(this.theme);
    if (!problem) return this.problem;
    const [now, needed] = [
      formatNumber(Math.floor(problem.contrast * 10) / 10, 2),
      formatNumber(problem.needed, 2),
    ];
    return problem.field === "background" && problem.needed > 3
      ? words.background_wrong(now, needed)
      : words.accent_wrong(now, needed);
  }

  private takeLogo(file: TourFile): void {
    this.dispatchEvent(
      new CustomEvent<TourFile>("file", { detail: file, bubbles: true, composed: true }),
    );
    this.change({ logo: file.id });
  }

  private change(change: { [member in keyof TourTheme]?: TourTheme[member] | undefined }): void {
    const theme = Object.fromEntries(
      Object.entries({ ...this.theme, ...change }).filter(([, value]) => value !== undefined),
    ) as TourTheme;
    this.dispatchEvent(new CustomEvent<TourTheme>("changed", { detail: theme }));
  }
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-tour-design": StrataTourDesign;
  }
}
