// <strata-report-sections>: the sections of a report in their order: switches them on and off, moves
// them, and has their headings and texts. The owner can provide further content for a section.

import { css, html, LitElement, nothing, type PropertyValues, type TemplateResult } from "lit";
import { customElement, property, state } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import type { SectionInput } from "../../domain/reports";
import { moved } from "../../domain/tours";
import type { ReportPart } from "../../core/protocol.gen";
import { DragOrder } from "../../ui/order/drag-order";
import { icon } from "../../ui/icons";
import { OrderButtons } from "../../ui/order/order-buttons";
import { dragStyles, sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import { partOf, type Problems } from "./report-problems";

const words = texts.report_dialog;
/** These sections consist of the user's text only. */
const kWritten: readonly ReportPart[] = ["condition", "measures"];

@customElement("strata-report-sections")
export class StrataReportSections extends LitElement {
  @property({ attribute: false }) sections: readonly SectionInput[] = [];
  @property({ attribute: false }) problems: Problems = new Map();
  /** Returns the content below the text of a section. */
  @property({ attribute: false }) more: (part: ReportPart) => unknown = () => nothing;
  @state() private _open: ReadonlySet<string> = new Set(kWritten);
  private readonly _order = new OrderButtons(this);
  private readonly _drag = new DragOrder<ReportPart>(
    this,
    () => this.sections.map(({ part }) => part),
    (part, to) =>
      this.put(
        moved(
          this.sections,
          this.sections.findIndex((each) => each.part === part),
          to,
        ),
      ),
  );

  static override styles = [
    sharedStyles,
    dragStyles,
    css`
      :host {
        display: grid;
        gap: var(--space-2);
        min-width: 0;
      }
      ol {
        display: grid;
        gap: var(--space-2);
        margin: 0;
        padding: 0;
        list-style: none;
      }
      li {
        display: grid;
        gap: var(--space-1);
        min-width: 0;
        padding: var(--space-1) var(--space-2) var(--space-2);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius);
        background: var(--raised);
      }
      li.wrong {
        border-color: var(--danger);
      }
      li.off {
        background: transparent;
      }
      .head {
        display: grid;
        grid-template-columns: auto minmax(0, 1fr) auto;
        align-items: center;
        gap: var(--space-1);
      }
      .head label {
        min-height: var(--control);
        font-weight: 600;
      }
      .buttons {
        display: flex;
      }
      .buttons button.icon {
        width: 2rem;
        min-height: 2rem;
      }
      summary {
        width: fit-content;
        color: var(--accent);
        font-size: var(--text-small);
        cursor: pointer;
      }
      .parts {
        display: grid;
        gap: var(--space-2);
        padding-top: var(--space-2);
      }
      textarea {
        min-height: 6rem;
        resize: vertical;
      }
      @media (pointer: coarse) {
        .buttons button.icon {
          width: 2.5rem;
          min-height: var(--control-touch);
        }
        .head {
          grid-template-columns: minmax(0, 1fr) auto;
        }
        .head .grip {
          display: none; /* only the mouse can drag */
        }
        summary {
          padding: var(--space-2) 0;
        }
      }
    `,
  ];

  override willUpdate(changed: PropertyValues<this>): void {
    if (!changed.has("problems")) return;
    const wrong = [...this.problems.keys()].map(partOf).filter((part) => part !== null);
    if (wrong.length > 0) this._open = new Set([...this._open, ...wrong]);
  }

  override render(): TemplateResult {
    return html`<ol aria-label=${words.sections} @dragover=${this._drag.overList} @drop=${this._drag.drop}>
      ${repeat(
        this.sections,
        ({ part }) => part,
        (section, index) => this.row(section, index),
      )}
    </ol>`;
  }

  private row(section: SectionInput, index: number): TemplateResult {
    const { part, on } = section;
    const name = words.parts[part];
    const wrong = on && [...this.problems.keys()].some((field) => partOf(field) === part);
    const problem = this.problems.get(`section:${part}`);
    return html`<li
      data-part=${part}
      class="${on ? "" : "off"} ${wrong ? "wrong" : ""} ${this._drag.classes(part, index)}"
      @dragover=${(event: DragEvent) => this._drag.overRow(event, index)}
    >
      <div class="head">
        <span class="grip" draggable="true" title=${texts.layers.drag(name)} @dragstart=${(event: DragEvent) => this._drag.start(event, part, name)} @dragend=${this._drag.end}>${icon("grip")}</span>
        <label class="check">
          <input
            type="checkbox"
            name="on_${part}"
            aria-invalid=${problem !== undefined}
            aria-describedby=${problem ? `${part}_problem` : nothing}
            .checked=${on}
            @change=${(event: Event) => this.change(part, { on: (event.target as HTMLInputElement).checked })}
          />
          ${name}
        </label>
        <span class="buttons">
          ${this._order.buttons({ id: part, name, index, count: this.sections.length }, (to) => this.put(moved(this.sections, index, to)))}
        </span>
      </div>
      <p class="hint">${words.part_hints[part]}</p>
      ${problem ? html`<p class="error" role="alert" id="${part}_problem">${problem}</p>` : nothing}
      ${on ? this.details(section) : nothing}
    </li>`;
  }

  private details(section: SectionInput): TemplateResult {
    const { part } = section;
    const summary =
      part === "figures"
        ? words.details_figures
        : part === "findings"
          ? words.details_findings
          : words.details;
    return html`<details ?open=${this._open.has(part)} @toggle=${(event: Event) => this.onToggle(part, event)}>
      <summary>${summary}</summary>
      <div class="parts">
        <label class="field">
          <span>${words.heading}</span>
          <input type="text" name="heading_${part}" maxlength="200" autocomplete="off" placeholder=${words.heading_hint} .value=${section.heading} aria-invalid=${this.isWrong(part, "heading")} aria-describedby=${this.toldAt(part, "heading")} @input=${(event: Event) => this.change(part, { heading: valueFor(event) })} />
        </label>
        ${this.problemOf(part, "heading")}
        <label class="field">
          <span>${words.text}</span>
          <textarea name="text_${part}" placeholder=${words.text_hint} .value=${section.text} aria-invalid=${this.isWrong(part, "text")} aria-describedby=${this.toldAt(part, "text")} @input=${(event: Event) => this.change(part, { text: valueFor(event) })}></textarea>
        </label>
        ${this.problemOf(part, "text")} ${this.more(part)}
      </div>
    </details>`;
  }

  private isWrong(part: string, member: string): boolean {
    return this.problems.has(`section:${part}:${member}`);
  }
  private toldAt(part: string, member: string): string | typeof nothing {
    return this.isWrong(part, member) ? `${part}_${member}_problem` : nothing;
  }
  private problemOf(part: string, member: string): TemplateResult | typeof nothing {
    const problem = this.problems.get(`section:${part}:${member}`);
    return problem
      ? html`<p class="error" role="alert" id="${part}_${member}_problem">${problem}</p>`
      : nothing;
  }

  private onToggle(part: ReportPart, event: Event): void {
    const open = new Set(this._open);
    if ((event.target as HTMLDetailsElement).open) open.add(part);
    else open.delete(part);
    this._open = open;
  }

  private change(part: ReportPart, change: Partial<SectionInput>): void {
    this.put(this.sections.map((each) => (each.part === part ? { ...each, ...change } : each)));
  }

  private put(sections: readonly SectionInput[]): void {
    this.dispatchEvent(new CustomEvent<readonly SectionInput[]>("changed", { detail: sections }));
  }
}

const valueFor = (event: Event): string => (event.target as HTMLInputElement).value;
