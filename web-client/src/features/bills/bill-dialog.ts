// <strata-bill-dialog>: one bill of quantities: the tree of its groups and positions, the fields of
// the selected one, and the measured quantities. Changes are sent when the user saves or measures.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { pageLocale } from "../../core/locale";
import { isGroup, placeOf, shownDecimal } from "../../domain/bills";
import type { Api } from "../../net/api";
import "../../ui/dialog";
import { ask } from "../../ui/dialog";
import { icon } from "../../ui/icons";
import "../../ui/menu";
import { holdPage } from "../../ui/routes";
import { texts } from "../../texts";
import { billDialogStyles } from "./bill-dialog-styles";
import { BillEdits } from "./bill-edits";
import { BillFiles, type BillFormat } from "./bill-files";
import "./bill-position";
import type { ItemChange } from "./bill-position";
import "./bill-proof";
import "./bill-rule";
import { BillSources } from "./bill-sources";
import "./bill-tree";
import type { StrataBillTree } from "./bill-tree";

const words = texts.bills;

@customElement("strata-bill-dialog")
export class StrataBillDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  /** The slug of the project. */
  @property() project = "";
  /** The id of the bill. */
  @property({ attribute: false }) bill = 0;
  @state() private _loaded = 0; // changes when the sources of rules have changed
  /** On narrow windows, whether the fields cover the tree. */
  @state() private _editing = false;
  @query("strata-bill-tree") private _tree!: StrataBillTree | null;
  private _edits!: BillEdits;
  private _sources!: BillSources;
  private readonly _files = new BillFiles(this);
  private _asked: Promise<boolean> | null = null;
  private _letGo = (): void => {};
  private _shownProblem: unknown = null;

  static override styles = billDialogStyles;

  override connectedCallback(): void {
    super.connectedCallback();
    addEventListener("beforeunload", this.onUnload);
    this._letGo = holdPage(this.mayClose);
    this._edits = new BillEdits(this.api, this.project, this.bill, () => this.requestUpdate());
    this._sources = new BillSources(this.api, this.project, () => (this._loaded += 1));
    void this._edits.load();
    void this._sources.load();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    removeEventListener("beforeunload", this.onUnload);
    this._letGo();
    this._edits.cancelMeasuring();
  }

  private readonly onUnload = (event: Event): void => {
    if (this._edits.isChanged) event.preventDefault();
  };

  private readonly mayClose = async (): Promise<boolean> => {
    await this._edits.settled();
    if (!this._edits.isChanged) return true;
    this._asked ??= ask({
      heading: words.leave_title,
      lead: words.leave_lead,
      yes: words.leave_yes,
      danger: true,
    }).finally(() => (this._asked = null));
    return this._asked;
  };

  /** Moves the focus to the wrong field. */
  override updated(): void {
    const { problem } = this._edits;
    if (problem === this._shownProblem) return;
    this._shownProblem = problem;
    if (!problem?.field) return;
    this._editing = placeOf(problem.field).index !== null;
    void this.focusField(placeOf(problem.field).within);
  }

  private async focusField(name: string): Promise<void> {
    await this.updateComplete;
    // the elements of the selected item are rendered one after another
    for (let depth = 0; depth < 3; depth += 1) await new Promise(requestAnimationFrame);
    fieldIn(this.renderRoot, name)?.focus();
  }

  // ── rendering ──────────────────────────────────────────────────────────────────────────────────

  override render(): TemplateResult {
    const { draft, problem, isBusy, isOutdated } = this._edits;
    return html`<strata-dialog
      vast
      heading=${draft?.name || words.title}
      way_out=${texts.close}
      .mayClose=${this.mayClose}
      @keydown=${this.onKey}
      @closed=${() => this.dispatchEvent(new CustomEvent("closed"))}
    >
      ${draft ? this.content() : html`<p class="hint" role="status" ?hidden=${problem !== null}>${texts.loading}</p>`}
      ${
        isOutdated
          ? html`<div slot="told" class="told" role="alert">
            <span>${words.outdated}</span>
            <button class="link" @click=${() => void this._edits.load()}>${words.reload}</button>
          </div>`
          : nothing
      }
      ${problem ? html`<p slot="told" class="error told" role="alert">${this.problemText()}</p>` : nothing}
      <button slot="actions" class="primary" ?disabled=${isBusy || !this._edits.isChanged} @click=${() => void this._edits.save()}>
        ${texts.save}
      </button>
    </strata-dialog>`;
  }

  private problemText(): string {
    const { problem, draft } = this._edits;
    const { index } = placeOf(problem!.field);
    const number = index === null ? undefined : draft?.items[index]?.number;
    const text = problem!.text || words.wrong_number;
    return number === undefined ? text : `${number}: ${text}`;
  }

  private content(): TemplateResult {
    const { _edits: edits } = this;
    return html`<div class="editor ${this._editing && edits.item ? "in-item" : ""}">
      ${this.bar()}
      <div class="parts">
        <div class="tree">
          ${
            edits.draft!.items.length === 0
              ? html`<p class="hint">${words.empty}</p>`
              : html`<strata-bill-tree
                .items=${edits.draft!.items}
                .chosen=${edits.chosen}
                .quantities=${edits.quantities}
                ?stale=${edits.isStale}
                @choose=${({ detail }: CustomEvent<number>) => this.choose(detail)}
                @open=${() => (this._editing = true)}
                @edit=${() => this.edit()}
                @insert=${() => this.insert("position")}
                @remove=${() => this.removeItem()}
              ></strata-bill-tree>`
          }
        </div>
        <div class="item">${this.item()}</div>
      </div>
    </div>`;
  }

  private bar(): TemplateResult {
    const { _edits: edits } = this;
    const path = edits.path;
    const save = async (format: BillFormat): Promise<void> => {
      if (await edits.save()) await this._files.save(this.api, path, edits.draft!.name, format);
    };
    return html`<div class="bar">
        <label class="field grow">
          <span>${words.name}</span>
          <input type="text" name="name" maxlength="200" autocomplete="off" aria-invalid=${edits.problem?.field === "name"} .value=${edits.draft!.name} @input=${(event: Event) => edits.rename((event.target as HTMLInputElement).value)} />
        </label>
        <div class="row tools">
          <button @click=${() => this.insert("group")}>${icon("plus")}${words.new_group}</button>
          <button @click=${() => this.insert("position")}>${icon("plus")}${words.new_position}</button>
          ${this.tool("trash", words.remove, edits.item === null, () => this.removeItem())}
          ${this.tool("undo", words.undo, !edits.canUndo, () => edits.undo())}
          ${this.tool("redo", words.redo, !edits.canRedo, () => edits.redo())}
          <strata-menu label=${words.export} .quiet=${false} wide>
            <span slot="face" class="face">${icon("document")}${words.export}</span>
            ${this._files.items((format) => void save(format))}
          </strata-menu>
          ${
            edits.isMeasuring
              ? nothing
              : html`<button class="primary" ?disabled=${edits.isBusy} @click=${() => void edits.measure(pageLocale())}>${icon("measure")}${words.measure_all}</button>`
          }
        </div>
      </div>
      ${this._files.state()} ${this.measuring()}`;
  }

  private tool(
    glyph: "trash" | "undo" | "redo",
    label: string,
    off: boolean,
    run: () => void,
  ): TemplateResult {
    return html`<button class="icon" aria-label=${label} title=${label} ?disabled=${off} @click=${run}>${icon(glyph)}</button>`;
  }

  /** The progress of the measuring, its problem, or the total. */
  private measuring(): TemplateResult | typeof nothing {
    const { _edits: edits } = this;
    if (edits.isMeasuring)
      return html`<div class="row state" role="status">
        <progress aria-label=${words.measuring}></progress>
        <span class="hint grow">${words.measuring}</span>
        <button @click=${() => edits.cancelMeasuring()}>${texts.cancel}</button>
      </div>`;
    if (edits.measuringProblem && !edits.problem)
      return html`<p class="error" role="alert">${edits.measuringProblem}</p>`;
    if (!edits.quantities) return nothing;
    const { total, currency } = edits.quantities;
    return html`<p class="state" role="status">
      <b>${words.total}: ${shownDecimal(total)} ${currency}</b>
      ${edits.isStale ? html`<span class="warn">${words.stale}</span>` : nothing}
    </p>`;
  }

  private item(): TemplateResult {
    const { _edits: edits } = this;
    const { item, draft, problem } = edits;
    if (!item)
      return html`<p class="hint middle">${draft!.items.length > 0 ? words.choose_item : words.empty_hint}</p>`;
    const place = placeOf(problem?.field ?? "");
    const measured = edits.measured(item.number);
    return html`<button class="back" @click=${() => (this._editing = false)}>${icon("back")}${words.all_items}</button>
      <strata-bill-position
        .item=${item}
        currency=${draft!.currency}
        wrong=${place.index === edits.chosen ? place.within : ""}
        .sources=${this._sources}
        .loaded=${this._loaded}
        .measured=${measured}
        @changed=${({ detail }: CustomEvent<ItemChange>) => edits.change(detail.item, detail.key)}
      ></strata-bill-position>
      ${
        isGroup(item)
          ? nothing
          : html`<section class="proof" aria-labelledby="proof">
            <h3 id="proof">${words.quantities}</h3>
            ${
              measured
                ? html`<strata-bill-proof .position=${measured} currency=${draft!.currency} ?stale=${edits.isStale}></strata-bill-proof>`
                : html`<p class="hint">${words.not_measured}</p>`
            }
          </section>`
      }`;
  }

  // ── commands ───────────────────────────────────────────────────────────────────────────────────

  private choose(index: number): void {
    this._edits.choose(index);
  }

  /** Moves the focus to the texts of the selected item. */
  private edit(): void {
    this._editing = true;
    void this.focusField("short_text");
  }

  private insert(kind: "group" | "position"): void {
    this._edits.insert(kind);
    this.edit();
  }

  private removeItem(): void {
    this._edits.remove();
    this._editing = false;
    void this.updateComplete.then(() =>
      this._tree?.updateComplete.then(() => this._tree?.focusChosen()),
    );
  }

  /** Undo and redo. In a text field, the browser handles these keys. */
  private readonly onKey = (event: KeyboardEvent): void => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
    const [target] = event.composedPath();
    if (target instanceof HTMLElement && target.matches("input[type=text], textarea")) return;
    const key = event.key.toLowerCase();
    if (key !== "z" && key !== "y") return;
    event.preventDefault();
    event.stopPropagation();
    if (key === "y" || event.shiftKey) this._edits.redo();
    else this._edits.undo();
  };
}

/** Finds a field, also in the shadow roots below. A path of a missing field finds its parent. */
function fieldIn(root: ParentNode, name: string): HTMLElement | null {
  for (let path = name; path !== ""; path = path.replace(/[.[]?[^.[]*$/, "")) {
    const found = deepFind(root, `[name="${CSS.escape(path)}"]`);
    if (found) return found;
  }
  return null;
}

function deepFind(root: ParentNode, selector: string): HTMLElement | null {
  const found = root.querySelector<HTMLElement>(selector);
  if (found) return found;
  for (const each of root.querySelectorAll("*")) {
    const inside = each.shadowRoot && deepFind(each.shadowRoot, selector);
    if (inside) return inside;
  }
  return null;
}
