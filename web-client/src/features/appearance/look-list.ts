// <strata-look-list>: the surface images of the model from top to bottom, in this user's order.
// Part of the view panel.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import type { Look } from "../../core/protocol.gen";
import { ask, askText } from "../../ui/dialog";
import { followSession } from "../../session/follow-session";
import { icon } from "../../ui/icons";
import "../../ui/panel/empty-state";
import "../../ui/menu";
import type { ModelSession } from "../../session/model-session";
import { notices } from "../../ui/notices";
import { listHeadStyles } from "../../ui/panel/panel-styles";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

@customElement("strata-look-list")
export class StrataLookList extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private _adding = false;
  @query("input[type=file]") private _fileInput!: HTMLInputElement;

  constructor() {
    super();
    followSession(this, "appearance");
  }

  static override styles = [
    sharedStyles,
    listHeadStyles,
    css`
      ul {
        gap: var(--space-2);
      }
      li {
        display: grid;
        grid-template-columns: auto 2.75rem minmax(0, 1fr) auto;
        align-items: center;
        gap: var(--space-half) var(--space-2);
        padding: var(--space-1) var(--space-1) var(--space-2) var(--space-half);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
      }
      li img {
        width: 2.75rem;
        height: 2.125rem;
        object-fit: cover;
        border-radius: var(--radius-tiny);
        background: var(--paper);
      }
      li.off .name {
        color: var(--ink-soft);
      }
      li.off img {
        opacity: 0.55;
      }
      li .opacity {
        grid-column: 2 / -1;
        display: grid;
        grid-template-columns: 1fr 3.25rem;
        align-items: center;
        gap: var(--space-2);
        padding-right: var(--space-2);
        font-size: var(--text-small);
      }
      output {
        text-align: right;
        white-space: nowrap;
      }
      .personal {
        display: flex;
        flex-wrap: wrap;
        gap: var(--space-1) var(--space-3);
      }
    `,
  ];

  override render(): TemplateResult {
    const { session } = this;
    const { appearance } = session;
    const words = texts.view;
    const shown = [...appearance.looks].reverse();
    return html`<div class="row">
        <h3>${words.looks}</h3>
        ${
          session.canCurate
            ? html`<button class="quiet" ?disabled=${this._adding} @click=${() => this._fileInput.click()}>
                ${icon("plus")}${this._adding ? words.look_adding : words.look_add}
              </button>
              <strata-menu label=${words.look_more}>
                <button class="quiet" role="menuitem" @click=${() => this.dispatchEvent(new CustomEvent("orthophoto"))}>
                  ${icon("import")}${texts.orthophoto.open}
                </button>
              </strata-menu>
              <input type="file" accept="image/jpeg,image/png,image/tiff,image/webp,image/bmp,.tga" hidden aria-label=${words.look_add} @change=${this.onFile} />`
            : nothing
        }
      </div>
      ${
        shown.length === 0
          ? html`<strata-empty line=${words.no_looks} more=${session.canCurate ? words.no_looks_more : ""}></strata-empty>`
          : html`<ul>
            ${shown.map((look) => this.look(look))}
          </ul>`
      }
      ${
        appearance.hasLookOverrides && session.canCurate
          ? html`<div class="personal">
            <button class="link" @click=${() => void this.saveDefault()}>${texts.layers.save_default}</button>
          </div>`
          : nothing
      }`;
  }

  private look(look: Look): TemplateResult {
    const { session } = this;
    const { appearance } = session;
    const visible = appearance.visible(look);
    const place = appearance.looks.indexOf(look);
    const percent = Math.round(appearance.opacity(look) * 100);
    const label = visible ? texts.layers.hide(look.name) : texts.layers.show(look.name);
    return html`<li class=${visible ? "" : "off"}>
      <button
        class="icon quiet"
        aria-pressed=${visible}
        aria-label=${label}
        title=${label}
        @click=${() => appearance.setVisible(look, !visible)}
      >
        ${icon(visible ? "eye" : "eye_off")}
      </button>
      <img src="/api/v1/models/${session.modelId}/looks/${look.id}/picture?thumbnail=96" alt="" loading="lazy" />
      <span class="name ellipsis" title=${look.description || look.name}>${look.name}</span>
      ${
        session.canCurate
          ? html`<strata-menu label=${texts.layers.options(look.name)}>
            <a
              class="button quiet"
              role="menuitem"
              href="/api/v1/models/${session.modelId}/looks/${look.id}/picture"
              download="${look.slug}.${look.media_type === "image/png" ? "png" : "jpg"}"
              >${icon("down")}${texts.view.look_download}</a
            >
            <button class="quiet" role="menuitem" @click=${() => void this.renameLook(look)}>
              ${icon("edit")}${texts.view.look_rename}
            </button>
            <button
              class="quiet"
              role="menuitem"
              ?disabled=${place === appearance.looks.length - 1}
              @click=${() => this.moveLook(look, place + 1)}
            >
              ${icon("up")}${texts.layers.up}
            </button>
            <button class="quiet" role="menuitem" ?disabled=${place === 0} @click=${() => this.moveLook(look, place - 1)}>
              ${icon("down")}${texts.layers.down}
            </button>
            <hr />
            <button class="quiet" role="menuitem" @click=${() => void this.deleteLook(look)}>
              ${icon("trash")}${texts.layers.delete}
            </button>
          </strata-menu>`
          : html`<span></span>`
      }
      ${
        visible
          ? html`<div class="opacity">
            <input
              type="range"
              min="0"
              max="100"
              .value=${String(percent)}
              aria-label=${texts.layers.opacity_of(look.name)}
              @input=${(event: Event) => appearance.setOpacity(look, numberOf(event) / 100)}
            />
            <output>${percent} %</output>
          </div>`
          : nothing
      }
    </li>`;
  }

  private async onFile(): Promise<void> {
    const file = this._fileInput.files?.[0];
    this._fileInput.value = "";
    if (!file) return;
    this._adding = true;
    try {
      await this.session.appearance.add(file);
    } catch (error) {
      notices.error(error);
    } finally {
      this._adding = false;
    }
  }

  private async renameLook(look: Look): Promise<void> {
    const words = texts.view;
    const name = await askText({
      heading: words.look_rename_title(look.name),
      label: words.look_name,
      text: look.name,
      yes: texts.save,
    });
    if (name === null || name === look.name) return;
    await this.session.appearance
      .rename(look, name)
      .catch((error: unknown) => notices.error(error));
  }

  private moveLook(look: Look, place: number): void {
    this.session.appearance.move(look, place).catch((error: unknown) => notices.error(error));
  }

  private async deleteLook(look: Look): Promise<void> {
    const words = texts.view;
    const question = {
      heading: words.look_delete_title(look.name),
      lead: words.look_delete_lead,
      yes: texts.delete,
      danger: true,
    };
    if (!(await ask(question))) return;
    await this.session.appearance.remove(look).catch((error: unknown) => notices.error(error));
  }

  private async saveDefault(): Promise<void> {
    try {
      await this.session.appearance.saveAsDefault();
      notices.show("success", texts.layers.saved_default);
    } catch (error) {
      notices.error(error);
    }
  }
}

const numberOf = (event: Event): number => Number((event.target as HTMLInputElement).value);
