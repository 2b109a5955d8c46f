// Calls about records: of a table, or of the layer that contains its keys.

import { personLanguages } from "../core/locale";
import type { RecordInput, RecordList, RecordPatch, TableEdit } from "../core/protocol.gen";
import type { TableRecord } from "../core/types";
import { ifVersion, kAsItIs, type Api } from "./api";
import type { Id } from "./calls";

/** Records of a table, or of the table whose keys a layer contains. */
export type RecordPlace = { table: Id } | { model: Id; layer: Id };

export interface RecordQuery {
  sortby?: string;
  filter?: string; // CQL2 text
  limit: number;
  offset: number;
}

/** A page of a table's records; with a layer, including their areas there. */
export async function readRecords(
  api: Api,
  place: RecordPlace,
  { sortby = "", filter = "", limit, offset }: RecordQuery,
): Promise<RecordList> {
  const query = {
    limit,
    offset,
    ...(sortby === "" ? {} : { sortby }),
    // language of the alphabetical order
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

/** Without a key, the record gets the next one. */
export async function createRecord(
  api: Api,
  table: Id,
  record: RecordInput = {},
): Promise<TableRecord> {
  const body = { values: {}, ...record };
  return (await api.json("POST /tables/{table}/records", { path: { table }, body })) as TableRecord;
}

/**
 * Changes the version that was read; after another person's change the result is an ApiError with
 * status 412.
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

/** The latest edit of a record. */
export async function lastEditOf(api: Api, table: Id, key: number): Promise<TableEdit | undefined> {
  const query = { key, limit: 1 };
  return (await api.json("GET /tables/{table}/edits", { path: { table }, query })).edits[0];
}
