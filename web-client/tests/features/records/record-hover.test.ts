import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { RecordHover, type RecordAt } from "../../../src/features/records/record-hover";
import { RecordCache } from "../../../src/features/tables/record-cache";
import { Api } from "../../../src/net/api";
import { firstPicture, tellingColumns } from "../../../src/domain/cells";
import type { Column, ColumnKind } from "../../../src/core/protocol.gen";
import type { Layer } from "../../../src/core/types";

const kLongMs = 10_000;
const record = (key: number): RecordAt => ({ layer: { id: 5 } as Layer, key });

describe("the record that the mouse rests on", () => {
  let here: RecordAt | null;
  let settled: boolean;
  let hover: RecordHover;
  let changes: number;
  const rest = (): unknown => vi.advanceTimersByTime(kLongMs);
  /** Simulates the response to the pointer's request. */
  const lies = (found: RecordAt | null): void => {
    here = found;
    hover.picked();
  };

  beforeEach(() => {
    vi.useFakeTimers();
    [here, settled, changes] = [record(7), true, 0];
    hover = new RecordHover({
      here: () => here,
      settled: () => settled,
      changed: () => (changes += 1),
    });
  });
  afterEach(() => {
    vi.useRealTimers();
  });

  it("is shown once the mouse has rested, which a trembling hand does, too", () => {
    hover.move({ x: 10, y: 10 });
    vi.advanceTimersByTime(200);
    hover.move({ x: 30, y: 10 });
    vi.advanceTimersByTime(200);
    expect(hover.shown).toBeNull();
    hover.move({ x: 31, y: 10 });
    vi.advanceTimersByTime(200);
    expect([hover.shown, changes]).toEqual([record(7), 1]);
  });

  it("is shown when the answer comes late, and only the answer about that place", () => {
    [here, settled] = [record(3), false]; // the response is for the pointer's previous position
    hover.move({ x: 10, y: 10 });
    rest();
    expect(hover.shown).toBeNull();
    lies(record(4)); // the response is for a position in between
    expect(hover.shown).toBeNull();
    settled = true;
    lies(record(7));
    expect(hover.shown).toEqual(record(7));
  });

  it("stays while the mouse moves on it, and gives way to another only after another rest", () => {
    hover.move({ x: 10, y: 10 });
    rest();
    hover.move({ x: 60, y: 10 });
    lies(record(7));
    expect(hover.shown).toEqual(record(7));
    hover.move({ x: 90, y: 10 });
    lies(record(8));
    expect(hover.shown).toBeNull();
    rest();
    expect(hover.shown).toEqual(record(8));
    hover.move({ x: 120, y: 10 });
    lies(null);
    rest();
    expect(hover.shown).toBeNull();
  });

  it("is gone while the view moves, and another after a rest", () => {
    hover.move({ x: 10, y: 10 });
    rest();
    hover.waitAgain();
    expect([hover.shown, changes]).toEqual([null, 2]);
    lies(record(8));
    expect(hover.shown).toBeNull();
    rest();
    expect(hover.shown).toEqual(record(8));
    hover.move(null);
    hover.waitAgain();
    rest();
    expect(hover.shown).toBeNull();
  });

  it("is gone with a press or the mouse itself, until the mouse moves again", () => {
    hover.move({ x: 10, y: 10 });
    rest();
    hover.end();
    expect([hover.shown, changes]).toEqual([null, 2]);
    rest();
    lies(record(7));
    expect(hover.shown).toBeNull();
    hover.move({ x: 11, y: 10 });
    rest();
    expect(hover.shown).toEqual(record(7));
    hover.move(null);
    expect(hover.shown).toBeNull();
    hover.move({ x: 11, y: 10 });
    hover.end();
    rest();
    expect(hover.shown).toBeNull();
  });

  it("is none where none would be tapped, as after another tool was taken", () => {
    hover.move({ x: 10, y: 10 });
    rest();
    here = null;
    expect(hover.shown).toBeNull();
  });
});

describe("records that were looked at", () => {
  let asked: string[];
  let answers: ((status?: number) => void)[];
  let cache: RecordCache;
  const settle = (): Promise<void> => new Promise((resolve) => setTimeout(resolve));

  beforeEach(() => {
    [asked, answers] = [[], []];
    const api = new Api((path) => {
      asked.push(path.replace("/api/v1", ""));
      const key = Number(path.split("/").at(-1));
      const version = asked.length;
      return new Promise((resolve) =>
        answers.push((status = 200) =>
          resolve(
            new Response(
              JSON.stringify(
                status === 200 ? { key, version, values: {} } : { status, title: "No" },
              ),
              { status },
            ),
          ),
        ),
      );
    });
    cache = new RecordCache(api, () => {});
  });

  it("are asked for once, also those that are not there", async () => {
    for (let times = 0; times < 3; ++times) {
      cache.find(3, 7);
      cache.find(3, 8);
      if (times === 0) answers[0]!();
      if (times === 0) answers[1]!(404);
      await settle();
    }
    expect(asked).toEqual(["/tables/3/records/7", "/tables/3/records/8"]);
    expect([cache.find(3, 7)?.key, cache.find(3, 8)]).toEqual([7, null]);
  });

  it("are asked for anew once they have changed, and an answer from before does not count", async () => {
    cache.find(3, 7);
    cache.forget(3, 7);
    cache.find(3, 7);
    answers[1]!();
    answers[0]!();
    await settle();
    expect(cache.find(3, 7)?.version).toBe(2);
    cache.forgetTable(33);
    expect([cache.find(3, 7)?.version, asked.length]).toEqual([2, 2]);
    cache.forgetTable(3);
    expect([cache.find(3, 7), asked.length]).toEqual([null, 3]);
  });

  it("make room for new ones", () => {
    for (let key = 1; key <= 1000; ++key) cache.find(3, key);
    cache.find(3, 1000);
    expect(asked.length).toBe(1000);
    cache.find(3, 1);
    expect(asked.length).toBe(1001);
  });
});

describe("what a card shows about a record", () => {
  const column = (id: number, slug: string, kind: ColumnKind = "text"): Column => ({
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
  });
  const table = {
    kind: "records" as const,
    columns: [
      column(1, "name"),
      column(2, "photo", "picture"),
      column(3, "views", "picture"),
      column(4, "depth", "numeric"),
      column(5, "above", "relation"),
      column(6, "note"),
    ],
  };

  it("is its first picture, and the columns that say something beside its name", () => {
    const values = { name: "Pit", photo: [], views: [12, 13], depth: 0, above: [], note: "" };
    expect(firstPicture(table, { values })).toBe(12);
    expect(tellingColumns(table, { values }).map(({ slug }) => slug)).toEqual(["depth"]);
    expect(firstPicture(table, { values: {} })).toBeNull();
  });
});
