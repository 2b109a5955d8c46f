// <strata-template-dialog>: the templates and their contents. One click creates the tables of a
// template, and its layers on this model.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import { labelOf } from "../../domain/cells";
import { personLanguages } from "../../core/locale";
import { completeLayer } from "../../core/types";
import type { Template, TemplateTable } from "../../core/protocol.gen";
import "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import { icon } from "../../ui/icons";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { sharedStyles } from "../../ui/styles";
import { styled } from "../../ui/styled";
import { texts } from "../../texts";

const words = texts.templates;
const kMostColors = 6; // the number of colors in the preview of a list

@customElement("strata-template-dialog")
export class StrataTemplateDialog extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _templates: Template[] | null = null;
  @state() private _problem = "";
  @state() private _refused: { slug: string; problem: string } | null = null;
  @state() private _making = ""; // the slug of the template that is being applied
  @query("strata-dialog") private _dialog!: StrataDialog;

  static override styles = [
    sharedStyles,
    css`
      ul {
        display: grid;
        gap: var(--space-2);
        margin: 0;
        padding: 0;
        list-style: none;
      }
      li {
        display: grid;
        grid-template-columns: minmax(0, 1fr) auto;
        align-items: start;
        gap: var(--space-2) var(--space-3);
        padding: var(--space-3) var(--space-3);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
      }
      b {
        font: 600 var(--text-large) var(--serif);
      }
      .made {
        display: grid;
        gap: var(--space-1);
        grid-column: 1 / -1;
        font-size: var(--text-small);
      }
      .made div {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        min-width: 0;
      }
      .made svg.glyph {
        width: 1rem;
        height: 1rem;
        color: var(--ink-soft);
      }
      .made .hint {
        white-space: nowrap;
      }
      .colors {
        display: inline-flex;
        gap: var(--space-1);
      }
      .colors span {
        width: 0.6875rem;
        height: 0.6875rem;
        border-radius: var(--radius-tiny);
      }
      li .error {
        grid-column: 1 / -1;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    void this.load();
  }

  private async load(): Promise<void> {
    this._problem = "";
    try {
      this._templates = await this.session.api.all("GET /templates", "templates");
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = error.message;
    }
  }

  override render(): TemplateResult {
    const { _templates: templates } = this;
    return html`<strata-dialog wide prose heading=${words.title} @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}>
      <p class="hint">${words.lead}</p>
      ${
        templates
          ? templates.length === 0
            ? html`<p>${words.none}</p>`
            : html`<ul>${templates.map((template) => this.card(template))}</ul>`
          : html`<p class="hint" role="status" ?hidden=${this._problem !== ""}>${texts.loading}</p>`
      }
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      ${this._problem ? html`<button slot="actions" class="primary" @click=${() => void this.load()}>${texts.try_again}</button>` : nothing}
    </strata-dialog>`;
  }

  private card(template: Template): TemplateResult {
    const { slug = "", description } = template;
    const name = named(template);
    return html`<li aria-label=${name}>
      <div>
        <b>${name}</b>
        <p class="hint">${description}</p>
      </div>
      <button class="primary" aria-label=${words.make_of(name)} ?disabled=${this._making !== ""} @click=${() => void this.make(template)}>
        ${this._making === slug ? words.making : words.make}
      </button>
      <div class="made">
        ${template.tables.map(
          (table) =>
            html`<div>
              ${icon("table")}<span class="ellipsis">${named(table)}</span>${colors(table)}<span class="hint">${contents(table)}</span>
            </div>`,
        )}
        ${template.layers.map(
          (layer) =>
            html`<div>${icon("brush")}<span class="ellipsis">${named(layer)}</span><span class="hint">${words.layer}</span></div>`,
        )}
      </div>
      ${this._refused?.slug === slug ? html`<p class="error" role="alert">${this._refused.problem}</p>` : nothing}
    </li>`;
  }

  private async make(template: Template): Promise<void> {
    const { session } = this;
    const { slug = "" } = template;
    if (!session.model) return;
    this._making = slug;
    this._refused = null;
    try {
      const made = await session.api.json("POST /projects/{project}/templates/{template}", {
        path: { project: session.model.project, template: slug },
        body: {
          model: session.modelId,
          language: personLanguages()[0]!,
        },
      });
      const layers = made.layers.map(completeLayer);
      for (const layer of layers) session.layers.put(layer);
      const first = layers.find(({ kind }) => kind === "database");
      if (first) {
        session.addCreated(first);
        const key = firstTermKey(
          template,
          made.layers.findIndex(({ id }) => id === first.id),
        );
        if (key !== null) session.painting.setBrush((brush) => brush.setValue(first, key));
      }
      notices.show("success", words.made(made.tables.length, layers.length));
      this._dialog.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._refused = { slug, problem: error.message };
    } finally {
      this._making = "";
    }
  }
}

/**
 * The server names the new objects in the language of the user's page. This preview shows the same
 * names.
 */
const named = ({ name, labels = {} }: Pick<Template, "name" | "labels">): string =>
  labelOf({ name, labels });

/**
 * Returns the first term with a parent in the list of a layer, because users paint a crack and not
 * the family of cracks. The server numbers the terms of a new list in their order. Returns null if
 * the layer has no list of terms, or a flat one.
 */
export function firstTermKey({ layers, tables }: Template, layer: number): number | null {
  const terms = tables.find(({ slug }) => slug === layers[layer]?.table)?.terms ?? [];
  const place = terms.findIndex(({ parent }) => parent !== undefined);
  return place < 0 ? null : place + 1;
}

const contents = ({ terms, columns }: TemplateTable): string =>
  terms ? words.terms(terms.length) : words.columns(columns?.length ?? 0);

function colors({ terms = [] }: TemplateTable): TemplateResult | typeof nothing {
  const some = terms.flatMap(({ color }) => color ?? []).slice(0, kMostColors);
  return some.length === 0
    ? nothing
    : html`<span class="colors">${some.map((color) => html`<span ${styled({ background: color })}></span>`)}</span>`;
}

declare global {
  interface HTMLElementTagNameMap {
    "strata-template-dialog": StrataTemplateDialog;
  }
}
