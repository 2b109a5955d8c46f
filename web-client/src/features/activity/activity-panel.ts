// <strata-activity-panel>: what was done on the model, or in its whole project, by days.

import { css, html, nothing, type TemplateResult } from "lit";
import { customElement } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { by_day } from "../../domain/activity";
import { format_list } from "../../core/locale";
import { format_area } from "../../domain/measure";
import { called } from "../../domain/people";
import type { Activity } from "../../core/protocol.gen";
import { FoldingPanel, folding_styles } from "../../session/folding-panel";
import { icon } from "../../ui/icons";
import { panel_line_styles } from "../../ui/panel-styles";
import { person_mark, person_mark_styles } from "../../ui/person-mark";
import { radio_group } from "../../ui/radio-group";
import { texts } from "../../texts";
import { told_clock, told_day } from "../../domain/times";

const words = texts.activity;

/** That of the first key which has one. */
const text_of = (
  all: { readonly [key: string]: string; other: string },
  ...keys: string[]
): string => keys.map((key) => all[key]).find((text) => text !== undefined) ?? all.other;

@customElement("strata-activity-panel")
export class StrataActivityPanel extends FoldingPanel {
  protected readonly heading = words.title;

  constructor() {
    super("activity");
  }

  static override styles = [
    folding_styles,
    panel_line_styles,
    person_mark_styles,
    css`
      h3 {
        margin: 0.375rem 0 0;
        font-size: 0.8rem;
        font-weight: 600;
        color: var(--ink-soft);
      }
      h3::first-letter {
        text-transform: uppercase;
      }
      .server {
        grid-row: span 2;
        display: grid;
        place-items: center;
        width: 1.625rem;
        height: 1.625rem;
        color: var(--ink-soft);
      }
      .what {
        overflow-wrap: anywhere;
      }
      .more-of-it {
        grid-column: 2 / 4;
        overflow-wrap: anywhere;
      }
    `,
  ];

  override connectedCallback(): void {
    super.connectedCallback();
    this.session.activity.watch(this.is_open);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.session.activity.watch(false);
  }

  protected override toggled(): void {
    this.session.activity.watch(this.is_open);
  }

  protected content(): TemplateResult {
    const { activity } = this.session;
    return html`${radio_group({
      label: words.of,
      class: "segments",
      choices: [
        { value: false, content: words.of_model },
        { value: true, content: words.of_project },
      ],
      chosen: activity.whole,
      choose: (whole) => (activity.whole = whole),
    })}
      ${
        activity.failed
          ? html`<p class="error" role="alert">${words.failed}</p>
            <button @click=${() => void activity.load()}>${texts.try_again}</button>`
          : nothing
      }
      ${activity.lines.length === 0 && !activity.failed ? html`<p class="hint">${activity.loaded ? words.none : texts.loading}</p>` : nothing}
      ${by_day(activity.lines, (time) => told_day(time)).map(
        ({ day, lines }) =>
          html`<h3>${day}</h3>
            <ul aria-label=${day}>
              ${repeat(
                lines,
                ({ id }) => id,
                (line) => html`<li>${this.line(line)}</li>`,
              )}
            </ul>`,
      )}
      ${activity.has_more ? html`<button ?disabled=${activity.busy} @click=${() => void activity.more()}>${words.more}</button>` : nothing}`;
  }

  private line(line: Activity): TemplateResult {
    const { activity } = this.session;
    const content = html`${line.user === undefined ? html`<span class="server">${icon("cube")}</span>` : person_mark({ ...line, user: line.user })}
      <span class="what"><b>${line.user === undefined ? words.server : called({ ...line, user: line.user })}</b> ${this.done(line)}</span>
      <span class="hint numeric">${told_clock(line.time)}</span>
      <span class="more-of-it hint">${this.details(line)}</span>`;
    return activity.leads_somewhere(line)
      ? html`<button class="quiet line" data-activity=${line.id} @click=${() => void activity.go_to(line)}>${content}</button>`
      : html`<div class="line" data-activity=${line.id}>${content}</div>`;
  }

  private done({ kind, op, name, person, group }: Activity): TemplateResult {
    const about =
      kind === "member" && group !== undefined
        ? person === undefined
          ? "group"
          : "in_group"
        : kind;
    const what = kind === "member" ? (person ?? group) : name;
    return html`${text_of(words.done, `${about} ${op}`, kind)}${what === undefined ? nothing : html` <b>${what}</b>`}`;
  }

  private details(line: Activity): string {
    const {
      kind,
      op,
      count,
      area_m2,
      text,
      record,
      table,
      role,
      changed,
      model_name,
      model,
      person,
      group,
    } = line;
    const is_elsewhere = model !== undefined && model !== this.session.model?.id;
    const parts = [
      kind === "edit" &&
        (op === "stroke" ? words.strokes(count) : count > 1 ? words.times(count) : ""),
      kind === "edit" && area_m2 ? format_area(area_m2) : "",
      kind === "records" &&
        (record === undefined ? texts.tables.records(count) : this.record_name(table, record)),
      kind === "columns" && words.columns(count),
      person !== undefined && group !== undefined ? group : "",
      kind === "member" && role ? texts.roles[role] : "",
      changed ? format_list([...new Set(changed.map((each) => text_of(words.changed, each)))]) : "",
      text ?? "",
      is_elsewhere && kind !== "model" ? (model_name ?? "") : "",
    ];
    return parts.filter(Boolean).join(" · ");
  }

  private record_name(table: number | undefined, record: number): string {
    return (
      (table === undefined ? null : this.session.tables.label(table, record)) ??
      texts.tables.record(record)
    );
  }
}
