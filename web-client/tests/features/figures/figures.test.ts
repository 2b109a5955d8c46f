import fc from "fast-check";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { FacePick } from "../../../src/features/figures/face-pick";
import { Figures } from "../../../src/features/figures/figures";
import { FileJobs } from "../../../src/session/file-jobs";
import { isBusy, LayerJobs } from "../../../src/session/layer-jobs";
import { notices, type Notice } from "../../../src/ui/notices";
import { texts } from "../../../src/texts";
import { Api } from "../../../src/net/api";
import { ApiError } from "../../../src/net/api-error";
import { OrbitCamera } from "../../../src/math/camera";
import {
  figureChoices,
  figureRequest,
  kAreas,
  kDirections,
  kFormats,
  kPapers,
  kScaleRange,
  kScales,
  kTolerances,
  previewRequest,
  readScale,
  scaleText,
  usualFigure,
  type FigureChoices,
  type FigureWords,
} from "../../../src/domain/figures";
import { kViewsChoices, toggledView, viewsOf } from "../../../src/domain/figure-views";
import { emptyBlock } from "../../../src/domain/figure-block";
import { withBlockWords } from "../../../src/features/figures/figure-block-fields";
import { setLocale } from "../../../src/core/locale";
import type { ViewContent } from "../../../src/domain/views";
import { FaceTool } from "../../../src/features/figures/face-tool";
import { OrbitTool } from "../../../src/tools/navigate";
import { ToolManager } from "../../../src/tools/tool-manager";

const unwritten: FigureWords = { title: "", caption: " \n", credit: "" };
const shown = {
  camera: { view: [], projection: [], width: 4, height: 3 },
  layers: [{ layer: 7, visible: false }],
  looks: [],
  light: { mode: "raking" },
} as unknown as ViewContent;
const face = {
  center: [1, 2, 3] as [number, number, number],
  normal: [0, -1, 0] as [number, number, number],
};

describe("a scale that is typed", () => {
  const scales: [string, number][] = [
    ["1:40", 40],
    ["1 : 2.5", 2.5],
    ["2:1", 0.5],
    ["2 : 5", 2.5],
    ["40", 40],
    ["0.5", 0.5],
    ["100:1", 0.01],
  ];
  it.each(scales)("%s is read", (typed, scale) => expect(readScale(typed)).toBe(scale));

  it.each([
    "",
    "1:",
    ":40",
    "1:0",
    "0:1",
    "-1:40",
    "1:-40",
    "1:4:0",
    "1/40",
    "forty",
    "1:1e9",
    "1000:1",
    "Infinity",
    "NaN",
  ])("%s is none", (typed) => expect(readScale(typed)).toBeNaN());

  it("is read as it is written, in the language of the page", () => {
    try {
      for (const language of ["en", "de", "es"] as const) {
        setLocale(language, true, []);
        fc.assert(
          fc.property(
            fc.double({
              min: Math.log(kScaleRange.least),
              max: Math.log(kScaleRange.most),
              noNaN: true,
            }),
            (power) => {
              const scale = Math.min(
                kScaleRange.most,
                Math.max(kScaleRange.least, Math.exp(power)),
              );
              expect(readScale(scaleText(scale)) / scale).toBeCloseTo(1, 4);
            },
          ),
        );
        for (const scale of kScales) expect(readScale(scaleText(scale))).toBe(scale);
      }
      expect(scaleText(2.5)).toBe("1 : 2,5");
    } finally {
      setLocale("en", true, []);
    }
    expect([scaleText(0.5), scaleText(2.5), scaleText(500)]).toEqual([
      "2 : 1",
      "1 : 2.5",
      "1 : 500",
    ]);
  });
});

describe("choices that a browser kept", () => {
  const aChoice: fc.Arbitrary<FigureChoices> = fc.record({
    views: fc.constantFrom(...kViewsChoices),
    from: fc.constantFrom("camera" as const, "face" as const, ...kDirections),
    scale: fc.option(fc.constantFrom(...kScales, 0.01, 1_000_000, 37.5)),
    paper: fc.constantFrom(...kPapers),
    orientation: fc.constantFrom(null, "portrait" as const, "landscape" as const),
    dpi: fc.integer({ min: 50, max: 600 }),
    format: fc.constantFrom(...kFormats),
    areas: fc.constantFrom(...kAreas),
    tolerance_mm: fc.constantFrom(...kTolerances),
    legend: fc.boolean(),
    dimensions: fc.boolean(),
    title_block: fc.boolean(),
    block_texts: fc.record({
      organization: fc.string({ maxLength: 200 }),
      author: fc.string({ maxLength: 200 }),
    }),
  });

  it("come back", () => {
    fc.assert(
      fc.property(
        aChoice,
        (choices) =>
          void expect(figureChoices(JSON.parse(JSON.stringify(choices)))).toEqual(choices),
      ),
    );
  });

  it("are the usual ones where they are none, one by one", () => {
    for (const nonsense of [null, undefined, 3, "x", [], {}])
      expect(figureChoices(nonsense)).toEqual(usualFigure());
    const kept = {
      views: "two",
      from: "north",
      scale: "5",
      paper: "a0",
      orientation: "square",
      dpi: 72.5,
      format: "bmp",
      areas: "lines",
      tolerance_mm: 0.07,
      legend: 1,
      dimensions: 3,
      title_block: "yes",
      block_texts: { organization: 5, author: "x".repeat(201) },
      more: true,
    };
    expect(figureChoices(kept)).toEqual(usualFigure());
    expect(figureChoices({ ...kept, paper: "a3", dpi: 72 })).toEqual({
      ...usualFigure(),
      paper: "a3",
      dpi: 72,
    });
    for (const scale of [0, -1, 0.001, 2e6, Number.NaN])
      expect(figureChoices({ scale }).scale).toBeNull();
    for (const dpi of [49, 601, 0]) expect(figureChoices({ dpi }).dpi).toBe(300);
  });

  it("are the usual ones whatever stands there", () => {
    fc.assert(
      fc.property(
        fc.anything(),
        (kept) => void expect(Object.keys(figureChoices(kept))).toEqual(Object.keys(usualFigure())),
      ),
    );
  });
});

describe("what is asked for", () => {
  it("is all that the person sees, and only what was chosen or written besides", () => {
    expect(figureRequest(shown, usualFigure(), unwritten)).toEqual({
      ...shown,
      paper: "a4",
      dpi: 300,
      format: "pdf",
      legend: true,
    });
    const choices: FigureChoices = {
      views: "one",
      from: "front",
      scale: 5,
      paper: "a3",
      orientation: "landscape",
      dpi: 600,
      format: "tiff",
      areas: "outlines",
      tolerance_mm: 0.2,
      legend: false,
      dimensions: false,
      title_block: false,
      block_texts: { organization: "Museum", author: "" },
    };
    const words = { title: "West wall ", caption: "After\ncleaning", credit: "Museum" };
    expect(
      figureRequest(shown, choices, words, { face, labels: { layer: 7, column: "name" } }),
    ).toEqual({
      ...shown,
      direction: "front",
      scale: 5,
      paper: "a3",
      orientation: "landscape",
      dpi: 600,
      format: "tiff",
      legend: false,
      title: "West wall",
      caption: "After\ncleaning",
      credit: "Museum",
      labels: { layer: 7, column: "name" },
    });
  });

  it("is a named view's where one is meant", () => {
    expect(figureRequest({ view: "12" }, { ...usualFigure(), from: "top" }, unwritten)).toEqual({
      view: "12",
      direction: "top",
      paper: "a4",
      dpi: 300,
      format: "pdf",
      legend: true,
    });
  });

  it("is square to a face that was picked, and nothing before", () => {
    const choices: FigureChoices = { ...usualFigure(), from: "face" };
    expect(figureRequest(shown, choices, unwritten)).toBeNull();
    const request = figureRequest(shown, choices, unwritten, { face })!;
    expect([request.normal, request.center, request.direction]).toEqual([
      face.normal,
      face.center,
      undefined,
    ]);
  });

  it("of a rollout has only the layers and surface images, and neither labels nor a direction", () => {
    const choices: FigureChoices = { ...usualFigure(), from: "rollout", scale: 2 };
    const rollout = { side: "inside" as const, relief: true };
    const labels = { layer: 7, column: "name" };
    expect(figureRequest(shown, choices, unwritten, { face, labels })).toBeNull();
    expect(figureRequest(shown, choices, unwritten, { face, labels, rollout })).toEqual({
      layers: shown.layers,
      looks: shown.looks,
      rollout,
      scale: 2,
      paper: "a4",
      dpi: 300,
      format: "pdf",
      legend: true,
    });
    const ofView = figureRequest({ view: "12" }, choices, unwritten, { face, labels, rollout })!;
    expect([ofView.view, ofView.rollout, ofView.labels]).toEqual(["12", rollout, undefined]);
    expect(figureRequest(shown, usualFigure(), unwritten, { rollout })).not.toHaveProperty(
      "rollout",
    );
  });

  it("has outlines in PDF, SVG and DXF files only, and never in a rollout or a preview", () => {
    const outlined = { ...usualFigure(), areas: "outlines" as const, tolerance_mm: 0.2 };
    const rollout = { side: "inside" as const, relief: true };
    const asked = (choices: FigureChoices): unknown[] => {
      const request = figureRequest(shown, choices, unwritten, { face, rollout })!;
      const preview = previewRequest(request);
      expect([preview.format, preview.areas, preview.tolerance_mm]).toEqual([
        "png",
        undefined,
        undefined,
      ]);
      return [request.areas, request.tolerance_mm];
    };
    for (const format of ["pdf", "svg"] as const)
      expect(asked({ ...outlined, format })).toEqual(["outlines", 0.2]);
    expect(asked({ ...outlined, format: "dxf" })).toEqual([undefined, 0.2]);
    for (const format of ["png", "tiff"] as const)
      expect(asked({ ...outlined, format })).toEqual([undefined, undefined]);
    expect(asked({ ...outlined, from: "rollout" })).toEqual([undefined, undefined]);
    expect(asked(usualFigure())).toEqual([undefined, undefined]);
  });

  it("has no texts and no legend in DXF files, because they would have no effect", () => {
    const words = { title: "West wall", caption: "", credit: "Museum" };
    const chosen = { ...usualFigure(), legend: true };
    const asked = (format: "dxf" | "pdf") => figureRequest(shown, { ...chosen, format }, words)!;
    const { title, credit, legend } = asked("pdf");
    expect([title, credit, legend]).toEqual(["West wall", "Museum", true]);
    for (const name of ["title", "caption", "credit", "legend"])
      expect(asked("dxf")).not.toHaveProperty(name);
    // the server's defaults would make the drawing smaller
    expect(previewRequest(asked("dxf"))).toMatchObject({ legend: false, title: "", credit: "" });
  });

  it("has the views of a set or the chosen saved views instead of a direction", () => {
    const labels = { layer: 7, column: "name" };
    const rollout = { relief: true };
    const asked = (chosen: Partial<FigureChoices>, saved: readonly number[] = []) => {
      const choices: FigureChoices = { ...usualFigure(), from: "rollout", ...chosen };
      const views = viewsOf(choices.views, saved, (each) => `<${each}>`);
      return figureRequest(shown, choices, unwritten, { labels, rollout, views });
    };
    const sides = asked({ views: "sides" })!;
    expect(sides).toMatchObject({ ...shown, labels });
    expect(sides.views).toEqual([
      { direction: "front", title: "<front>" },
      { direction: "back", title: "<back>" },
      { direction: "left", title: "<left>" },
      { direction: "right", title: "<right>" },
    ]);
    for (const name of ["direction", "normal", "rollout"]) expect(sides).not.toHaveProperty(name);
    expect(previewRequest(sides).views).toEqual(sides.views);
    expect(asked({ views: "saved" }, [4])).toBeNull();
    expect(asked({ views: "saved" }, [4, 2])!.views).toEqual([{ view: "4" }, { view: "2" }]);
    expect(asked({ views: "sides", format: "dxf", from: "front" })).not.toHaveProperty("views");
    expect(asked({ views: "sides", areas: "outlines" })).toMatchObject({ areas: "outlines" });
    expect(asked({ views: "one" })).not.toHaveProperty("views");
  });

  it("has the measured distances as dimensions of a single drawing", () => {
    const measured: [number, number, number][] = [
      [0, 0, 0],
      [1, 0, 0],
      [1, 0, 0],
      [1, 2, 0],
    ];
    const asked = (chosen: Partial<FigureChoices>) =>
      figureRequest(shown, { ...usualFigure(), ...chosen }, unwritten, {
        measured,
        rollout: { relief: true },
        views: [{}, {}],
      })!;
    const dimensions = [
      { from: [0, 0, 0], to: [1, 0, 0] },
      { from: [1, 0, 0], to: [1, 2, 0] },
    ];
    expect(asked({}).dimensions).toEqual(dimensions);
    expect(asked({ format: "dxf" }).dimensions).toEqual(dimensions);
    expect(previewRequest(asked({})).dimensions).toEqual(dimensions);
    for (const without of [{ dimensions: false }, { from: "rollout" }, { views: "sides" }] as const)
      expect(asked(without)).not.toHaveProperty("dimensions");
    const unmeasured = figureRequest(shown, usualFigure(), unwritten, { measured: [[1, 2, 3]] });
    expect(unmeasured).not.toHaveProperty("dimensions");
  });

  it("has saved views in the order in which they were chosen, at most six", () => {
    let saved: readonly number[] = [];
    for (const id of [3, 1, 2, 5, 4, 7, 6]) saved = toggledView(saved, id);
    expect(saved).toEqual([3, 1, 2, 5, 4, 7]);
    expect(toggledView(saved, 1)).toEqual([3, 2, 5, 4, 7]);
  });

  it("has the filled fields of a title block, and the direction as its usual title", () => {
    const block = { ...emptyBlock(), author: " Ada Lovelace ", sheet: "2/5", status: "  " };
    const asked = (chosen: Partial<FigureChoices>, written = unwritten) =>
      withBlockWords(
        figureRequest(shown, { ...usualFigure(), from: "front", ...chosen }, written, { block })!,
      );
    const { labels, ...filled } = asked({}).title_block!;
    expect(filled).toEqual({ author: "Ada Lovelace", sheet: "2/5" });
    expect(labels).toEqual(texts.figures.block.fields);
    expect(asked({}).title).toBe(texts.figures.froms.front);
    expect(asked({}, { ...unwritten, title: "West wall" }).title).toBe("West wall");
    expect(asked({ from: "camera" })).not.toHaveProperty("title");
    expect(asked({ format: "dxf" })).not.toHaveProperty("title_block");
    expect(previewRequest(asked({})).title_block).toEqual(asked({}).title_block);
    const bare = figureRequest(shown, usualFigure(), unwritten)!;
    expect(withBlockWords(bare)).toEqual(bare);
  });

  it("is the same sheet as a small picture for the preview", () => {
    const request = figureRequest(
      shown,
      { ...usualFigure(), paper: "a3", dpi: 600, scale: 5 },
      unwritten,
    )!;
    const preview = previewRequest(request);
    expect(preview).toEqual({ ...request, dpi: preview.dpi, format: "png" });
    for (const paper of kPapers) {
      const { dpi = 0 } = previewRequest({ paper });
      expect(Number.isInteger(dpi) && dpi >= 50 && dpi <= 100).toBe(true);
    }
  });
});

// ── with a server ────────────────────────────────────────────────────────────────────────────────

let answers: Map<string, () => Response | Promise<Response>>; // keyed by method and path
let calls: { method: string; path: string; body: unknown; headers: Record<string, string> }[];
let api: Api;
let told: readonly Notice[];
let unsubscribe: () => void;
let saved: string[];

const json = (body: unknown, status = 200): Response =>
  new Response(JSON.stringify(body), { status });
const job = (state: string, more: object = {}): object => ({
  id: 5,
  kind: "figure",
  state,
  progress: 0.5,
  message: "Tile 3 of 6",
  ...more,
});
const file = { name: "pot-front.pdf", media_type: "application/pdf", bytes: 1234 };
const kFigures = "POST /api/v1/models/9/figures?lang=en-GB";

beforeEach(() => {
  vi.useFakeTimers();
  [calls, saved] = [[], []];
  answers = new Map();
  api = new Api(async (path, init) => {
    calls.push({
      method: init!.method!,
      path,
      body: init!.body ? JSON.parse(init!.body as string) : undefined,
      headers: init!.headers as Record<string, string>,
    });
    const answer =
      answers.get(`${init!.method} ${path}`)?.() ??
      json({ title: `no answer for ${init!.method} ${path}` }, 500);
    const stopped = new Promise<never>((_, reject) =>
      init!.signal?.addEventListener("abort", () =>
        reject(new DOMException("stopped", "AbortError")),
      ),
    );
    return Promise.race([answer, stopped]);
  });
  unsubscribe = notices.subscribe((shownNow) => (told = shownNow));
  vi.stubGlobal("document", {
    createElement: () => ({
      click(this: { download: string }) {
        saved.push(this.download);
      },
    }),
  });
  vi.stubGlobal(
    "URL",
    Object.assign(URL, { createObjectURL: () => "blob:", revokeObjectURL: () => {} }),
  );
});
afterEach(() => {
  vi.advanceTimersByTime(120_000); // time after which the notices close
  unsubscribe();
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

describe("a figure", () => {
  let jobs: LayerJobs;
  let files: FileJobs;
  let figures: Figures;
  let state: object;
  beforeEach(() => {
    jobs = new LayerJobs(api, "9", () => {});
    files = new FileJobs(api, jobs);
    figures = new Figures(api, "9", files);
    state = job("running");
    answers.set(kFigures, () => json(job("queued"), 202));
    answers.set("GET /api/v1/jobs/5", () => json(state));
    // as on the server, a request that accepts only JSON gets no drawing
    answers.set("GET /api/v1/jobs/5/file", () =>
      calls.at(-1)!.headers["Accept"] === "*/*"
        ? new Response("%PDF-1.7")
        : json({ title: "Not acceptable" }, 406),
    );
    answers.set("DELETE /api/v1/jobs/5", () => new Response(null, { status: 204 }));
  });
  const make = (): Promise<number> => figures.make("Figure: Pot", { direction: "front", scale: 5 });
  const poll = (): Promise<unknown> => vi.advanceTimersByTimeAsync(1000);
  const end = async (last: object): Promise<void> => {
    state = last;
    await poll();
  };

  it("is asked for as a job, followed, and saved under its name where somebody waits for it", async () => {
    const key = await make();
    expect(calls[0]).toMatchObject({
      path: "/api/v1/models/9/figures?lang=en-GB",
      body: { direction: "front", scale: 5 },
      headers: { Prefer: "respond-async" },
    });
    await poll();
    expect(jobs.entries).toMatchObject([
      { key, name: "Figure: Pot", job: { state: "running", progress: 0.5 } },
    ]);
    await end(job("done", { file }));
    expect([saved, files.saved, jobs.entries, told]).toEqual([["pot-front.pdf"], file, [], []]);
  });

  it("is offered where nobody waits any more, and stays listed until it is saved", async () => {
    await make();
    files.awaited = null;
    await end(job("done", { file }));
    expect([saved, jobs.entries.length, isBusy(jobs.entries[0]!)]).toEqual([[], 1, false]);
    expect(told.map(({ title, detail }) => [title, detail])).toEqual([
      [texts.figures.ready, "pot-front.pdf"],
    ]);
    const link = told[0]!.link!;
    if ("act" in link) link.act();
    await poll();
    expect([saved, jobs.entries]).toEqual([["pot-front.pdf"], []]);
  });

  it("that the server no longer has is told, and stays listed", async () => {
    answers.set("GET /api/v1/jobs/5/file", () =>
      json({ status: 404, title: "This file is gone" }, 404),
    );
    await make();
    await end(job("done", { file }));
    expect([saved, jobs.entries.length, told.map(({ title }) => title)]).toEqual([
      [],
      1,
      ["This file is gone"],
    ]);
  });

  it("is gone once it is cancelled", async () => {
    const key = await make();
    await jobs.cancel(key);
    expect(calls.at(-1)).toMatchObject({ method: "DELETE", path: "/api/v1/jobs/5" });
    await end(job("cancelled"));
    expect([jobs.entries, saved, told]).toEqual([[], [], []]);
  });

  it("that fails tells why", async () => {
    await make();
    await end(
      job("failed", {
        problem: { status: 422, title: "Not so", detail: "No such column", field: "labels.column" },
      }),
    );
    expect(jobs.entries).toMatchObject([{ problem: { field: "labels.column" } }]);
    expect(saved).toEqual([]);
  });

  it("that is refused at once is not listed", async () => {
    answers.set(kFigures, () => json({ status: 422, title: "Not so", field: "scale" }, 422));
    await expect(make()).rejects.toMatchObject({ problem: { field: "scale" } });
    expect(jobs.entries).toEqual([]);
  });

  it("as a picture is given up when it is not wanted any more, which is not a lost network", async () => {
    answers.set(kFigures, () => new Promise<Response>(() => {}));
    const stop = new AbortController();
    const picture = api
      .blob("POST /models/{model}/figures", {
        path: { model: "9" },
        query: { lang: "en-GB" },
        body: { format: "png", dpi: 60 },
        signal: stop.signal,
      })
      .catch((error: unknown) => error);
    stop.abort();
    const error = await picture;
    expect(error).toBeInstanceOf(ApiError);
    expect((error as ApiError).status).toBe(499);
    expect(calls[0]!.headers["Prefer"]).toBeUndefined();
  });
});

describe("a face that is asked for", () => {
  let pick: FacePick;
  let tools: ToolManager;
  let camera: OrbitCamera;
  let turned: number;
  const surface = (normal: number[] | null, more: object = {}): void =>
    void answers.set("POST /api/v1/models/9/pick", () =>
      json({ hit: true, position: [0, 0, 0], ...(normal ? { normal } : {}), ...more }),
    );

  beforeEach(() => {
    camera = new OrbitCamera();
    camera.setModel({ min: [-50, -50, -50], max: [50, 50, 50] }, "z");
    camera.resize(400, 400);
    camera.standardView("front"); // the camera looks along +y
    turned = 0;
    const navigator = { orbit: () => void (turned += 1), pan: () => {}, tap: () => {} };
    pick = new FacePick(api, {
      view: { camera } as never,
      model: () => ({ id: 9 }) as never,
      begin: () => tools.borrow("face"),
      end: () => tools.giveBack(),
    });
    const host = {
      ...navigator,
      tap: (sample: { x: number; y: number }) => void pick.takeAt(sample),
      takeInMiddle: () => pick.takeInMiddle(),
      giveUp: () => pick.giveUp(),
    };
    tools = new ToolManager(
      [
        new OrbitTool(navigator),
        Object.assign(new OrbitTool(navigator), { name: "pan" as const }),
        new FaceTool(host),
      ] as never,
      "pan",
    );
  });
  const tap = (x: number, y: number): void => {
    tools.down({ x, y });
    tools.up();
  };

  it("is where one taps, and the tool from before is in hand again", async () => {
    surface([0, -1, 0]);
    const found = pick.ask();
    expect(tools.active).toBe("face");
    tap(120, 80);
    expect(await found).toEqual({ center: [0, 0, 0], normal: [0, -1, 0] });
    expect(calls.at(-1)!.body).toMatchObject({ x: 120, y: 80 });
    expect(tools.active).toBe("pan");
  });

  it("faces who picked it: of an open scan its inside, and without a normal the picture", async () => {
    surface([0.6, 0.8, 0]);
    let found = pick.ask();
    tap(1, 1);
    expect((await found)!.normal).toEqual([-0.6, -0.8, -0]);
    surface(null);
    found = pick.ask();
    tap(1, 1);
    expect((await found)!.normal.map((part) => Math.round(part) + 0)).toEqual([0, -1, 0]);
  });

  it("is looked for with drags, which turn the model, and taken from the middle by a key", async () => {
    surface([0, -1, 0]);
    const found = pick.ask();
    tools.down({ x: 100, y: 100 });
    tools.move([{ x: 160, y: 100 }]);
    tools.up();
    expect([turned, calls.length, tools.active]).toEqual([1, 0, "face"]);
    expect(tools.key("Enter")).toBe(true);
    expect(await found).not.toBeNull();
    expect(calls.at(-1)!.body).toMatchObject({ x: 200, y: 200 });
  });

  it("is asked for on where there is no surface, or no answer", async () => {
    answers.set("POST /api/v1/models/9/pick", () => json({ hit: false }));
    const found = pick.ask();
    tap(1, 1);
    await vi.advanceTimersByTimeAsync(0);
    expect([tools.active, told.map(({ title }) => title)]).toEqual(["face", [texts.marks.missed]]);
    answers.delete("POST /api/v1/models/9/pick");
    tap(1, 1);
    await vi.advanceTimersByTimeAsync(0);
    expect([tools.active, told.length]).toEqual(["face", 2]);
    surface([0, -1, 0]);
    tap(1, 1);
    expect(await found).not.toBeNull();
  });

  it.each([
    ["Escape", () => void tools.key("Escape")],
    ["another tool", () => tools.choose("orbit")],
    ["the end of the page", () => tools.stop()],
    ["a second question", () => void pick.ask()],
  ])("is none after %s, also when an answer is still on its way", async (_, leave) => {
    surface([0, -1, 0]);
    const found = pick.ask();
    tap(1, 1);
    leave();
    expect(await found).toBeNull();
    await vi.advanceTimersByTimeAsync(0);
    expect(told).toEqual([]);
  });

  it("leaves the chosen tool as it is", () => {
    const begun = vi.fn();
    const before = {
      name: "pan" as const,
      activate: vi.fn(),
      deactivate: begun,
      down: vi.fn(),
      move: vi.fn(),
      up: vi.fn(),
      cancel: vi.fn(),
    };
    const changed = vi.fn();
    const manager = new ToolManager(
      [
        before,
        new FaceTool({
          orbit: vi.fn(),
          pan: vi.fn(),
          tap: vi.fn(),
          takeInMiddle: vi.fn(),
          giveUp: vi.fn(),
        }),
      ],
      "pan",
      changed,
    );
    manager.borrow("face");
    manager.borrow("face");
    manager.giveBack();
    manager.giveBack();
    expect([manager.active, before.activate.mock.calls.length, begun.mock.calls.length]).toEqual([
      "pan",
      1,
      0,
    ]);
    expect(changed.mock.calls).toEqual([["face"], ["pan"]]);
  });
});
