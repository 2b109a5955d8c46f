// <strata-view-panel>: a person's view of the model: saved views, surface images, light, section.

import { css, html, nothing, type TemplateResult } from "lit";
import { customElement } from "lit/decorators.js";
import { formatLength, metresPer } from "../../domain/measure";
import type { LightMode, Point3 } from "../../core/protocol.gen";
import { kAxes, withBoxSide, worldPosition, type SectionMode } from "../../math/section";
import { SidePanel, sidePanelStyles } from "../../session/side-panel";
import { icon } from "../../ui/icons";
import "../../ui/light-pad";
import "./light-sliders";
import "./look-list";
import "./section-area";
import { radioGroup } from "../../ui/radio-group";
import { texts } from "../../texts";
import type { TourRequest } from "../../session/requests";
import type { ViewRequest } from "../../session/requests";

const kLights: readonly LightMode[] = ["museum", "headlight", "raking", "unlit"];
const kSections: readonly Exclude<SectionMode, "planes">[] = ["off", "x", "y", "z", "box"];
const kSteps = 1000; // steps of a section's slider

@customElement("strata-view-panel")
export class StrataViewPanel extends SidePanel {
  protected readonly heading = texts.view.title;

  constructor() {
    super("appearance");
  }

  static override styles = [
    sidePanelStyles,
    css`
      .parts {
        gap: var(--space-4);
      }
      .part {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-2);
      }
      .part > .row {
        min-height: var(--control-small);
        justify-content: space-between;
      }
      h3 {
        font-size: var(--text-tiny);
        font-weight: 600;
        color: var(--ink-soft);
      }
      .segments button {
        flex: 1 1 auto; /* at least as wide as its text */
        padding: 0 var(--space-2);
      }
      output {
        text-align: right;
        white-space: nowrap;
      }
      .slider {
        display: grid;
        grid-template-columns: auto 1fr 4.75rem;
        align-items: center;
        gap: var(--space-2);
        font-size: var(--text-small);
      }
      .box {
        display: grid;
        gap: var(--space-half);
      }
    `,
  ];

  protected override tools(): unknown {
    const { appearance } = this.session;
    return !appearance.isDefault
      ? html`<button class="link" @click=${() => appearance.reset()}>${texts.view.reset}</button>`
      : nothing;
  }

  protected content(): TemplateResult[] {
    return [
      this.views(),
      ...(this.session.canCurate ? [this.tours()] : []),
      this.looks(),
      this.light(),
      this.section(),
      this.figure(),
    ];
  }

  private views(): TemplateResult {
    return html`<strata-view-list
      .session=${this.session}
      @request=${(event: CustomEvent<ViewRequest>) => this.dispatchEvent(new CustomEvent("request", { detail: event.detail }))}
    ></strata-view-list>`;
  }

  private tours(): TemplateResult {
    return html`<strata-tour-list
      .session=${this.session}
      @request=${(event: CustomEvent<TourRequest>) => this.dispatchEvent(new CustomEvent("request", { detail: event.detail }))}
    ></strata-tour-list>`;
  }

  private looks(): TemplateResult {
    return html`<strata-look-list
      .session=${this.session}
      @orthophoto=${() => this.dispatchEvent(new CustomEvent("orthophoto"))}
    ></strata-look-list>`;
  }

  // ── light and section ──────────────────────────────────────────────────────────────────────────

  private light(): TemplateResult {
    const { appearance } = this.session;
    const words = texts.view;
    return html`<div class="part">
      <h3 id="light">${words.light}</h3>
      ${radioGroup({
        label: { id: "light" },
        class: "segments",
        choices: kLights.map((mode) => ({
          value: mode,
          content: words.lights[mode],
          title: words.light_hints[mode],
        })),
        chosen: appearance.light.mode,
        choose: (mode) => appearance.setLight({ mode }),
      })}
      ${
        appearance.light.mode === "raking"
          ? html`<strata-light-pad
            .direction=${appearance.light.direction}
            @direction=${(event: CustomEvent<Point3>) => appearance.setLight({ direction: event.detail })}
          ></strata-light-pad>`
          : nothing
      }
      <strata-light-sliders .session=${this.session}></strata-light-sliders>
    </div>`;
  }

  private section(): TemplateResult {
    const { appearance } = this.session;
    const { mode } = appearance.section;
    const words = texts.view;
    return html`<div class="part">
      <h3 id="section">${words.section}</h3>
      ${radioGroup({
        label: { id: "section" },
        class: "segments",
        choices: kSections.map((value) => ({
          value,
          content: words.sections[value],
          title: words.section_hints[value],
        })),
        chosen: mode,
        choose: (value) => appearance.setSection({ mode: value }),
      })}
      ${this.sectionOf(mode)}
      <strata-section-area .session=${this.session}></strata-section-area>
    </div>`;
  }

  private figure(): TemplateResult {
    const open = (): boolean =>
      this.dispatchEvent(
        new CustomEvent<ViewRequest>("request", { detail: { dialog: "figure", view: null } }),
      );
    return html`<div class="part">
      <h3>${texts.figures.title}</h3>
      <div><button title="F" @click=${open}>${icon("measure")}${texts.figures.open}</button></div>
    </div>`;
  }

  private sectionOf(mode: SectionMode): TemplateResult | typeof nothing {
    const { appearance } = this.session;
    const words = texts.view;
    if (mode === "off") return nothing;
    if (mode === "box") return this.box();
    if (mode !== "planes") return this.cut(kAxes.indexOf(mode));
    return html`<div class="row">
      <span class="hint" role="status">${words.section_of_view(appearance.section.planes.length)}</span>
      <button class="link" @click=${() => appearance.setSection({ mode: "off" })}>${words.section_remove}</button>
    </div>`;
  }

  private cut(axis: number): TemplateResult {
    const { appearance } = this.session;
    const words = texts.view;
    const { position, flipped } = appearance.section;
    return html`${this.slider({
      name: kAxes[axis]!.toUpperCase(),
      label: words.cut_position,
      axis,
      share: position,
      choose: (share, moving) => appearance.setSection({ position: share }, moving),
    })}
      <div>
        <button class="quiet" aria-pressed=${flipped} @click=${() => appearance.setSection({ flipped: !flipped })}>
          ${icon("flip")}${words.flip}
        </button>
      </div>`;
  }

  private box(): TemplateResult {
    const { appearance } = this.session;
    const words = texts.view;
    const side = (axis: number, which: "min" | "max"): TemplateResult =>
      this.slider({
        name:
          which === "min" ? `${kAxes[axis]!.toUpperCase()} ≥` : `${kAxes[axis]!.toUpperCase()} ≤`,
        label:
          which === "min"
            ? words.box_from(kAxes[axis]!.toUpperCase())
            : words.box_to(kAxes[axis]!.toUpperCase()),
        axis,
        share: appearance.section.box[which][axis]!,
        choose: (share, moving) =>
          appearance.setSection(withBoxSide(appearance.section, which, axis, share), moving),
      });
    return html`<div class="box">${[0, 1, 2].map((axis) => [side(axis, "min"), side(axis, "max")])}</div>`;
  }

  private slider(of: {
    name: string;
    label: string;
    axis: number;
    share: number;
    choose(share: number, moving: boolean): void;
  }): TemplateResult {
    const { model } = this.session;
    const at = model ? worldPosition(model.bounds, of.axis, of.share) * metresPer(model.unit) : 0;
    const said = Math.abs(at) < 1e-9 ? "0" : `${at < 0 ? "−" : ""}${formatLength(Math.abs(at))}`;
    return html`<label class="slider">
      <span class="caption">${of.name}</span>
      <input
        type="range"
        min="0"
        max=${kSteps}
        .value=${String(Math.round(of.share * kSteps))}
        aria-label=${of.label}
        aria-valuetext=${said}
        @input=${(event: Event) => of.choose(numberOf(event) / kSteps, true)}
      />
      <output>${said}</output>
    </label>`;
  }
}

const numberOf = (event: Event): number => Number((event.target as HTMLInputElement).value);
