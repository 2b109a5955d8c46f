// <strata-section-controls>: the section of this user's view: an axis with the position of its cut,
// or a box.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { formatLength, metresPer } from "../../domain/measure";
import { kAxes, withBoxSide, worldPosition, type SectionMode } from "../../math/section";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { icon } from "../../ui/icons";
import { radioGroup } from "../../ui/radio-group";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "./section-area";
import { controlStyles } from "./control-styles";

const kSections: readonly Exclude<SectionMode, "planes">[] = ["off", "x", "y", "z", "box"];
const kSteps = 1000; // the number of steps of a slider

@customElement("strata-section-controls")
export class StrataSectionControls extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "appearance");
  }

  static override styles = [sharedStyles, controlStyles];

  override render(): TemplateResult {
    const { appearance } = this.session;
    const { mode } = appearance.section;
    const words = texts.view;
    return html`${radioGroup({
      label: words.section,
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
      <strata-section-area .session=${this.session}></strata-section-area>`;
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
