// Displays the value of a record in cells of the table and on cards.

import { html } from "lit";
import { cellText, namedKeys, namesRecords } from "../../domain/cells";
import { formatList } from "../../core/locale";
import { holdsMarks, marksOf, summaryOf } from "../../domain/marks";
import { formatLength } from "../../domain/measure";
import type { CellValue, Column } from "../../core/protocol.gen";
import type { ModelSession } from "../model-session";
import { texts } from "../../texts";

const kMostPictures = 4; // number of images in a cell

/** Hides the image of a file that this user cannot see. */
const showWhether =
  (isThere: boolean) =>
  (event: Event): void => {
    (event.target as HTMLElement).hidden = !isThere;
  };

/** Returns a value for a template. Records are shown by name. */
export function shownValue(session: ModelSession, column: Column, value: CellValue): unknown {
  if (value === null) return "";
  if (namesRecords(column)) {
    const target = column.target ?? 0;
    return formatList(
      namedKeys(value).map((key) => session.tables.label(target, key) ?? texts.tables.record(key)),
    );
  }
  if (holdsMarks(column)) return shownMarks(session, column, value);
  if (column.kind === "document") return texts.files.count(namedKeys(value).length);
  if (column.kind === "picture") {
    const ids = namedKeys(value);
    return html`${ids
      .slice(0, kMostPictures)
      .map(
        (id) =>
          html`<img class="thumbnail" src=${session.api.url("GET /attachments/{attachment}", { path: { attachment: id }, query: { thumbnail: 64 } })} alt=${texts.files.file(id)} loading="lazy" height="24" @load=${showWhether(true)} @error=${showWhether(false)} />`,
      )}${ids.length > kMostPictures ? ` +${ids.length - kMostPictures}` : ""}`;
  }
  if (column.kind === "boolean") return value ? texts.tables.yes : texts.tables.no;
  const text = cellText(value);
  if (column.kind === "url" && /^(https?|mailto):/i.test(text)) {
    return html`<a class="text" href=${text} target="_blank" rel="noopener noreferrer" tabindex="-1">${text}</a>`;
  }
  return text;
}

/**
 * Returns a summary such as "2 lines · 1.24 m" of the marks on this model. For marks on other
 * models, it contains only their number.
 */
export function shownMarks(
  { model }: ModelSession,
  { kind }: Pick<Column, "kind">,
  value: CellValue,
): string {
  if (!model || marksOf(value).length === 0) return "";
  const words = texts.marks;
  const { here, elsewhere, metres } = summaryOf(value, model);
  const count = kind === "line" ? words.lines : words.points;
  if (here === 0) return words.elsewhere(count(elsewhere));
  return [
    count(here),
    kind === "line" ? formatLength(metres) : [],
    elsewhere > 0 ? words.and_elsewhere(elsewhere) : [],
  ]
    .flat()
    .join(" · ");
}
