// A value of a record as people read it, in a cell of the table and on a card.

import { html } from "lit";
import { cell_text, named_keys, names_records } from "../core/cells";
import type { CellValue, Column } from "../core/protocol.gen";
import type { ModelSession } from "./model-session";
import { texts } from "./texts";

const kMostPictures = 4; // in a cell

/** For a template; records are called by their names. */
export function shown_value(session: ModelSession, column: Column, value: CellValue): unknown {
  if (value === null) return "";
  if (names_records(column)) {
    const target = column.target ?? 0;
    return named_keys(value)
      .map((key) => session.tables.label(target, key) ?? texts.tables.record(key))
      .join(", ");
  }
  if (column.kind === "document") return texts.files.count(named_keys(value).length);
  if (column.kind === "picture") {
    const ids = named_keys(value);
    return html`${ids.slice(0, kMostPictures).map(
      (id) => html`<img class="thumbnail" src=${session.api.attachment_url(id, 64)} alt=${texts.files.file(id)} loading="lazy" height="24" />`,
    )}${ids.length > kMostPictures ? ` +${ids.length - kMostPictures}` : ""}`;
  }
  if (column.kind === "boolean") return value ? texts.tables.yes : texts.tables.no;
  const text = cell_text(value);
  if (column.kind === "url" && /^(https?|mailto):/i.test(text)) {
    return html`<a class="text" href=${text} target="_blank" rel="noopener noreferrer" tabindex="-1">${text}</a>`;
  }
  return text;
}
