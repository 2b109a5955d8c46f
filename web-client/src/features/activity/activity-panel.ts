// <strata-activity-panel>: the activity of the model or of its project, by day.

import { css, html, nothing, type TemplateResult } from "lit";
import { customElement } from "lit/decorators.js";
import { repeat } from "lit/directives/repeat.js";
import { byDay } from "../../domain/activity";
import { formatList } from "../../core/locale";
import { formatArea } from "../../domain/measure";
import { called } from "../../domain/people";
import type { Activity } from "../../core/protocol.gen";
import { SidePanel, sidePanelStyles } from "../../session/side-panel";
import { icon } from "../../ui/icons";
import { panelLineStyles } from "../../ui/panel/panel-styles";
import { personMark, personMarkStyles } from "../../ui/person-mark";
import { radioGroup } from "../../ui/radio-group";
import { texts } from "../../texts";
import { toldClock, toldDay, toldTime } from "../../domain/times";

const words = texts.activity;

/** Returns the text of the first key for which `all` has a text. */
const textOf = (
  all: { readonly [key: string]: string; other: string },
  ...keys: string[]
): string => keys.map((key) => all[key]).find((text) => text !== undefined) ?? all.other;

@customElement("strata-activity-panel")
export class StrataActivityPanel extends SidePanel {
  protected readonly heading = words.title;

  constructor() {
    super("activity", "tables", "layers", "comments");
  }

  static override styles = [
    sidePanelStyles,
    panelLineStyles,
    personMarkStyles,
    css`
      h3 {
        margin: var(--space-2) 0 0;
        font-size: var(--text-tiny);
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
      .with-then {
        display: grid;
        grid-template-columns: minmax(0, 1fr) auto;
        align-items: start;
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
    this.session.activity.watch(true);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.session.activity.watch(false);
  }

  protected content(): TemplateResult {
    const { activity } = this.session;
    return html`${radioGroup({
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
      ${byDay(activity.lines, (time) => toldDay(time)).map(
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
      ${activity.hasMore ? html`<button ?disabled=${activity.busy} @click=${() => void activity.more()}>${words.more}</button>` : nothing}`;
  }

  private line(line: Activity): TemplateResult {
    const { activity } = this.session;
    const content = html`${line.user === undefined ? html`<span class="server">${icon("cube")}</span>` : personMark({ ...line, user: line.user })}
      <span class="what"><b>${line.user === undefined ? words.server : called({ ...line, user: line.user })}</b> ${this.done(line)}</span>
      <span class="hint">${toldClock(line.time)}</span>
      <span class="more-of-it hint">${this.details(line)}</span>`;
    const shown = activity.leadsSomewhere(line)
      ? html`<button class="quiet line" data-activity=${line.id} @click=${() => void activity.goTo(line)}>${content}</button>`
      : html`<div class="line" data-activity=${line.id}>${content}</div>`;
    if (line.kind !== "edit" || activity.isElsewhere(line)) return shown;
    return html`<div class="with-then">
      ${shown}
      <button
        class="icon quiet"
        aria-label=${words.show_then(toldTime(line.time))}
        title=${words.show_then(toldTime(line.time))}
        @click=${() => void this.session.past.open(line.time)}
      >
        ${icon("history")}
      </button>
    </div>`;
  }

  private done({ kind, op, name, person, group }: Activity): TemplateResult {
    const about =
      kind === "member" && group !== undefined
        ? person === undefined
          ? "group"
          : "in_group"
        : kind;
    const what = kind === "member" ? (person ?? group) : name;
    return html`${textOf(words.done, `${about} ${op}`, kind)}${what === undefined ? nothing : html` <b>${what}</b>`}`;
  }

  private details(line: Activity): string {
    const {
      kind,
      op,
      count,
      area_m2: areaM2,
      text,
      record,
      table,
      role,
      changed,
      model_name: modelName,
      model,
      person,
      group,
    } = line;
    const isElsewhere = model !== undefined && model !== this.session.model?.id;
    const parts = [
      kind === "edit" &&
        (op === "stroke" ? words.strokes(count) : count > 1 ? words.times(count) : ""),
      kind === "edit" && areaM2 ? formatArea(areaM2) : "",
      kind === "records" &&
        (record === undefined ? texts.tables.records(count) : this.recordName(table, record)),
      kind === "columns" && words.columns(count),
      person !== undefined && group !== undefined ? group : "",
      kind === "member" && role ? texts.roles[role] : "",
      changed ? formatList([...new Set(changed.map((each) => textOf(words.changed, each)))]) : "",
      text ?? "",
      isElsewhere && kind !== "model" ? (modelName ?? "") : "",
    ];
    return parts.filter(Boolean).join(" · ");
  }

  private recordName(table: number | undefined, record: number): string {
    return (
      (table === undefined ? null : this.session.tables.label(table, record)) ??
      texts.tables.record(record)
    );
  }
}
