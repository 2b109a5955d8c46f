// <strata-selection-bar>: a bar over the 3D view while polygon or lasso have selected an area. It
// shows the area's size and the effect of the next outline. Its buttons paint, erase or discard the
// selection.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { formatPercent } from "../../core/locale";
import { formatArea } from "../../domain/measure";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { icon } from "../../ui/icons";
import { radioGroup } from "../../ui/radio-group";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import type { SelectionMode } from "./area-selection";

const words = texts.selection;
const kModes: readonly SelectionMode[] = ["replace", "add", "subtract", "intersect"];

@customElement("strata-selection-bar")
export class StrataSelectionBar extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  constructor() {
    super();
    followSession(this, "painting", "tools", "layers", "lit");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        position: absolute;
        inset: 0.75rem 0 auto 0;
        display: flex;
        justify-content: center;
        padding: 0 var(--space-3);
        pointer-events: none;
      }
      .bar {
        display: flex;
        flex-wrap: wrap;
        align-items: center;
        justify-content: center;
        gap: var(--space-2) var(--space-3);
        padding: var(--space-2) var(--space-3);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--surface);
        color: var(--ink);
        box-shadow: var(--shadow);
        font-size: var(--text-body);
        pointer-events: auto;
      }
      output {
        min-width: 8.5rem;
        padding: 0 var(--space-2);
        font-weight: 600;
      }
      output small {
        display: block;
        color: var(--ink-soft);
        font-size: var(--text-small);
        font-weight: 400;
      }
      .segments button {
        padding: 0 var(--space-3);
      }
      @media (max-width: 560px) {
        :host {
          inset: auto 0 0.75rem 0;
          padding: 0 var(--space-2);
        }
        .segments {
          order: 3;
        }
      }
    `,
  ];

  override render(): TemplateResult | typeof nothing {
    const { session } = this;
    const { area } = session.painting;
    const tool = session.tools.active;
    if (area.isEmpty || (tool !== "polygon" && tool !== "lasso")) return nothing;
    const { measured } = area;
    const elsewhere = area.outlines.filter((each) => !area.isInView(each)).length;
    return html`<div class="bar" role="group" aria-label=${words.title}>
      <output class="numeric">
        ${measured ? (measured.texels > 0 ? formatArea(measured.area_m2) : words.nothing) : words.measuring}
        <small>${elsewhere > 0 ? words.elsewhere(elsewhere) : measured ? words.share(formatPercent(measured.share)) : "\u00a0"}</small>
      </output>
      ${radioGroup<SelectionMode>({
        label: words.mode,
        class: "segments",
        choices: kModes.map((value) => ({
          value,
          content: words.modes[value],
          title: words.mode_hints[value],
        })),
        chosen: area.mode,
        choose: (mode) => area.setMode(mode),
      })}
      ${
        area.canDelete
          ? html`<button @click=${() => area.deleteCorner()}>${words.delete_corner}</button>`
          : nothing
      }
      <button class=${session.painting.brush.areas.erases ? "" : "primary"} @click=${() => session.painting.paintSelection(false)}>${words.fill}</button>
      <button class=${session.painting.brush.areas.erases ? "primary" : ""} @click=${() => session.painting.paintSelection(true)}>${words.erase}</button>
      <button class="icon quiet" aria-label=${words.discard} title=${words.discard} @click=${() => area.clear()}>${icon("close")}</button>
    </div>`;
  }
}
