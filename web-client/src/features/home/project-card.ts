// <strata-project-card>: a project in the list of projects. It shows a thumbnail of one of the
// models, the number of models, and the time of the last change.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { keyed } from "lit/directives/keyed.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { cardStyles } from "./home-styles";
import { logo } from "../../ui/icons";
import type { ListedProject } from "./project-list";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "../../ui/thumbnail";
import { toldDay } from "../../domain/times";
import { whenSeen } from "../../ui/when-seen";

const words = texts.home;
let busy: Promise<void> = Promise.resolve(); // one request at a time, as for thumbnails

@customElement("strata-project-card")
export class StrataProjectCard extends LitElement {
  @property({ attribute: false }) api!: Api;
  @property({ attribute: false }) listed!: ListedProject;
  @state() private _changed = ""; // time of the last change; empty if unknown
  private _isSeen = false;
  private _stopWaiting: (() => void) | null = null;

  static override styles = [
    sharedStyles,
    cardStyles,
    css`
      :host {
        display: block;
      }
      .no-picture {
        display: grid;
        place-items: center;
        aspect-ratio: 4 / 3;
        background: var(--paper);
      }
      .no-picture .logo {
        width: 3.5rem;
        height: 3.5rem;
        opacity: 0.4;
      }
      .about b {
        overflow-wrap: anywhere;
      }
      p {
        display: -webkit-box;
        -webkit-box-orient: vertical;
        -webkit-line-clamp: 2;
        overflow: hidden;
        font-size: var(--text-small);
      }
    `,
  ];

  override firstUpdated(): void {
    this._stopWaiting = whenSeen(this, () => {
      this._isSeen = true;
      this.ask();
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this._stopWaiting?.();
  }

  override updated(changed: PropertyValues<this>): void {
    if (changed.has("listed") && this._isSeen) this.ask();
  }

  private ask(): void {
    busy = busy.then(() => this.load());
  }

  private async load(): Promise<void> {
    if (!this.isConnected) return;
    try {
      const { activity } = await this.api.json("GET /projects/{project}/activity", {
        path: { project: this.listed.project.slug },
        query: {
          model: undefined,
          before: undefined,
          limit: 1,
        },
      });
      this._changed = activity[0]?.time ?? "";
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._changed = ""; // the project's own page shows the problem
    }
  }

  override render(): TemplateResult {
    const { project, models } = this.listed;
    const [first] = models;
    return html`${
      first
        ? keyed(
            first.id,
            html`<strata-thumbnail .api=${this.api} .model=${first}></strata-thumbnail>`,
          )
        : html`<div class="no-picture">${logo()}</div>`
    }
      <div class="about">
        <b>${project.name}</b>
        ${project.description ? html`<p>${project.description}</p>` : nothing}
        <span class="faint">
          ${models.length === 0 ? words.empty_title : words.count(models.length)}${this._changed ? ` · ${words.changed(toldDay(this._changed))}` : nothing}
        </span>
      </div>`;
  }
}
