import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { MarkDrawing, type MarkDrawingHost } from "../../../src/features/records/mark-drawing";
import { notices, type Notice } from "../../../src/ui/notices";
import { texts } from "../../../src/texts";
import { Api } from "../../../src/net/api";
import type { MarkSight } from "../../../src/session/mark-sight";
import type { Mark, MarkPlace } from "../../../src/core/protocol.gen";

const column = (id: number, slug: string, kind: string): object => ({
  id,
  name: slug,
  slug,
  labels: {},
  kind,
});
const table = {
  id: 3,
  columns: [
    column(1, "name", "text"),
    column(2, "cracks", "line"),
    column(4, "joints", "line"),
    column(5, "samples", "point"),
  ],
};
/** Without perspective, a pixel is 1 unit long. */
const flatView = {
  view: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
  projection: [0.02, 0, 0, 0, 0, 0.02, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1],
  width: 100,
  height: 100,
};
const comes = (check: () => void): Promise<void> => vi.waitFor(check, { timeout: 20_000 });
const isTold = (title: string): Promise<void> =>
  comes(() => expect(shown.at(-1)?.title).toBe(title));

let stored: { key: number; version: number; values: Record<string, unknown> };
let told: string[]; // requests that the server received
let beforeChange: () => void;
let newest: number; // the newest entry of the table's journal
let undone: number[];
let host: MarkDrawingHost;
let marks: MarkDrawing;
let shown: readonly Notice[];
let unsubscribe: () => void;

const answer = (body: unknown, status = 200): Response =>
  new Response(JSON.stringify(body), { status });

beforeEach(() => {
  stored = { key: 7, version: 1, values: {} };
  [told, undone, newest] = [[], [], 2];
  beforeChange = () => {};
  const api = new Api((path, init) => {
    const what = `${init!.method} ${String(path).replace("/api/v1", "")}`;
    told.push(what);
    const body = init!.body
      ? (JSON.parse(String(init!.body)) as { version: number; values: object })
      : null;
    if (what.endsWith("/profile")) {
      const samples = [
        [0, 0, 0],
        [3, 0, 0],
        null,
        ...Array.from({ length: 41 }, (_, step) => [90, step / 10, 0]),
      ].map((position) => ({
        along_mm: 0,
        point: position ? { hit: true, position } : { hit: false },
      }));
      return Promise.resolve(answer({ length_mm: 0, samples }));
    }
    if (what.endsWith("/pick")) return Promise.resolve(answer({ hit: true, position: [1, 2, 3] }));
    if (what.startsWith("PATCH")) {
      beforeChange();
      beforeChange = () => {};
      if (body!.version !== stored.version)
        return Promise.resolve(answer({ status: 412, title: "Changed" }, 412));
      stored = {
        ...stored,
        version: stored.version + 1,
        values: { ...stored.values, ...body!.values },
      };
    }
    return Promise.resolve(
      answer(what.includes("/edits") ? { edits: [{ sequence: newest }], total: 1 } : stored),
    );
  });
  const layer = { id: 1, table: 3, name: "Damages" };
  host = {
    view: { camera: { message: () => flatView } },
    layers: { selected: layer },
    painting: { stroking: false, chosenLayer: () => layer, brush: { valueFor: () => 7 } },
    tables: {
      find: () => table,
      lacks: (_: number, key: number) => key !== 7,
      label: () => "North",
      view: null,
      undo: async (id: number) => void undone.push(id),
    },
    model: () => ({ id: 9, unit: "cm" }),
    changed: () => {},
  } as unknown as MarkDrawingHost;
  marks = new MarkDrawing(api, host);
  unsubscribe = notices.subscribe((now) => (shown = now));
});
afterEach(() => {
  for (const { id } of shown) notices.dismiss(id);
  unsubscribe();
});

describe("what is drawn on the surface", () => {
  it("is added to the record in the column that was chosen, as lines where the surface was seen", async () => {
    marks.chooseColumn(3, marks.columns("line")[1]!);
    expect(marks.beginLine()).toBe(true);
    void marks.finishLine([
      [0, 0],
      [31, 31],
    ]);
    await isTold(texts.marks.line_cut(2));
    expect(shown.at(-1)!.detail).toBe(texts.marks.line_drawn("7 cm", "North"));
    expect(stored.values).toEqual({
      joints: [
        {
          model: 9,
          coordinates: [
            [0, 0, 0],
            [3, 0, 0],
          ],
        },
        {
          model: 9,
          coordinates: [
            [90, 0, 0],
            [90, 4, 0],
          ],
        },
      ],
    });
  });

  it("can be drawn on a picture that shows the surface", async () => {
    const at = async (place: MarkPlace): Promise<MarkPlace> => place;
    const sight: MarkSight = {
      measures: { pixelAt: () => 1, scale: 1 },
      along: async (path) =>
        path.map(([x, y]) => ({ at: [x, y], place: [x, y, 5], normal: [0, 0, 1] })),
      at: ([x, y]) => at([x, y, 5]),
    };
    await marks.setPoint([1, 2], sight);
    await marks.finishLine(
      [
        [0, 0],
        [1, 0],
      ],
      sight,
    );
    expect(stored.values).toEqual({
      samples: [{ model: 9, coordinates: [[1, 2, 5]] }],
      cracks: [
        {
          model: 9,
          coordinates: [
            [0, 0, 5],
            [1, 0, 5],
          ],
        },
      ],
    });
    expect(told.filter((what) => /profile|pick/.test(what))).toEqual([]);
  });

  it("stays with what others add to the record meanwhile, and with what was drawn just before", async () => {
    const other: Mark = { model: 2, coordinates: [[5, 5, 5]] };
    beforeChange = () => (stored = { ...stored, version: 40, values: { samples: [other] } });
    void marks.setPoint([1, 1]);
    void marks.setPoint([2, 2]);
    const mine = { model: 9, coordinates: [[1, 2, 3]] };
    await comes(() => expect(stored.values["samples"]).toEqual([other, mine, mine]));
    await isTold(texts.marks.point_set("North"));
    expect(shown).toHaveLength(1); // the notice offers to undo the latest drawing
  });

  it("is taken back by its notice, unless something came after it", async () => {
    const act = (): void => (shown[0]!.link as { act: () => void }).act();
    void marks.setPoint([1, 1]);
    await isTold(texts.marks.point_set("North"));
    act();
    await comes(() => expect(undone).toEqual([3]));
    newest = 3;
    act();
    await isTold(texts.marks.changed_since);
    expect(undone).toEqual([3]);
  });

  it("is refused where there is no record, or no column for it", () => {
    host.painting.brush.valueFor = () => 8;
    expect(marks.beginLine()).toBe(false);
    host.painting.brush.valueFor = () => 7;
    host.tables.find = () => null;
    void marks.setPoint([1, 1]);
    expect([told, host.painting.stroking]).toEqual([[], false]);
    expect(shown.map(({ title }) => title)).toEqual([
      texts.brush.no_record(8),
      texts.marks.no_column.point,
    ]);
  });
});
