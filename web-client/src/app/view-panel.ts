// <strata-view-panel>: how this person sees the model: looks, light, section.

import { css, html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { format_length, metres_per } from "../core/measure";
import type { LightMode, Look, Point3 } from "../core/protocol.gen";
import { kAxes, with_box_side, world_position, type SectionMode } from "../core/section";
import { ask, ask_text } from "./dialog";
import { follow_session } from "./follow-session";
import { icon } from "./icons";
import "./light-pad";
import "./menu";
import type { ModelSession } from "./model-session";
import { notices } from "./notices";
import { radio_group } from "./radio-group";
import { shared_styles } from "./styles";
import { texts } from "./texts";

const kLights: readonly LightMode[] = ["museum", "headlight", "raking", "unlit"];
const kSections: readonly SectionMode[] = ["off", "x", "y", "z", "box"];
const kSteps = 1000; // of a section's slider
const kOpenKey = "strata.view_panel_open";

@customElement("strata-view-panel")
export class StrataViewPanel extends LitElement {
  @property({ attribute: false }) session!: ModelSession;
  @state() private open_ = localStorage.getItem(kOpenKey) === "true";
  @state() private adding_ = false;
  @query("input[type=file]") private file_input_!: HTMLInputElement;

  constructor() {
    super();
    follow_session(this);
  }

  static override styles = [
    shared_styles,
    css`
      :host {
        display: block;
      }
      .heading {
        display: flex;
        align-items: center;
        gap: 8px;
      }
      h2 {
        flex: 1;
        font-size: 1.08rem;
      }
      h2 button {
        width: 100%;
        justify-content: flex-start;
        gap: 8px;
        min-height: 36px;
        margin-left: -8px;
        padding: 0 8px;
        font: inherit;
      }
      h2 svg.glyph {
        transform: rotate(90deg);
        transition: transform 120ms;
      }
      h2 button[aria-expanded="true"] svg.glyph {
        transform: rotate(180deg);
      }
      h2 .dot {
        width: 8px;
        height: 8px;
        border-radius: 50%;
        background: var(--accent);
      }
      .parts {
        display: grid;
        gap: 18px;
        margin-top: 10px;
      }
      .part {
        display: grid;
        gap: 10px;
      }
      .part > .row {
        min-height: 30px;
        justify-content: space-between;
      }
      h3 {
        font-size: 0.8rem;
        font-weight: 600;
        color: var(--ink-soft);
      }
      .segments {
        display: flex;
      }
      .segments button {
        padding: 0 6px;
        min-width: 0;
      }
      ul {
        display: grid;
        gap: 6px;
        margin: 0;
        padding: 0;
        list-style: none;
      }
      li {
        display: grid;
        grid-template-columns: auto 44px minmax(0, 1fr) auto;
        align-items: center;
        gap: 2px 8px;
        padding: 3px 4px 6px 2px;
        border: 1px solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
      }
      li img {
        width: 44px;
        height: 34px;
        object-fit: cover;
        border-radius: 4px;
        background: var(--paper);
      }
      li.off .name,
      li.off img {
        opacity: 0.55;
      }
      li .opacity {
        grid-column: 2 / -1;
        display: grid;
        grid-template-columns: 1fr 52px;
        align-items: center;
        gap: 10px;
        padding-right: 10px;
        font-size: 0.88rem;
      }
      output {
        text-align: right;
        white-space: nowrap;
      }
      .slider {
        display: grid;
        grid-template-columns: auto 1fr 76px;
        align-items: center;
        gap: 10px;
        font-size: 0.88rem;
      }
      .box {
        display: grid;
        gap: 2px;
      }
      .personal {
        display: flex;
        flex-wrap: wrap;
        gap: 4px 14px;
      }
    `,
  ];

  override render(): TemplateResult {
    const { appearance } = this.session;
    const words = texts.view;
    return html`<div class="heading">
        <h2>
          <button class="quiet" aria-expanded=${this.open_} aria-controls="parts" @click=${this.toggle}>
            ${icon("up")}${words.title}${appearance.is_default || this.open_
              ? nothing
              : html`<span class="dot" role="img" aria-label=${words.changed} title=${words.changed}></span>`}
          </button>
        </h2>
        ${this.open_ && !appearance.is_default
          ? html`<button class="link" @click=${() => appearance.reset()}>${words.reset}</button>`
          : nothing}
      </div>
      <div id="parts" class="parts" ?hidden=${!this.open_}>${this.open_ ? [this.looks(), this.light(), this.section()] : nothing}</div>`;
  }

  private toggle(): void {
    this.open_ = !this.open_;
    localStorage.setItem(kOpenKey, String(this.open_));
  }

  // ── looks ─────────────────────────────────────────────────────────────────────────────────────────────────────────

  private looks(): TemplateResult {
    const { session } = this;
    const { appearance } = session;
    const words = texts.view;
    const shown = [...appearance.looks].reverse();
    return html`<div class="part">
      <div class="row">
        <h3>${words.looks}</h3>
        ${session.can_curate
          ? html`<button class="quiet" ?disabled=${this.adding_} @click=${() => this.file_input_.click()}>
                ${icon("plus")}${this.adding_ ? words.look_adding : words.look_add}
              </button>
              <strata-menu label=${words.look_more}>
                <button class="quiet" role="menuitem" @click=${() => this.dispatchEvent(new CustomEvent("orthophoto"))}>
                  ${icon("import")}${texts.orthophoto.open}
                </button>
              </strata-menu>
              <input type="file" accept="image/jpeg,image/png" hidden aria-label=${words.look_add} @change=${this.on_file} />`
          : nothing}
      </div>
      ${shown.length === 0
        ? html`<p class="hint">${session.can_curate ? words.no_looks_curator : words.no_looks}</p>`
        : html`<ul>
            ${shown.map((look) => this.look(look))}
          </ul>`}
      ${appearance.has_look_overrides && session.can_curate
        ? html`<div class="personal">
            <button class="link" @click=${() => void this.save_default()}>${texts.layers.save_default}</button>
          </div>`
        : nothing}
    </div>`;
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
        @click=${() => appearance.set_visible(look, !visible)}
      >
        ${icon(visible ? "eye" : "eye_off")}
      </button>
      <img src="/api/v1/models/${session.model_id}/looks/${look.id}/picture?thumbnail=96" alt="" loading="lazy" />
      <span class="name ellipsis" title=${look.description || look.name}>${look.name}</span>
      ${session.can_curate
        ? html`<strata-menu label=${texts.layers.options(look.name)}>
            <a
              class="button quiet"
              role="menuitem"
              href="/api/v1/models/${session.model_id}/looks/${look.id}/picture"
              download="${look.slug}.${look.media_type === "image/png" ? "png" : "jpg"}"
              >${icon("down")}${texts.view.look_download}</a
            >
            <button class="quiet" role="menuitem" @click=${() => void this.rename_look(look)}>
              ${icon("edit")}${texts.view.look_rename}
            </button>
            <button
              class="quiet"
              role="menuitem"
              ?disabled=${place === appearance.looks.length - 1}
              @click=${() => this.move_look(look, place + 1)}
            >
              ${icon("up")}${texts.layers.up}
            </button>
            <button class="quiet" role="menuitem" ?disabled=${place === 0} @click=${() => this.move_look(look, place - 1)}>
              ${icon("down")}${texts.layers.down}
            </button>
            <hr />
            <button class="quiet" role="menuitem" @click=${() => void this.delete_look(look)}>
              ${icon("trash")}${texts.layers.delete}
            </button>
          </strata-menu>`
        : html`<span></span>`}
      ${visible
        ? html`<div class="opacity">
            <input
              type="range"
              min="0"
              max="100"
              .value=${String(percent)}
              aria-label=${texts.layers.opacity_of(look.name)}
              @input=${(event: Event) => appearance.set_opacity(look, number_of(event) / 100)}
            />
            <output class="numeric">${percent} %</output>
          </div>`
        : nothing}
    </li>`;
  }

  private async on_file(): Promise<void> {
    const file = this.file_input_.files?.[0];
    this.file_input_.value = "";
    if (!file) return;
    this.adding_ = true;
    try {
      await this.session.appearance.add(file);
    } catch (error) {
      notices.error(error);
    } finally {
      this.adding_ = false;
    }
  }

  private async rename_look(look: Look): Promise<void> {
    const words = texts.view;
    const name = await ask_text({ heading: words.look_rename_title(look.name), label: words.look_name, text: look.name, yes: texts.save });
    if (name === null || name === look.name) return;
    await this.session.appearance.rename(look, name).catch((error: unknown) => notices.error(error));
  }

  private move_look(look: Look, place: number): void {
    this.session.appearance.move(look, place).catch((error: unknown) => notices.error(error));
  }

  private async delete_look(look: Look): Promise<void> {
    const words = texts.view;
    const question = { heading: words.look_delete_title(look.name), lead: words.look_delete_lead, yes: texts.delete, danger: true };
    if (!(await ask(question))) return;
    await this.session.appearance.remove(look).catch((error: unknown) => notices.error(error));
  }

  private async save_default(): Promise<void> {
    try {
      await this.session.appearance.save_as_default();
      notices.show("success", texts.layers.saved_default);
    } catch (error) {
      notices.error(error);
    }
  }

  // ── light and section ─────────────────────────────────────────────────────────────────────────────────────────────

  private light(): TemplateResult {
    const { appearance } = this.session;
    const words = texts.view;
    return html`<div class="part">
      <h3 id="light">${words.light}</h3>
      ${radio_group({
        label: { id: "light" },
        class: "segments",
        choices: kLights.map((mode) => ({ value: mode, content: words.lights[mode], title: words.light_hints[mode] })),
        chosen: appearance.light.mode,
        choose: (mode) => appearance.set_light({ mode }),
      })}
      ${appearance.light.mode === "raking"
        ? html`<strata-light-pad
            .direction=${appearance.light.direction}
            @direction=${(event: CustomEvent<Point3>) => appearance.set_light({ direction: event.detail })}
          ></strata-light-pad>`
        : nothing}
    </div>`;
  }

  private section(): TemplateResult {
    const { appearance } = this.session;
    const { mode } = appearance.section;
    const words = texts.view;
    return html`<div class="part">
      <h3 id="section">${words.section}</h3>
      ${radio_group({
        label: { id: "section" },
        class: "segments",
        choices: kSections.map((value) => ({ value, content: words.sections[value], title: words.section_hints[value] })),
        chosen: mode,
        choose: (value) => appearance.set_section({ mode: value }),
      })}
      ${mode === "off" ? nothing : mode === "box" ? this.box() : this.cut(kAxes.indexOf(mode))}
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
        choose: (share, moving) => appearance.set_section({ position: share }, moving),
      })}
      <div>
        <button class="quiet" aria-pressed=${flipped} @click=${() => appearance.set_section({ flipped: !flipped })}>
          ${icon("flip")}${words.flip}
        </button>
      </div>`;
  }

  private box(): TemplateResult {
    const { appearance } = this.session;
    const words = texts.view;
    const side = (axis: number, which: "min" | "max"): TemplateResult =>
      this.slider({
        name: which === "min" ? `${kAxes[axis]!.toUpperCase()} ≥` : `${kAxes[axis]!.toUpperCase()} ≤`,
        label: which === "min" ? words.box_from(kAxes[axis]!.toUpperCase()) : words.box_to(kAxes[axis]!.toUpperCase()),
        axis,
        share: appearance.section.box[which][axis]!,
        choose: (share, moving) => appearance.set_section(with_box_side(appearance.section, which, axis, share), moving),
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
    const at = model ? world_position(model.bounds, of.axis, of.share) * metres_per(model.unit) : 0;
    const said = Math.abs(at) < 1e-9 ? "0" : `${at < 0 ? "−" : ""}${format_length(Math.abs(at))}`;
    return html`<label class="slider">
      <span class="caption numeric">${of.name}</span>
      <input
        type="range"
        min="0"
        max=${kSteps}
        .value=${String(Math.round(of.share * kSteps))}
        aria-label=${of.label}
        aria-valuetext=${said}
        @input=${(event: Event) => of.choose(number_of(event) / kSteps, true)}
      />
      <output class="numeric">${said}</output>
    </label>`;
  }
}

const number_of = (event: Event): number => Number((event.target as HTMLInputElement).value);
