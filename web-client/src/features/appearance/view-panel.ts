// <strata-view-panel>: a user's view of the model: saved views, tours, surface images, figures.
// Light and section are over the 3D view (`features/appearance/picture-bar`).

import { css, html, nothing, type TemplateResult } from "lit";
import { customElement } from "lit/decorators.js";
import { mayDownload } from "../../core/types";
import { SidePanel, sidePanelStyles } from "../../session/side-panel";
import { icon } from "../../ui/icons";
import "./look-list";
import { withKey } from "../../ui/keys/command-keys";
import { texts } from "../../texts";
import type { ModelDialogRequest, TourRequest, ViewRequest } from "../../session/requests";

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

  private figure(): TemplateResult {
    const { model, role, canCurate } = this.session;
    const open = (): boolean =>
      this.dispatchEvent(
        new CustomEvent<ViewRequest>("request", { detail: { dialog: "figure", view: null } }),
      );
    const show = (dialog: ModelDialogRequest["dialog"]): boolean =>
      this.dispatchEvent(new CustomEvent<ModelDialogRequest>("request", { detail: { dialog } }));
    return html`<div class="part">
      <h3>${texts.figures.title}</h3>
      <div><button title=${withKey(texts.figures.open, "figure")} @click=${open}>${icon("measure")}${texts.figures.open}</button></div>
      <div><button @click=${() => show("rollout")}>${icon("measure")}${texts.figures.unroll}</button></div>
    </div>
    <div class="part">
      <h3>${texts.view.photographs}</h3>
      <div><button @click=${() => show("photographs")}>${icon("picture")}${texts.view.open_photographs}</button></div>
    </div>
    <div class="part">
      <h3>${texts.condition_report.title}</h3>
      <div><button @click=${() => show("report")}>${icon("document")}${texts.condition_report.open}</button></div>
    </div>
    ${
      canCurate
        ? html`<div class="part">
            <h3>${texts.billing.part}</h3>
            <div><button @click=${() => show("bills")}>${icon("table")}${texts.billing.open}</button></div>
          </div>`
        : nothing
    }
    ${
      model && mayDownload(role, model)
        ? html`<div class="part">
            <h3>${texts.model_export.part}</h3>
            <div><button @click=${() => show("export")}>${icon("cube")}${texts.model_export.open}</button></div>
          </div>`
        : nothing
    }
    <div class="part">
      <h3>${texts.gis.part}</h3>
      <div>
        <button @click=${() => show("gis")}>${icon("link")}${texts.gis.open}</button>
        <button @click=${() => show("linked")}>${icon("link")}${texts.gis.linked}</button>
      </div>
    </div>`;
  }
}
