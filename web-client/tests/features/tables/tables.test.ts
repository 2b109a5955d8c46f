import { beforeEach, describe, expect, it } from "vitest";

import { CellEdits } from "../../../src/features/tables/cell-edits";
import {
  columnChanges,
  ofKind,
  type ColumnWanted,
} from "../../../src/features/tables/column-changes";
import { RecordNames } from "../../../src/features/tables/record-names";
import { kPageRows, RecordRows } from "../../../src/features/tables/record-rows";
import { Tables } from "../../../src/features/tables/tables";
import { Api } from "../../../src/net/api";
import { ApiError } from "../../../src/net/api-error";
import type { RecordQuery } from "../../../src/net/records";
import {
  labelColumn,
  labelOf,
  labelOfRecord,
  namedKeys,
  parseCell,
} from "../../../src/domain/cells";
import type {
  CellValue,
  Column,
  ColumnKind,
  Mark,
  Picked,
  Table,
  TableRecord,
} from "../../../src/core/protocol.gen";
import type { Layer } from "../../../src/core/types";

const column = (
  id: number,
  slug: string,
  kind: ColumnKind = "text",
  more: Partial<Column> = {},
): Column => ({
  id,
  name: slug,
  slug,
  labels: {},
  kind,
  required: false,
  unique: false,
  comment: "",
  order: id,
  visibility: "public",
  ...more,
});
const table = (...columns: Column[]): Table => ({
  id: 3,
  project: 1,
  name: "Units",
  slug: "units",
  kind: "records",
  labels: {},
  description: "",
  columns,
  records: 0,
  sequence: 0,
});
const record = (key: number, values: Record<string, CellValue> = {}, version = 1): TableRecord => ({
  key,
  version,
  values,
});
const settle = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));

describe("cells", () => {
  it("hold what was typed, and nothing is guessed", () => {
    expect(parseCell({ kind: "numeric" }, " 1.50 ")).toEqual({ value: 1.5 });
    expect(parseCell({ kind: "numeric" }, "-2e3")).toEqual({ value: -2000 });
    for (const text of ["1,5", "1 000", "0x10", "Infinity", "deep", ".", "1e999"])
      expect(parseCell({ kind: "numeric" }, text)).toEqual({ wrong: "number" });
    expect(parseCell({ kind: "integer" }, "7")).toEqual({ value: 7 });
    expect(parseCell({ kind: "integer" }, "7.5")).toEqual({ wrong: "whole" });
    expect(parseCell({ kind: "period" }, " 1560~ ")).toEqual({ value: "1560~" });
    expect(parseCell({ kind: "text" }, " as it is ")).toEqual({ value: " as it is " });
    expect(parseCell({ kind: "boolean" }, "false")).toEqual({ value: false });
    for (const kind of ["text", "numeric", "date", "enumeration", "boolean"] as const)
      expect(parseCell({ kind }, "")).toEqual({ value: null });
  });

  it("name the records of a relation and of a term", () => {
    expect(namedKeys([2, 5])).toEqual([2, 5]);
    expect(namedKeys(2)).toEqual([2]);
    expect(namedKeys(null)).toEqual([]);
  });

  it("are called as the person's languages have it, the nearest first", () => {
    const thing = { name: "Depth", labels: { es: "Profundidad", "pt-BR": "Profundidade" } };
    expect(labelOf(thing, ["es-MX", "en"])).toBe("Profundidad");
    expect(labelOf(thing, ["fr", "pt-BR"])).toBe("Profundidade");
    expect(labelOf(thing, ["pt-br"])).toBe("Profundidade");
    expect(labelOf(thing, ["fr"])).toBe("Depth");
  });

  it("of the column that tells records apart are what the record is called", () => {
    const code = column(2, "code", "text", { required: true, unique: true });
    expect(labelColumn(table(column(1, "note"), code))).toBe(code);
    expect(labelColumn(table(column(1, "note"), column(2, "depth", "numeric")))?.slug).toBe("note");
    expect(labelColumn(table(column(1, "number", "integer", { unique: true })))?.slug).toBe(
      "number",
    );
    expect(labelColumn(table(column(1, "above", "relation", { unique: true })))).toBeNull();
    expect(labelOfRecord(table(code), record(1, { code: "SU 1" }))).toBe("SU 1");
    const titled = {
      ...table(code, column(1, "note"), column(3, "damage", "term", { target: 9 })),
      title_column: 1,
    };
    expect(labelColumn(titled)?.slug).toBe("note");
    // records without a value in the title column use the usual name
    expect(labelOfRecord(titled, record(1, { code: "SU 1", note: null }))).toBe("SU 1");
    // the title column was dropped or is invisible
    expect(labelColumn({ ...titled, title_column: 77 })).toBe(code);
    const byTerm = { ...titled, title_column: 3 };
    expect(
      labelOfRecord(
        byTerm,
        record(1, { code: "SU 1", damage: 4 }),
        ["en"],
        (of, key) => `${of}/${key}`,
      ),
    ).toBe("9/4");
    expect(labelOfRecord(byTerm, record(1, { code: "SU 1", damage: 4 }))).toBe("SU 1");
    const observed = table(column(1, "damage", "term", { target: 9 }), column(2, "observer"));
    expect(
      labelOfRecord(
        observed,
        record(1, { damage: 4, observer: "Ida" }),
        ["en"],
        (of, key) => `${of}/${key}`,
      ),
    ).toBe("9/4");
    expect(
      labelColumn(table(column(2, "observer"), column(1, "damage", "term", { target: 9 })))?.slug,
    ).toBe("observer");
    expect(labelOfRecord(table(), record(1))).toBe("");
  });
});

describe("the rows of a table", () => {
  let asked: RecordQuery[];
  let answers: ((total: number, refuse?: ApiError) => Promise<void>)[];
  let rows: RecordRows;
  let outdated: number;

  const all = (total: number): TableRecord[] =>
    Array.from({ length: total }, (_, key) => record(key, { n: key }));

  beforeEach(() => {
    asked = [];
    answers = [];
    outdated = 0;
    rows = new RecordRows({
      ask: (query) =>
        new Promise((resolve, reject) => {
          asked.push(query);
          answers.push((total, refuse) => {
            if (refuse) reject(refuse);
            else
              resolve({
                records: all(total).slice(query.offset, query.offset + query.limit),
                total,
              });
            return settle();
          });
        }),
      changed: () => {},
      measuresOutdated: () => void (outdated += 1),
    });
  });

  it("are asked for in pages, those in sight only, and at most two at a time", async () => {
    rows.want(0, 20);
    expect(asked.map(({ offset }) => offset)).toEqual([0]);
    await answers[0]!(10_000);
    expect(rows.total).toBe(10_000);
    expect(rows.row(99)?.key).toBe(99);
    expect(rows.row(100)).toBeNull();
    rows.want(5050, 5350);
    expect(asked.map(({ offset }) => offset)).toEqual([0, 5000, 5100]);
    rows.want(9950, 9999); // after further scrolling, rows in between are not requested
    await answers[1]!(10_000);
    expect(asked.map(({ offset }) => offset)).toEqual([0, 5000, 5100, 9900]);
    await answers[3]!(10_000);
    rows.want(9950, 10_050);
    expect(asked).toHaveLength(4); // no rows after the last one are requested
    expect(rows.row(9999)?.key).toBe(9999);
  });

  it("of another order replace the old ones when they are here, and answers to the old question are left", async () => {
    rows.want(0, 10);
    await answers[0]!(300);
    rows.setQuery({ sortby: "-n" });
    expect(rows.row(0)?.key).toBe(0); // old rows stay until the new ones arrive
    rows.setQuery({ sortby: "n" });
    expect(asked.slice(1).map(({ sortby }) => sortby)).toEqual(["-n", "n"]);
    await answers[2]!(200);
    expect(rows.total).toBe(200);
    await answers[1]!(5);
    expect(rows.total).toBe(200);
    rows.setQuery({ sortby: "n" });
    expect(asked).toHaveLength(3);
  });

  it("that a wrong filter asks for stay as they were, with what is wrong", async () => {
    rows.want(0, 10);
    await answers[0]!(300);
    rows.setQuery({ filter: "n >" });
    await answers[1]!(
      0,
      new ApiError({ status: 422, title: "x", detail: "y", field: "filter", offset: 3 }),
    );
    expect(rows.problem?.offset).toBe(3);
    expect(rows.row(5)?.key).toBe(5);
    rows.want(0, 10);
    expect(asked).toHaveLength(2); // rows with a problem are not requested repeatedly
    rows.setQuery({ filter: "n > 3" });
    expect(rows.problem).toBeNull();
    await answers[2]!(300);
    expect(rows.filter).toBe("n > 3");
  });

  it("follow what others write, in their place and with the area that they had", async () => {
    rows.want(0, 10);
    await answers[0]!(3);
    rows.put({ ...record(1, { n: 7 }, 5), area_m2: 2 });
    expect(rows.row(1)).toEqual({ ...record(1, { n: 7 }, 5), area_m2: 2 });
    rows.put(record(1, { n: 8 }, 6));
    expect(rows.row(1)).toEqual({ ...record(1, { n: 8 }, 6), area_m2: 2 });
    rows.put(record(1, { n: 9 }, 4)); // this response arrived late
    expect(rows.row(1)?.values["n"]).toBe(8);
    rows.put(record(99, { n: 9 }, 4)); // this row is not loaded
  });

  it("are measured anew when their lines or points change, and keep what they measured until then", async () => {
    const cracks = [
      {
        model: 1,
        coordinates: [
          [0, 0, 0],
          [1, 0, 0],
        ],
      },
    ] as Mark[];
    rows.want(0, 10);
    await answers[0]!(3);
    rows.put({ ...record(1, { cracks }, 5), area_m2: 2, length_m: 1 });
    expect(outdated).toBe(0); // these measures are for the layer
    rows.put({ ...record(1, { cracks, n: 8 }, 6), length_m: 7 }); // this length is for all models
    expect([rows.row(1)?.length_m, outdated]).toEqual([1, 0]);
    rows.put({ ...record(1, { cracks: [...cracks, ...cracks] }, 7), length_m: 8 });
    expect([rows.row(1)?.length_m, rows.row(1)?.area_m2, outdated]).toEqual([1, 2, 1]);
    rows.put(record(1, { cracks: null }, 8));
    expect(outdated).toBe(2);
  });

  it("are looked through for a record that is far away", async () => {
    rows.want(0, 10);
    await answers[0]!(2500);
    const found = rows.locate(2222);
    for (let at = 1; at <= 3; ++at) {
      await settle();
      await answers[at]!(2500);
    }
    expect(await found).toBe(2222);
    expect(asked.slice(1).map(({ limit, offset }) => [limit, offset])).toEqual([
      [1000, 0],
      [1000, 1000],
      [1000, 2000],
    ]);
    expect(rows.row(2222)?.key).toBe(2222);
    const missing = rows.locate(9999);
    for (let at = 4; at <= 6; ++at) {
      await settle();
      await answers[at]!(2500);
    }
    expect(await missing).toBeNull();
    expect(2500 % kPageRows).toBe(0);
  });
});

/** A fake server with one record. The version in a write must match the record's version. */
class FakeTable {
  stored = record(7, { depth: 1, code: "SU 7" }, 4);
  told: string[] = [];
  beforeChange: () => void = () => {};
  refuse: { status: number; title: string; detail: string } | null = null;

  readonly api = new Api(async (path, init) => {
    this.told.push(`${init!.method} ${path.replace("/api/v1/tables/3", "")}`);
    const answer = (status: number, body: unknown): Response =>
      new Response(JSON.stringify(body), { status });
    if (path.includes("/edits"))
      return answer(200, { edits: [{ user: "anna", time: "2024-05-02T12:00:00Z" }], total: 1 });
    if (init!.method === "GET") return answer(200, this.stored);
    this.beforeChange();
    this.beforeChange = () => {};
    if (this.refuse) return answer(this.refuse.status, this.refuse);
    const change = JSON.parse(init!.body as string) as {
      version: number;
      values: Record<string, CellValue>;
    };
    if (change.version !== this.stored.version)
      return answer(412, { status: 412, title: "Changed", detail: "d" });
    this.write(change.values);
    return answer(200, this.stored);
  });
  write(values: Record<string, CellValue>): void {
    this.stored = record(7, { ...this.stored.values, ...values }, this.stored.version + 1);
  }
}

describe("what is written into cells", () => {
  let server: FakeTable;
  let row: TableRecord;
  let edits: CellEdits;

  beforeEach(() => {
    server = new FakeTable();
    row = server.stored;
    edits = new CellEdits(server.api, {
      table: 3,
      row: () => row,
      put: (newest) => (row = newest),
      changed: () => {},
    });
  });

  it("is shown at once, and is the table's when the server has it", async () => {
    const done = edits.write(7, "depth", 2, 1);
    expect(edits.of(7, "depth")).toMatchObject({ value: 2, state: "saving" });
    await done;
    expect(edits.of(7, "depth")).toBeNull();
    expect(row.values["depth"]).toBe(2);
  });

  it("is no change where it is the same", async () => {
    await edits.write(7, "depth", 1, 1);
    expect(server.told).toEqual([]);
  });

  it("goes one after the other, each onto the version that the one before made", async () => {
    const done = [
      edits.write(7, "depth", 2, 1),
      edits.write(7, "code", "SU 8", "SU 7"),
      edits.write(7, "depth", 3, 2),
    ];
    await Promise.all(done);
    expect(server.stored.values).toEqual({ depth: 3, code: "SU 8" });
    expect(edits.open).toEqual([]);
    expect(server.told.some((each) => each.startsWith("GET"))).toBe(false);
  });

  it("goes onto what others wrote into other cells of the record", async () => {
    server.beforeChange = () => server.write({ code: "SU 70" });
    await edits.write(7, "depth", 2, 1);
    expect(server.stored.values).toEqual({ depth: 2, code: "SU 70" });
    expect(edits.open).toEqual([]);
  });

  it("waits for the person where somebody else wrote into the same cell: theirs stays, or mine goes over it", async () => {
    server.beforeChange = () => server.write({ depth: 9 });
    await edits.write(7, "depth", 2, 1);
    const [edit] = edits.open;
    expect(edit).toMatchObject({ state: "conflict", value: 2, theirs: { value: 9, user: "anna" } });
    expect(server.stored.values["depth"]).toBe(9);
    await edits.insist(edit!);
    expect(server.stored.values["depth"]).toBe(2);
    expect(edits.open).toEqual([]);
    // the page received this version with an event
    row = record(7, { depth: 5 }, server.stored.version);
    server.stored = row;
    await edits.write(7, "depth", 6, 2);
    expect(edits.open[0]?.theirs?.value).toBe(5);
    edits.forget(7, "depth");
    expect(edits.open).toEqual([]);
    expect(server.stored.values["depth"]).toBe(5);
  });

  it("stays with what is wrong where the server refuses it, until it is corrected", async () => {
    server.refuse = { status: 422, title: "Bad value", detail: "Depth begins at 0." };
    await edits.write(7, "depth", -1, 1);
    expect(edits.of(7, "depth")).toMatchObject({
      state: "refused",
      value: -1,
      problem: "Depth begins at 0.",
    });
    server.refuse = null;
    await edits.write(7, "depth", 4, 1);
    expect(edits.open).toEqual([]);
    expect(row.values["depth"]).toBe(4);
  });
});

describe("the names of records", () => {
  const units = table(column(1, "code", "text", { unique: true }));
  let count: number;
  let offsets: (string | null)[];
  let names: RecordNames;

  beforeEach(() => {
    count = 3;
    offsets = [];
    const api = new Api(async (path) => {
      const query = new URL(path, "http://x").searchParams;
      offsets.push(query.get("offset"));
      const [limit, offset] = [Number(query.get("limit")), Number(query.get("offset"))];
      const records = Array.from({ length: Math.min(limit, count - offset) }, (_, at) =>
        record(offset + at, { code: at === 2 ? null : `SU ${offset + at}` }),
      );
      return new Response(JSON.stringify({ records, total: count }));
    });
    names = new RecordNames(
      api,
      () => units,
      () => {},
    );
  });

  it("are asked for once somebody needs one, and follow the table", async () => {
    names.put(record(1, { code: "late" }));
    expect(offsets).toEqual([]);
    expect(names.label(1)).toBeNull();
    expect(names.lacks(7)).toBe(false); // unknown before the names are loaded
    await settle();
    expect(names.label(1)).toBe("SU 1");
    expect(names.label(2)).toBeNull();
    expect([names.lacks(2), names.lacks(7)]).toEqual([false, true]);
    names.put(record(2, { code: "Pit" }));
    expect(names.label(2)).toBe("Pit");
    names.remove(2);
    expect(names.label(2)).toBeNull();
    expect(offsets).toEqual(["0"]);
    count = 1500;
    names.refresh();
    await settle();
    await settle();
    expect(offsets).toEqual(["0", "0", "1000"]);
    expect(names.label(1400)).toBe("SU 1400");
  });

  it("stand in the alphabet, or as the terms that they are called by stand in their list", async () => {
    const called = ["Zinc", "äther", "Apple 10", "Apple 9", ""];
    const many = new Api(async () => {
      const records = called.map((code, key) =>
        record(key, { code: code || null, damage: [5, 7, 7, 6, null][key]! }),
      );
      return new Response(JSON.stringify({ records, total: records.length }));
    });
    const damage = column(2, "damage", "term", { target: 9 });
    const withTerms = { ...table(units.columns[0]!, damage), id: 3 };
    let now: Table = withTerms;
    const others = {
      nameOf: (_: number, key: number) => ({ 5: "Salts", 6: "Cracks", 7: "Loss" })[key] ?? null,
      places: () =>
        new Map([
          [7, 0],
          [5, 1],
          [6, 2],
        ]),
    };
    const list = new RecordNames(
      many,
      () => now,
      () => {},
      others,
    );
    list.search("");
    await settle();
    expect(list.search("").map(({ label }) => label)).toEqual([
      "Apple 9",
      "Apple 10",
      "äther",
      "Zinc",
      "",
    ]);
    now = { ...withTerms, title_column: 2 };
    list.reorder();
    expect(list.search("").map(({ key, label }) => [key, label])).toEqual([
      [1, "Loss"],
      [2, "Loss"],
      [0, "Salts"],
      [3, "Cracks"],
      [4, ""],
    ]);
    expect(list.label(3)).toBe("Cracks");
  });

  it("are searched by their beginning first, then anywhere, and by key", async () => {
    count = 30;
    names.search("");
    await settle();
    names.put(record(50, { code: "Below SU 1" }));
    expect(names.search("su 1").map(({ key }) => key)).toEqual([
      1, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 50,
    ]);
    expect(names.search("50").map(({ key }) => key)).toEqual([50]);
    expect(names.search("nothing of it")).toEqual([]);
  });
});

describe("the records of a selection", () => {
  it("are the only ones in the table of their layer", async () => {
    const asked: string[] = [];
    const api = new Api(async (path) => {
      asked.push(decodeURIComponent(path.replaceAll("+", " ")));
      return new Response(JSON.stringify({ records: [], total: 0 }));
    });
    const tables = new Tables(api, {
      modelId: "1",
      project: () => null,
      highlight: () => {},
      flyTo: () => {},
      changed: () => {},
    });
    tables.showRows({ id: 8, table: 3, slug: "finds" } as Layer, [12, 5]);
    tables.view!.rows.row(0);
    await settle();
    expect([tables.view?.layerId, tables.view?.rows.filter]).toEqual([8, "key in (12, 5)"]);
    expect(asked.some((path) => path.includes("filter=key in (12, 5)"))).toBe(true);
    tables.close();
  });
});

describe("the card of a record", () => {
  const layer = { id: 8, table: 3, slug: "finds" } as Layer;
  const picked = (value: number): Picked =>
    ({
      op: "picked",
      id: "x",
      hit: true,
      values: { finds: { valid: true, value } },
    }) as unknown as Picked;
  let asked: string[];
  let areaM2: number;
  let tables: Tables;

  beforeEach(() => {
    asked = [];
    areaM2 = 1;
    const api = new Api(async (path) => {
      asked.push(path.replace("/api/v1/models/1/layers/8/records/", ""));
      const key = Number(path.split("/").at(-1));
      return key < 9
        ? new Response(JSON.stringify({ ...record(key), area_m2: areaM2 }))
        : new Response("{}", { status: 404 });
    });
    tables = new Tables(api, {
      modelId: "1",
      project: () => null,
      highlight: () => {},
      flyTo: () => {},
      changed: () => {},
    });
  });

  it("shows what was taken from the surface, and follows its record and its area", async () => {
    tables.showCard(layer, picked(2));
    await settle();
    expect(tables.card).toMatchObject({ key: 2, record: { key: 2, area_m2: 1 } });
    areaM2 = 5;
    tables.onLayerEdited(8);
    await settle();
    expect(tables.card?.record?.area_m2).toBe(5);
    tables.onLayerEdited(9);
    tables.onRecord({ op: "record", event: "changed", table: 3, key: 7 });
    await settle();
    expect(asked).toEqual(["2", "2"]);
    tables.onRecord({ op: "record", event: "deleted", table: 3, key: 2 });
    expect(tables.card).toBeNull();
  });

  it("is that of the last place, and goes where nothing is painted or the record is gone", async () => {
    tables.showCard(layer, picked(2));
    tables.showCard(layer, picked(3));
    await settle();
    expect(tables.card?.record?.key).toBe(3);
    tables.showCard(layer, picked(9)); // this key has no record
    await settle();
    expect(tables.card).toBeNull();
    tables.showCard(layer, picked(3));
    tables.showCard(layer, {
      op: "picked",
      id: "x",
      hit: true,
      values: { finds: { valid: false } },
    } as unknown as Picked);
    expect(tables.card).toBeNull();
    tables.showCard({ ...layer, table: undefined }, picked(3));
    expect(tables.card).toBeNull();
  });
});

describe("the dialog of a column", () => {
  const wanted = (more: Partial<ColumnWanted> = {}): ColumnWanted => ({
    name: "Depth",
    labels: {},
    kind: "numeric",
    unit: "m",
    required: false,
    unique: false,
    comment: "",
    choices: ["a"],
    target: 4,
    minimum: 0,
    maximum: null,
    ...more,
  });

  it("sends what suits the kind", () => {
    expect(ofKind(wanted())).toEqual({
      name: "Depth",
      labels: {},
      kind: "numeric",
      required: false,
      unique: false,
      comment: "",
      unit: "m",
      minimum: 0,
      maximum: null,
    });
    expect(ofKind(wanted({ kind: "enumeration" }))).toMatchObject({ choices: ["a"] });
    expect(ofKind(wanted({ kind: "relation" }))).toMatchObject({ target: 4 });
    expect(ofKind(wanted({ kind: "text" }))).toEqual({
      name: "Depth",
      labels: {},
      kind: "text",
      required: false,
      unique: false,
      comment: "",
    });
  });

  it("sends of a column that is there only what differs", () => {
    const depth = column(1, "depth", "numeric", { name: "Depth", unit: "m", minimum: 0 });
    expect(columnChanges(depth, wanted())).toEqual({});
    expect(columnChanges(depth, wanted({ name: "Depth below surface", minimum: null }))).toEqual({
      name: "Depth below surface",
      minimum: null,
    });
    expect(columnChanges(depth, wanted({ kind: "text" }))).toEqual({ kind: "text" });
    const labelled = { ...depth, labels: { es: "Profundidad", de: "Tiefe" } };
    expect(columnChanges(labelled, wanted({ labels: { de: "Tiefe", es: "Profundidad" } }))).toEqual(
      {},
    );
    expect(columnChanges(labelled, wanted({ labels: { de: "Tiefe" } }))).toEqual({
      labels: { de: "Tiefe" },
    });
  });
});
