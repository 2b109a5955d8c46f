// <strata-section-area>: the area of the cuts of this user's section. Part of the controls over the
// 3D view.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import type { Plane, SectionCut } from "../../core/protocol.gen";
import { formatArea } from "../../domain/measure";
import { sectionPlanes } from "../../math/section";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const kRestMs = 300; // the section is measured after this time without a change

@customElement("strata-section-area")
export class StrataSectionArea extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _cuts: SectionCut[] | "measuring" | "failed" = "measuring";
  private _measured = ""; // the planes of the section that `_cuts` belongs to
  private _timer = 0;

  constructor() {
    super();
    followSession(this, "appearance");
  }

  static override styles = [
    sharedStyles,
    css`
      p {
        font-size: var(--text-small);
        color: var(--ink-soft);
      }
    `,
  ];

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    clearTimeout(this._timer);
    this._measured = "";
  }

  override render(): TemplateResult | typeof nothing {
    const planes = this.planes();
    if (planes.length === 0) return nothing;
    if (this._cuts === "failed") return nothing;
    const said =
      this._cuts === "measuring"
        ? texts.view.cut_measuring
        : texts.view.cut_area(saidArea(this._cuts));
    return html`<p role="status" class="numeric">${said}</p>`;
  }

  override updated(): void {
    const planes = this.planes();
    const key = JSON.stringify(planes);
    if (key === this._measured) return;
    this._measured = key;
    this._cuts = "measuring";
    clearTimeout(this._timer);
    if (planes.length > 0)
      this._timer = window.setTimeout(() => void this.measure(planes, key), kRestMs);
  }

  private planes(): Plane[] {
    const { appearance, model } = this.session;
    return model ? sectionPlanes(appearance.section, model.bounds) : [];
  }

  private async measure(planes: Plane[], key: string): Promise<void> {
    const cuts = await this.session.appearance
      .measureSection(planes)
      .catch((): "failed" => "failed"); // the next change to the section repeats the request
    if (this._measured === key) this._cuts = cuts;
  }
}

/** Returns the area of all planes together, or null if one of the cuts is open. */
function saidArea(cuts: SectionCut[]): string | null {
  let sum = 0;
  for (const { area_m2: area } of cuts) {
    if (area === undefined) return null;
    sum += area;
  }
  return formatArea(sum);
}
