// Calls about records of a table, or of a layer that contains keys of its records.

import { personLanguages } from "../core/locale";
import type { RecordInput, RecordList, RecordPatch, TableEdit } from "../core/protocol.gen";
import type { TableRecord } from "../core/types";
import { ifVersion, kAsItIs, type Api } from "./api";
import type { Id } from "./calls";

/** A table, or a layer that contains keys of its records. */
export type RecordPlace = { table: Id } | { model: Id; layer: Id };

export interface RecordQuery {
  sortby?: string;
  filter?: string; // CQL2 text
  limit: number;
  offset: number;
}

/**
 * Reads a page of a table's records. With a layer, the result includes the areas of the records on
 * the layer.
 */
export async function readRecords(
  api: Api,
  place: RecordPlace,
  { sortby = "", filter = "", limit, offset }: RecordQuery,
): Promise<RecordList> {
  const query = {
    limit,
    offset,
    ...(sortby === "" ? {} : { sortby }),
    // The language of the alphabetical order.
    ...(/^(-?key)?$/.test(sortby) ? {} : { lang: personLanguages()[0]! }),
    ...(filter === "" ? {} : { filter }),
  };
  return "table" in place
    ? api.json("GET /tables/{table}/records", { path: place, query })
    : api.json("GET /models/{model}/layers/{layer}/records", { path: place, query });
}

export const readRecord = (api: Api, place: RecordPlace, key: number): Promise<TableRecord> =>
  "table" in place
    ? api.json("GET /tables/{table}/records/{key}", { path: { ...place, key } })
    : api.json("GET /models/{model}/layers/{layer}/records/{key}", { path: { ...place, key } });

/** Creates a record. Without a key, the record gets the next free key. */
export async function createRecord(
  api: Api,
  table: Id,
  record: RecordInput = {},
): Promise<TableRecord> {
  const body = { values: {}, ...record };
  return (await api.json("POST /tables/{table}/records", { path: { table }, body })) as TableRecord;
}

/**
 * Changes the version of a record that was read. If another user has changed the record since, an
 * ApiError with status 412 is thrown.
 */
export const changeRecord = (
  api: Api,
  table: Id,
  key: number,
  change: RecordPatch,
): Promise<TableRecord> =>
  api.json("PATCH /tables/{table}/records/{key}", {
    path: { table, key },
    body: change,
    header: change.version === undefined ? kAsItIs : ifVersion(change.version),
  });

/** Returns the latest edit of a record. */
export async function lastEditOf(api: Api, table: Id, key: number): Promise<TableEdit | undefined> {
  const query = { key, limit: 1 };
  return (await api.json("GET /tables/{table}/edits", { path: { table }, query })).edits[0];
}
