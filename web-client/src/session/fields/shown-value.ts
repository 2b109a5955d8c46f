// A value of a record as people read it, in a cell of the table and on a card.

import { html } from "lit";
import { cell_text, named_keys, names_records } from "../../domain/cells";
import { format_list } from "../../core/locale";
import { holds_marks, marks_of, summary_of } from "../../domain/marks";
import { format_length } from "../../domain/measure";
import type { CellValue, Column } from "../../core/protocol.gen";
import type { ModelSession } from "../model-session";
import { texts } from "../../texts";

const kMostPictures = 4; // in a cell

/** A file that this person does not see has no picture either. */
const show_whether =
  (is_there: boolean) =>
  (event: Event): void => {
    (event.target as HTMLElement).hidden = !is_there;
  };

/** For a template; records are called by their names. */
export function shown_value(session: ModelSession, column: Column, value: CellValue): unknown {
  if (value === null) return "";
  if (names_records(column)) {
    const target = column.target ?? 0;
    return format_list(
      named_keys(value).map((key) => session.tables.label(target, key) ?? texts.tables.record(key)),
    );
  }
  if (holds_marks(column)) return shown_marks(session, column, value);
  if (column.kind === "document") return texts.files.count(named_keys(value).length);
  if (column.kind === "picture") {
    const ids = named_keys(value);
    return html`${ids
      .slice(0, kMostPictures)
      .map(
        (id) =>
          html`<img class="thumbnail" src=${session.api.attachment_url(id, 64)} alt=${texts.files.file(id)} loading="lazy" height="24" @load=${show_whether(true)} @error=${show_whether(false)} />`,
      )}${ids.length > kMostPictures ? ` +${ids.length - kMostPictures}` : ""}`;
  }
  if (column.kind === "boolean") return value ? texts.tables.yes : texts.tables.no;
  const text = cell_text(value);
  if (column.kind === "url" && /^(https?|mailto):/i.test(text)) {
    return html`<a class="text" href=${text} target="_blank" rel="noopener noreferrer" tabindex="-1">${text}</a>`;
  }
  return text;
}

/** "2 lines · 1.24 m": on this model; others are counted. */
export function shown_marks(
  { model }: ModelSession,
  { kind }: Pick<Column, "kind">,
  value: CellValue,
): string {
  if (!model || marks_of(value).length === 0) return "";
  const words = texts.marks;
  const { here, elsewhere, metres } = summary_of(value, model);
  const count = kind === "line" ? words.lines : words.points;
  if (here === 0) return words.elsewhere(count(elsewhere));
  return [
    count(here),
    kind === "line" ? format_length(metres) : [],
    elsewhere > 0 ? words.and_elsewhere(elsewhere) : [],
  ]
    .flat()
    .join(" · ");
}
