// <strata-part-tree>: the parts of a model that was imported from several scans, as a tree of their
// folders. The user hides parts in their own view.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { live } from "lit/directives/live.js";
import {
  boundsOf,
  partsIn,
  partTree,
  pathOf,
  type NumberedPart,
  type PartFolder,
} from "./model-parts";
import type { ModelPart } from "../../core/protocol.gen";
import { formatArea } from "../../domain/measure";
import { followSession } from "../../session/follow-session";
import type { ModelSession } from "../../session/model-session";
import { icon } from "../../ui/icons";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

@customElement("strata-part-tree")
export class StrataPartTree extends LitElement {
  @property({ attribute: false }) session!: ModelSession;

  // The tree follows the view, which changes often. The parts of a model do not change.
  private _tree: { parts: readonly ModelPart[]; root: PartFolder } | null = null;

  constructor() {
    super();
    followSession(this, "appearance", "view");
  }

  static override styles = [
    sharedStyles,
    css`
      :host {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        gap: var(--space-2);
      }
      .tree {
        max-height: 22rem;
        overflow: hidden auto;
        scrollbar-width: thin;
      }
      ul {
        display: grid;
        grid-template-columns: minmax(0, 1fr);
        margin: 0;
        padding: 0;
        list-style: none;
      }
      ul ul {
        padding-left: var(--space-4);
      }
      .part {
        display: grid;
        grid-template-columns: minmax(0, 1fr) auto auto auto;
        align-items: center;
        gap: var(--space-1);
        min-height: var(--control-small);
      }
      label {
        display: flex;
        align-items: center;
        gap: var(--space-2);
        min-width: 0;
        font-size: var(--text-small);
      }
      .folder label {
        font-weight: 600;
      }
      label span {
        overflow: hidden;
        text-overflow: ellipsis;
        white-space: nowrap;
      }
      .hidden span,
      .area {
        color: var(--ink-soft);
      }
      .area {
        font-size: var(--text-tiny);
        white-space: nowrap;
      }
      button.icon {
        width: 1.75rem;
        min-height: var(--control-small);
      }
    `,
  ];

  override render(): TemplateResult {
    const words = texts.parts;
    const { appearance, model } = this.session;
    const parts = model?.parts ?? [];
    const shown = parts.filter((_, number) => !appearance.hiddenParts.has(number)).length;
    return html`<div class="row">
        <span class="hint" role="status">${words.shown(shown, parts.length)}</span>
        ${
          appearance.hiddenParts.size > 0
            ? html`<button class="link" @click=${() => appearance.setHiddenParts(new Set())}>${words.show_all}</button>`
            : nothing
        }
      </div>
      <div class="tree">${this.list(this.tree(parts))}</div>`;
  }

  private tree(parts: readonly ModelPart[]): PartFolder {
    if (this._tree?.parts !== parts) this._tree = { parts, root: partTree(parts) };
    return this._tree.root;
  }

  private list(folder: PartFolder): TemplateResult {
    return html`<ul>
      ${folder.folders.map(
        (each) =>
          html`<li>${this.row(each.name, each.path, partsIn(each), true)} ${this.list(each)}</li>`,
      )}
      ${folder.parts.map((part) => html`<li>${this.row(part.name, pathOf(part), [part], false)}</li>`)}
    </ul>`;
  }

  /** Names in different folders may be equal, so labels have the path. */
  private row(
    name: string,
    path: string,
    parts: readonly NumberedPart[],
    isFolder: boolean,
  ): TemplateResult {
    const words = texts.parts;
    const { hiddenParts } = this.session.appearance;
    const hidden = parts.filter(({ number }) => hiddenParts.has(number)).length;
    const area = parts.reduce((sum, part) => sum + part.area_m2, 0);
    const only = words.only(path);
    const fly = words.fly(path);
    return html`<div class="part ${isFolder ? "folder" : ""} ${hidden === parts.length ? "hidden" : ""}">
      <label title=${path}>
        <input
          type="checkbox"
          .checked=${live(hidden === 0)}
          .indeterminate=${live(hidden > 0 && hidden < parts.length)}
          @change=${() => this.show(parts, hidden > 0)}
        />
        <span>${name}</span>
      </label>
      <span class="area">${formatArea(area)}</span>
      <button class="icon quiet" aria-label=${only} title=${only} @click=${() => this.showOnly(parts)}>${icon("eye")}</button>
      <button class="icon quiet" aria-label=${fly} title=${fly} @click=${() => this.flyTo(parts)}>${icon("fit")}</button>
    </div>`;
  }

  private show(parts: readonly NumberedPart[], visible: boolean): void {
    const { appearance } = this.session;
    const hidden = new Set(appearance.hiddenParts);
    for (const { number } of parts)
      if (visible) hidden.delete(number);
      else hidden.add(number);
    appearance.setHiddenParts(hidden);
  }

  private showOnly(parts: readonly NumberedPart[]): void {
    const shown = new Set(parts.map(({ number }) => number));
    const all = (this.session.model?.parts ?? []).map((_, number) => number);
    this.session.appearance.setHiddenParts(new Set(all.filter((number) => !shown.has(number))));
  }

  private flyTo(parts: readonly NumberedPart[]): void {
    const bounds = boundsOf(parts);
    if (bounds) this.session.view.flyTo(bounds);
  }
}
