// The content of a record's card: the values of its columns in the visitor's language, and its
// images. The tour lists the columns. Without a list, the card shows the table's columns.

import { ApiError } from "../net/api-error";
import type { Api } from "../net/api";
import { readRecord } from "../net/records";
import {
  cellText,
  holdsFiles,
  labelOf,
  labelOfRecord,
  namedKeys,
  namesRecords,
} from "../domain/cells";
import { formatList, withDecimalSign } from "../core/locale";
import { holdsMarks } from "../domain/marks";
import type {
  Attachment,
  CellValue,
  Column,
  Table,
  TableRecord,
  TourColumn,
  TourStop,
} from "../core/protocol.gen";
import { asKiosk } from "./as-kiosk";
import { wordsIn } from "./languages";
import { textsIn } from "./texts";

export interface CardPicture {
  name: string;
  small: string; // URLs
  large: string;
}

export interface Card {
  table: string;
  key: number;
  title: string;
  lines: { label: string; text: string }[];
  pictures: CardPicture[];
}

export interface CardAsked {
  table: string; // slug or id
  key: number;
  stop: TourStop;
  language: string;
  languages: readonly string[]; // the tour's languages
}

const kMostLines = 8; // for a table whose columns the tour does not list
const kMostPictures = 12;

/**
 * Returns the card, or null if the record does not exist or is not public. Throws an ApiError for
 * other failures.
 */
export async function cardOf(api: Api, asked: CardAsked): Promise<Card | null> {
  try {
    return await readCard(api, asked);
  } catch (error) {
    if (error instanceof ApiError && error.status === 404) return null;
    throw error;
  }
}

async function readCard(api: Api, asked: CardAsked): Promise<Card> {
  const table = await api.json("GET /tables/{table}", { path: { table: asked.table } });
  const [record, { attachments }] = await Promise.all([
    readRecord(api, { table: table.id }, asked.key),
    api.json("GET /tables/{table}/records/{key}/attachments", {
      path: { table: table.id, key: asked.key },
    }),
  ]);
  const title =
    labelOfRecord(table, record, [asked.language]) ||
    textsIn(asked.language, asked.languages).record(asked.key);
  const shown = columnsShown(
    table,
    asked.stop.records.find((records) => records.table === table.slug)?.columns,
  );
  const lines: Card["lines"] = [];
  for (const { column, chosen } of shown) {
    if (holdsFiles(column)) continue;
    const text = await textOf(api, asked, column, record.values[column.slug] ?? null);
    // The card does not repeat its heading, unless the tour lists the heading's column.
    if (text === "" || (!chosen && text === title) || (!chosen && lines.length >= kMostLines))
      continue;
    lines.push({ label: labelOnCard(column, chosen, asked), text });
  }
  return {
    table: table.slug,
    key: asked.key,
    title,
    lines,
    pictures: picturesOf(
      shown.map(({ column }) => column),
      record,
      attachments,
    ),
  };
}

/**
 * Returns the label from the tour or the table in the visitor's language. Without one, returns the
 * tour's label in its first language, or the column's name in any language.
 */
function labelOnCard(
  column: Column,
  chosen: TourColumn | null,
  { language, languages }: CardAsked,
): string {
  const inLanguage =
    chosen?.labels?.[language] || labelOf({ name: "", labels: column.labels }, [language]);
  return inLanguage || wordsIn(chosen?.labels, language, languages.slice(0, 1)) || column.name;
}

interface ShownColumn {
  column: Column;
  chosen: TourColumn | null;
}

function columnsShown(
  { columns }: Table,
  chosen: readonly TourColumn[] | undefined,
): ShownColumn[] {
  if (!chosen || chosen.length === 0)
    return columns
      .filter((column) => !holdsMarks(column))
      .map((column) => ({ column, chosen: null }));
  return chosen.flatMap((each) => {
    const column = columns.find(({ slug }) => slug === each.column);
    return column ? [{ column, chosen: each }] : [];
  });
}

async function textOf(
  api: Api,
  asked: CardAsked,
  column: Column,
  value: CellValue,
): Promise<string> {
  if (value === null) return "";
  const words = textsIn(asked.language, asked.languages);
  if (namesRecords(column))
    return formatList(await namesOf(api, asked, column.target ?? 0, namedKeys(value)));
  if (column.kind === "boolean") return value ? words.yes : words.no;
  const text = typeof value === "number" ? withDecimalSign(String(value)) : cellText(value);
  return column.unit ? `${text} ${column.unit}` : text;
}

/** Returns the names of the public records with these keys. */
async function namesOf(
  api: Api,
  { language }: CardAsked,
  table: number,
  keys: readonly number[],
): Promise<string[]> {
  if (keys.length === 0) return [];
  try {
    const target = await api.json("GET /tables/{table}", { path: { table } });
    const records = await Promise.all(keys.map((key) => readRecord(api, { table }, key)));
    return records
      .map((record) => labelOfRecord(target, record, [language]))
      .filter((name) => name !== "");
  } catch (error) {
    if (error instanceof ApiError && (error.status === 403 || error.status === 404)) return [];
    throw error;
  }
}

/**
 * Returns the images in the displayed columns, in their order. Only the two formats for which the
 * server makes thumbnails and which browsers can display are included.
 */
function picturesOf(
  columns: readonly Column[],
  record: Pick<TableRecord, "values">,
  files: readonly Attachment[],
): CardPicture[] {
  const ids = columns
    .filter(({ kind }) => kind === "picture")
    .flatMap(({ slug }) => namedKeys(record.values[slug]));
  return ids
    .flatMap(
      (id) =>
        files.find((file) => file.id === id && /^image\/(jpeg|png)$/.test(file.media_type)) ?? [],
    )
    .slice(0, kMostPictures)
    .map(({ id, name }) => ({ name, small: thumbnail(id, 256), large: thumbnail(id, 1024) }));
}
const thumbnail = (id: number, side: number): string =>
  asKiosk(`/api/v1/attachments/${id}?thumbnail=${side}`);
