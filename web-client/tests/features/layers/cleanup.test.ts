import type { ReactiveController } from "lit";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import type { CleanupReport } from "../../../src/core/protocol.gen";
import type { Job, Layer } from "../../../src/core/types";
import {
  cleanupOf,
  piecesOf,
  type CleanupInput,
} from "../../../src/features/layers/cleanup-request";
import { targetsOf } from "../../../src/features/layers/pieces-dialog";
import { RegionJob, reportText, type RegionJobHost } from "../../../src/features/layers/region-job";
import { Api } from "../../../src/net/api";
import { texts } from "../../../src/texts";

const words = texts.regions;
const input: CleanupInput = {
  operation: "sieve",
  area: "2.5",
  erasesRegions: false,
  radius: "4",
  width: "2",
  from: null,
  of: "",
  inside: false,
  line: 9,
};

describe("the request for a clean-up", () => {
  it("has only the members of its operation", () => {
    expect(cleanupOf(input, true)).toEqual({ operation: "sieve", area_cm2: 2.5, apply: true });
    expect(cleanupOf({ ...input, erasesRegions: true }, false)).toEqual({
      operation: "sieve",
      area_cm2: 2.5,
      erase_regions: true,
      apply: false,
    });
    expect(cleanupOf({ ...input, operation: "fill-holes", erasesRegions: true }, true)).toEqual({
      operation: "fill-holes",
      area_cm2: 2.5,
      apply: true,
    });
    expect(cleanupOf({ ...input, operation: "majority" }, true)).toEqual({
      operation: "majority",
      radius_mm: 4,
      apply: true,
    });
  });
  it("opens and closes regions of a value, or of the only one", () => {
    expect(cleanupOf({ ...input, operation: "open", from: 7, inside: true }, true)).toEqual({
      operation: "open",
      width_mm: 2,
      apply: true,
    });
    expect(cleanupOf({ ...input, operation: "close", of: "3" }, false)).toEqual({
      operation: "close",
      width_mm: 2,
      of: 3,
      apply: false,
    });
    expect(cleanupOf({ ...input, operation: "open", width: "" }, true)).toMatchObject({
      field: "width_mm",
    });
  });
  it("paints or erases the border of one class, or of all", () => {
    const border = { ...input, operation: "border" as const };
    expect(cleanupOf({ ...border, inside: true }, true)).toEqual({
      operation: "border",
      width_mm: 2,
      value: 9,
      apply: true,
    });
    expect(cleanupOf({ ...border, of: " 3 ", from: 7, inside: true, line: null }, true)).toEqual({
      operation: "border",
      width_mm: 2,
      from: 7,
      of: 3,
      inside: true,
      erase: true,
      apply: true,
    });
  });
  it("names the field that is wrong", () => {
    for (const area of ["", "0", "-1", "wide"])
      expect(cleanupOf({ ...input, area }, true)).toEqual({
        problem: words.bad_size,
        field: "area_cm2",
      });
    expect(cleanupOf({ ...input, operation: "majority", radius: "" }, true)).toMatchObject({
      field: "radius_mm",
    });
    expect(cleanupOf({ ...input, operation: "border", width: "0" }, true)).toMatchObject({
      field: "width_mm",
    });
    expect(cleanupOf({ ...input, operation: "border", of: "x" }, true)).toEqual({
      problem: words.bad_value,
      field: "of",
    });
  });
});

describe("the request for records of pieces", () => {
  const pieces = {
    into: 5,
    of: "",
    minArea: "",
    number: "",
    area: "",
    perimeter: "",
    inReadingOrder: false,
    asLines: false,
    length: "",
    width: "",
    greatestWidth: "",
  };
  it("leaves out what is empty", () => {
    expect(piecesOf(pieces, false)).toEqual({ into: 5, apply: false });
    expect(piecesOf({ ...pieces, of: "0", minArea: "0.5", number: "no", area: "a" }, true)).toEqual(
      {
        into: 5,
        of: 0,
        min_area_cm2: 0.5,
        number_column: "no",
        area_column: "a",
        apply: true,
      },
    );
    expect(piecesOf({ ...pieces, minArea: "-1" }, true)).toMatchObject({ field: "min_area_cm2" });
  });
  it("asks for reading order, which lines always have", () => {
    const inOrder = { ...pieces, inReadingOrder: true };
    expect(piecesOf(inOrder, true)).toEqual({ into: 5, in_reading_order: true, apply: true });
    expect(piecesOf({ ...inOrder, asLines: true }, true)).not.toHaveProperty("in_reading_order");
  });
  it("measures lines only if they are chosen", () => {
    const columns = { ...pieces, length: "l", greatestWidth: "g" };
    expect(piecesOf(columns, true)).toEqual({ into: 5, apply: true });
    expect(piecesOf({ ...columns, asLines: true }, true)).toEqual({
      into: 5,
      as_lines: true,
      length_column: "l",
      greatest_width_column: "g",
      apply: true,
    });
    expect(piecesOf({ ...pieces, asLines: true }, false)).toEqual({
      into: 5,
      as_lines: true,
      apply: false,
    });
  });
  it("goes to another layer of records with the same resolution", () => {
    const layer = (id: number, resolution: number, table?: number) =>
      ({ id, resolution, table }) as Layer;
    const all = [layer(1, 2048), layer(2, 2048, 7), layer(3, 4096, 8), layer(4, 2048, 9)];
    expect(targetsOf(all, all[1]!).map(({ id }) => id)).toEqual([4]);
    expect(targetsOf(all, all[0]!).map(({ id }) => id)).toEqual([2, 4]);
  });
});

describe("the text of a preview", () => {
  const report: CleanupReport = {
    operation: "sieve",
    applied: false,
    regions: 3,
    texels: 120,
    area_m2: 0.0012,
  };
  it("is the number of regions and the area, or that nothing changes", () => {
    expect(reportText(report, words.regions)).toBe("3 regions would change, 12 cm² in total.");
    expect(reportText({ ...report, regions: 0 }, words.regions)).toBe("12 cm² would change.");
    expect(reportText({ ...report, texels: 0 }, words.regions)).toBe(words.nothing);
  });
});

describe("the job of a dialog", () => {
  let answers: unknown[];
  let statuses: number[];
  let asked: string[];
  let work: RegionJob;
  let api: Api;
  const job = (state: Job["state"], more: Partial<Job> = {}): Job => ({
    id: 5,
    state,
    progress: 0.5,
    message: "Comparing areas",
    ...more,
  });
  const report: CleanupReport = {
    operation: "sieve",
    applied: true,
    regions: 1,
    texels: 2,
    area_m2: 1,
  };
  const start = (): Promise<Job> =>
    api.json("POST /models/{model}/layers/{layer}/cleanup", {
      path: { model: "3", layer: 9 },
      body: { operation: "sieve", area_cm2: 1 },
    });

  beforeEach(() => {
    vi.useFakeTimers();
    [answers, statuses, asked] = [[], [], []];
    api = new Api((path, init) => {
      asked.push(`${init?.method ?? "GET"} ${path.replace("/api/v1", "")}`);
      const body = answers.length > 1 ? answers.shift() : answers[0];
      const status = statuses.shift() ?? 200;
      return Promise.resolve(new Response(JSON.stringify(body), { status }));
    });
    work = new RegionJob({
      session: { api },
      shadowRoot: null,
      addController: () => {},
      requestUpdate: () => {},
    } as unknown as RegionJobHost);
  });
  afterEach(() => vi.useRealTimers());

  it("is busy until it is done, and starts only once", async () => {
    answers = [job("queued"), job("running"), job("done", { cleanup: report })];
    const done = work.run(start, true);
    expect(work.isBusy).toBe(true);
    expect(await work.run(start, true)).toBeNull();
    await vi.advanceTimersByTimeAsync(400);
    expect(work.job?.state).toBe("running");
    await vi.advanceTimersByTimeAsync(400);
    expect(await done).toEqual(report);
    expect([work.isBusy, work.report, work.problem]).toEqual([false, report, ""]);
    expect(asked.filter((each) => each.startsWith("POST"))).toHaveLength(1);
  });
  it("tells why it failed, and which field is wrong", async () => {
    const problem = {
      title: "Radius too large",
      status: 422,
      detail: "At most 9 mm.",
      field: "radius_mm",
    };
    answers = [job("failed", { problem })];
    expect(await work.run(start, true)).toBeNull();
    expect([work.problem, work.field]).toEqual(["At most 9 mm.", "radius_mm"]);
    work.reset();
    expect([work.problem, work.field]).toEqual(["", ""]);
  });
  it("tells why the server refused it", async () => {
    answers = [{ title: "Layer is locked", status: 403, detail: "Ask a curator.", field: "layer" }];
    statuses = [403];
    expect(await work.run(start, true)).toBeNull();
    expect([work.isBusy, work.problem]).toEqual([false, "Ask a curator."]);
  });
  it("does not show the result of a preview if the input has changed since", async () => {
    const problem = { title: "Radius", status: 422, detail: "Too large.", field: "radius_mm" };
    for (const end of [job("done", { cleanup: report }), job("failed", { problem })]) {
      answers = [job("running"), end];
      const done = work.run(start, false);
      await vi.advanceTimersByTimeAsync(1);
      work.reset();
      await vi.advanceTimersByTimeAsync(800);
      await done;
      expect([work.isBusy, work.report, work.problem, work.field]).toEqual([false, null, "", ""]);
    }
  });
  it("tells the result of a change also if the input has changed since", async () => {
    answers = [
      job("running"),
      job("failed", { problem: { title: "Locked", status: 403, detail: "Ask." } }),
    ];
    const done = work.run(start, true);
    await vi.advanceTimersByTimeAsync(1);
    work.reset();
    await vi.advanceTimersByTimeAsync(800);
    expect(await done).toBeNull();
    expect(work.problem).toBe("Ask.");
  });
  it("keeps the focus in its dialog when the focused button disappears", () => {
    const focused: string[] = [];
    const root = {
      activeElement: {
        matches: (selector: string) => selector.includes(".stop"),
      } as Element | null,
      querySelectorAll: (selector: string) => [
        { matches: () => true, focus: () => focused.push(selector) },
      ],
    };
    const controllers: ReactiveController[] = [];
    const host = {
      session: { api },
      shadowRoot: root,
      addController: (added: ReactiveController) => controllers.push(added),
    };
    new RegionJob(host as unknown as RegionJobHost);
    const update = (then: () => void): void => {
      for (const each of controllers) each.hostUpdate?.();
      then();
      for (const each of controllers) each.hostUpdated?.();
    };
    update(() => (root.activeElement = null));
    expect(focused).toHaveLength(1);
    update(() => {}); // nothing in the dialog has the focus
    expect(focused).toHaveLength(1);
  });
  it("is canceled when its dialog is closed", async () => {
    answers = [job("running"), job("running"), job("cancelled")];
    const done = work.run(start, true);
    await vi.advanceTimersByTimeAsync(1);
    work.hostDisconnected();
    await vi.advanceTimersByTimeAsync(800);
    expect(await done).toBeNull();
    expect(asked.filter((each) => each === "DELETE /jobs/5")).toHaveLength(1);
  });
  it("can be canceled before the server has confirmed its start", async () => {
    answers = [job("queued"), job("cancelled")];
    const done = work.run(start, true);
    await work.cancel();
    expect(asked).toEqual(["POST /models/3/layers/9/cleanup"]);
    await vi.advanceTimersByTimeAsync(800);
    expect(await done).toBeNull();
    expect(asked.filter((each) => each === "DELETE /jobs/5")).toHaveLength(1);
  });
  it("can be canceled", async () => {
    answers = [job("running"), job("running"), job("cancelled")];
    const done = work.run(start, true);
    await vi.advanceTimersByTimeAsync(1);
    await work.cancel();
    expect(asked).toContain("DELETE /jobs/5");
    await vi.advanceTimersByTimeAsync(800);
    expect(await done).toBeNull();
    expect([work.isBusy, work.problem]).toEqual([false, ""]);
  });
});
