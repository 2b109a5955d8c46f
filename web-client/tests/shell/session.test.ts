import type { ReactiveController } from "lit";
import { followSession } from "../../src/session/follow-session";
import type { SessionPart } from "../../src/session/model-session";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { OpenModelSession } from "../../src/shell/open-model-session";
import { setPartLoads, withPart } from "../../src/shell/page-parts";
import { notices } from "../../src/ui/notices";
import { checkConnections, discardUnsaved, unsavedChanges } from "../../src/session/sessions";
import { texts } from "../../src/texts";
import type { Selection } from "../../src/features/painting/selection";
import { makeStrokes, selectionOf } from "../../src/features/painting/selection-of";
import { sharpFrames } from "../../src/features/painting/sharp-frame";
import { Api } from "../../src/net/api";
import { presencePalette } from "../../src/domain/palette";
import type { Role, Welcome } from "../../src/core/protocol.gen";
import type { Layer } from "../../src/core/types";
import { FakeSocket, welcome } from "../fake-socket";

const model = {
  id: 1,
  name: "Pot",
  unit: "mm",
  up: "z",
  scale_verified: true,
  bounds: { min: [0, 0, 0], max: [100, 100, 100] },
} as unknown as Welcome["model"];
const layer = (id: number, order: number): Layer => ({
  id,
  model: 1,
  name: `L${id}`,
  slug: `l${id}`,
  kind: "numeric",
  type: "u8",
  resolution: 2048,
  unit: "",
  description: "",
  labels: {},
  descriptions: {},
  palette: presencePalette("x", "#ff0000ff"),
  opacity: 1,
  visible: true,
  locked: false,
  review: false,
  visibility: "public",
  order,
  sequence: 0,
});

let sockets: FakeSocket[];
let answers: Map<string, [status: number, body: unknown]>; // keyed by method and path
let session: OpenModelSession;
let told: string[];
let unsubscribe: () => void;
let kept: unknown[]; // the stored settings of the layers

const socket = (): FakeSocket => sockets[sockets.length - 1]!;
const settle = (): Promise<unknown> => vi.advanceTimersByTimeAsync(0);

async function open(role: Role = "owner"): Promise<void> {
  await session.open();
  session.view.setViewport(800, 600, 1);
  join(role);
}
function join(role: Role = "owner", layers = [layer(7, 0), layer(8, 1)]): void {
  socket().open();
  socket().receive({ ...welcome(), role, model, layers });
}
/** Paints a dab in the selected layer, which is not saved yet. Returns a function that saves it. */
function paint(): () => void {
  session.chooseTool("brush");
  session.gestures.toolDown({ x: 5, y: 5 });
  session.gestures.toolUp();
  const { stroke } = socket().of("stroke.begin").at(-1)!;
  return () => socket().receive({ op: "saved", stroke, n: 0, sequence: 1 });
}

beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("window", { location: { protocol: "http:", host: "here" }, devicePixelRatio: 1 });
  vi.stubGlobal("requestAnimationFrame", (callback: () => void) => setTimeout(callback, 16));
  sockets = [];
  kept = [];
  answers = new Map([["GET /api/v1/models/1", [200, model]]]);
  const api = new Api(async (path, init) => {
    if (path.startsWith("/api/v1/me/") && answers.has(`${init!.method} ${path}`))
      kept.push(JSON.parse(init!.body as string));
    const [status, body] = answers.get(`${init!.method} ${path}`) ?? [
      500,
      { title: `no answer for ${init!.method} ${path}` },
    ];
    return new Response(JSON.stringify(body), { status, headers: { ETag: '"1"' } });
  });
  session = new OpenModelSession(api, "1", (url, protocol) => {
    sockets.push(new FakeSocket(url, protocol));
    return socket();
  });
  told = [];
  unsubscribe = notices.subscribe((shown) => (told = shown.map((notice) => notice.title)));
});
afterEach(() => {
  discardUnsaved();
  vi.advanceTimersByTime(60_000); // time after which the notices close
  unsubscribe();
  vi.unstubAllGlobals();
  vi.useRealTimers();
});

describe("a change", () => {
  /** Counts the redraws of an element that follows these parts. */
  function follower(...parts: SessionPart[]): { redraws: number; leave(): void } {
    let controller: ReactiveController | null = null;
    const drawn = { redraws: 0, leave: () => controller?.hostDisconnected?.() };
    followSession(
      {
        session,
        addController: (added: ReactiveController) => (controller = added),
        requestUpdate: () => (drawn.redraws += 1),
      } as unknown as Parameters<typeof followSession>[0],
      ...parts,
    );
    const follows = controller as ReactiveController | null;
    follows?.hostConnected?.();
    follows?.hostUpdate?.();
    drawn.redraws = 0;
    return drawn;
  }

  it("redraws what shows it, and nothing else", async () => {
    await open();
    const [all, pointer, list, saving, thread] = [
      follower(),
      follower("pointer"),
      follower("layers", "tables"),
      follower("saving"),
      follower("comments"),
    ];
    const redraws = (): number[] => {
      const counts = [all, pointer, list, saving, thread].map((each) => each.redraws);
      for (const each of [all, pointer, list, saving, thread]) each.redraws = 0;
      return counts;
    };
    session.gestures.hover({ x: 1, y: 1 });
    expect(redraws()).toEqual([1, 1, 0, 0, 0]);
    const [layer] = session.layers.all;
    session.layers.setVisible(layer!, !session.layers.visible(layer!));
    expect(redraws()).toEqual([1, 0, 1, 0, 0]);
    session.comments.pinsShown = !session.comments.pinsShown;
    expect(redraws()).toEqual([2, 0, 0, 0, 2]);
    const save = paint();
    const [, , listed, saved, told] = redraws();
    expect([listed, saved! > 0, told]).toEqual([0, true, 0]);
    save();
    expect(redraws()[3]).toBeGreaterThan(0);
  });

  it("of the session itself redraws all of them, but for those that have left", async () => {
    await open();
    const [all, list, gone] = [follower(), follower("layers"), follower("layers")];
    gone.leave();
    session.previewScale({ unit: "mm", up: "z" });
    expect([all.redraws, list.redraws, gone.redraws]).toEqual([1, 1, 0]);
  });
});

describe("leaving a model", () => {
  it("with everything saved ends the connection", async () => {
    await open();
    paint()();
    session.close();
    expect(socket().closed).toBe(true);
  });

  it("before it was open does not open it afterwards", async () => {
    const opening = session.open();
    session.close();
    await opening;
    expect(sockets).toEqual([]);
  });

  it("keeps the connection until all is saved, and says nothing", async () => {
    await open();
    const save = paint();
    session.close();
    expect(socket().closed).toBe(false);
    expect(unsavedChanges()).toBe(1);
    save();
    expect(socket().closed).toBe(true);
    expect(unsavedChanges()).toBe(0);
    expect(told).toEqual([]);
  });

  it("ends the stroke that is being drawn, and its last points go out", async () => {
    await open();
    session.chooseTool("brush");
    session.gestures.toolDown({ x: 5, y: 5 });
    session.gestures.toolMove([{ x: 90, y: 5 }]);
    session.close();
    expect(
      socket()
        .of("stroke.extend")
        .map((message) => message.path),
    ).toEqual([[[5, 5]], [[90, 5]]]);
    expect(socket().of("stroke.end").length).toBe(1);
  });

  it("without a connection: the person is told once, and the changes go out when it is back", async () => {
    await open();
    paint();
    socket().lose();
    session.close();
    await vi.advanceTimersByTimeAsync(300);
    socket().lose();
    await vi.advanceTimersByTimeAsync(900);
    expect(told).toEqual([texts.saving.left_behind(1, "Pot")]);
    join();
    const [begin] = socket().of("stroke.begin");
    expect(socket().of("camera")).toEqual([]);
    socket().receive({ op: "saved", stroke: begin!.stroke, n: 0, sequence: 1 });
    expect(told).toContain(texts.saving.left_saved("Pot"));
    expect(socket().closed).toBe(true);
  });

  it("signed out: what waits goes out after the next sign-in, but not in somebody else's name", async () => {
    await open();
    paint();
    answers.set("GET /api/v1/models/1", [401, { title: "Not signed in" }]);
    socket().lose();
    await settle();
    expect(session.signedOut).toBe(true);
    session.close(); // the page shows the sign-in form
    checkConnections();
    join();
    expect(session.signedOut).toBe(false);
    expect(socket().of("stroke.extend").length).toBe(1);
    expect(discardUnsaved()).toBe(1);
    expect(socket().closed).toBe(true);
  });

  it("a model that was deleted takes what waits with it, and the person is told", async () => {
    await open();
    paint();
    socket().receive({ op: "model", event: "deleted", model: 1 } as never);
    expect(told).toEqual([texts.saving.lost_with_model(1, "Pot")]);
    expect([session.deleted, unsavedChanges()]).toEqual([true, 0]);
    session.close();
    expect(told.length).toBe(1);
  });
});

describe("the camera in mid-stroke", () => {
  it("stays, whatever is pressed; a new size of the stage waits", async () => {
    await open();
    session.chooseTool("brush");
    session.gestures.toolDown({ x: 5, y: 5 });
    const before = session.view.camera.message();
    session.view.standardView("top");
    session.view.fit();
    session.view.setPerspective(false);
    session.gestures.zoom(0.5, 9, 9);
    session.view.setViewport(400, 300, 1);
    expect(session.view.camera.message()).toEqual(before);
    session.gestures.toolUp();
    expect([
      session.view.camera.width,
      session.view.camera.height,
      session.view.camera.perspective,
    ]).toEqual([400, 300, true]);
    session.view.standardView("top");
    expect(session.view.camera.elevation).toBeCloseTo(Math.PI / 2);
  });
});

describe("edits of whole areas", () => {
  // the page loads it later
  const selection = (): Selection => selectionOf(session);
  const edits = () =>
    socket()
      .of("edit")
      .map(({ edit }) => edit);

  it("a polygon is sent with the camera that it was drawn in, which stays meanwhile", async () => {
    await open();
    const area = selection();
    session.chooseTool("polygon");
    const camera = session.view.camera.message();
    for (const [x, y] of [
      [5, 5],
      [200, 5],
      [200, 200],
    ] as const) {
      session.gestures.toolDown({ x, y });
      session.gestures.toolUp();
      session.gestures.zoom(0.5, 9, 9);
    }
    session.tools.key("Enter"); // closes the outline
    expect(edits()).toEqual([]);
    session.gestures.zoom(0.5, 9, 9);
    expect(session.view.camera.message()).not.toEqual(camera);
    session.tools.key("Enter"); // fills the selection
    expect(edits()).toEqual([
      {
        op: "polygon",
        value: 1,
        camera,
        path: [
          [5, 5],
          [200, 5],
          [200, 200],
        ],
        through: false,
      },
    ]);
    await settle();
    expect(area.isEmpty).toBe(true);
  });

  it("outlines of several views are sent as one edit, each with its camera", async () => {
    await open();
    const area = selection();
    session.chooseTool("polygon");
    const outline = (x: number, keys: { shift?: boolean; alt?: boolean } = {}): void => {
      for (const [dx, dy] of [
        [0, 0],
        [100, 0],
        [100, 100],
      ] as const) {
        session.gestures.toolDown({ x: x + dx, y: 5 + dy, ...keys });
        session.gestures.toolUp();
      }
      session.tools.key("Enter");
    };
    outline(5);
    session.gestures.orbit(40, 0);
    const second = session.view.camera.message();
    outline(50, { alt: true });
    await area.paint(true);
    expect(edits()).toMatchObject([
      { op: "polygon", erase: true, steps: [{ combine: "subtract", camera: second }] },
    ]);
  });

  it("a selection ends with another tool that paints, not with one that looks", async () => {
    await open();
    const area = selection();
    session.chooseTool("lasso");
    session.gestures.toolDown({ x: 5, y: 5 });
    session.gestures.toolMove([
      { x: 100, y: 5 },
      { x: 100, y: 100 },
    ]);
    session.gestures.toolUp();
    expect(area.outlines).toHaveLength(1);
    for (const tool of ["orbit", "wand", "polygon"] as const) session.chooseTool(tool);
    expect(area.isEmpty).toBe(false);
    session.chooseTool("brush");
    expect(area.isEmpty).toBe(true);
    expect(edits()).toEqual([]);
  });

  it("redo restores paint that was undone after the strokes of an area", async () => {
    setPartLoads({ model_dialogs: async () => ({ makeStrokes, sharpFrames }) } as never);
    withPart("model_dialogs", () => {});
    await open();
    session.chooseTool("strokes");
    session.gestures.toolDown({ x: 5, y: 5 });
    session.gestures.toolUp();
    session.undo();
    expect(session.strokes!.canRedo).toBe(true);
    session.undo();
    session.redo();
    expect(session.strokes!.isOpen).toBe(false);
    expect(
      socket()
        .sentOps()
        .filter((op) => op === "undo" || op === "redo"),
    ).toEqual(["undo", "redo"]);
  });

  it("the bucket fills what its panel says, or erases it", async () => {
    await open();
    session.chooseTool("bucket");
    const at = { camera: session.view.camera.message(), x: 40, y: 50 };
    const press = (): void => {
      session.gestures.toolDown({ x: 40, y: 50 });
      session.gestures.toolUp();
    };
    press();
    session.painting.setBrush((brush) => (brush.areas = { erases: true, reach: "island" }));
    press();
    expect(edits()).toEqual([
      { op: "fill", value: 1, mode: "connected", at },
      { op: "fill", erase: true, mode: "island", at },
    ]);
  });

  it("the person is told how much changed", async () => {
    await open();
    session.painting.fill(session.layers.all[0]!);
    const { id } = socket().of("edit").at(-1)!;
    const { stroke } = ((): { stroke: string } => {
      paint();
      return socket().of("stroke.begin").at(-1)!;
    })();
    socket().receive({
      op: "applied",
      stroke,
      n: 0,
      sequence: 1,
      texels_changed: 5,
      area_m2: 1,
    } as never);
    expect(told).toEqual([]);
    socket().receive({
      op: "applied",
      id,
      sequence: 2,
      texels_changed: 500,
      area_m2: 0.00023,
    } as never);
    expect(told).toEqual([texts.areas.changed("2.3 cm²")]);
    socket().receive({
      op: "applied",
      id,
      sequence: 2,
      texels_changed: 500,
      area_m2: 0.00023,
    } as never);
    expect(told.length).toBe(1);
  });

  it("a viewer is refused before anything is drawn", async () => {
    await open("viewer");
    session.chooseTool("lasso");
    session.gestures.toolDown({ x: 5, y: 5 });
    expect(session.tools.outline).toBe(null);
    expect(told).toEqual([texts.brush.viewer_only]);
  });
});

describe("what this person shows and hides", () => {
  it("of a deleted layer is forgotten at once", async () => {
    await open();
    session.layers.setVisible(session.layers.all[0]!, false);
    session.layers.setOpacity(session.layers.all[1]!, 0.5);
    socket().receive({ op: "layer", event: "deleted", layer_id: 7 } as never);
    expect(socket().of("layers").at(-1)!.layers).toEqual([{ layer: 8, opacity: 0.5 }]);
  });
  it("of a layer that was deleted while the connection was lost is forgotten, too", async () => {
    await open();
    session.layers.setVisible(session.layers.all[0]!, false);
    socket().lose();
    await vi.advanceTimersByTimeAsync(1000);
    join("owner", [layer(8, 1)]);
    expect(socket().of("layers")).toEqual([]);
    session.layers.setOpacity(session.layers.all[0]!, 0.5);
    expect(socket().of("layers").at(-1)!.layers).toEqual([{ layer: 8, opacity: 0.5 }]);
  });
});

describe("roles", () => {
  it.each<[Role, boolean, boolean]>([
    ["viewer", false, false],
    ["annotator", true, false],
    ["curator", true, true],
    ["administrator", true, true],
    ["owner", true, true],
  ])("%s", async (role, paints, curates) => {
    await open(role);
    expect([session.canPaint, session.canCurate]).toEqual([paints, curates]);
  });

  it("who paints on a layer that is locked sends nothing more, is told once, and goes on when it is unlocked", async () => {
    const lock = (id: number, locked: boolean): void =>
      socket().receive({
        op: "layer",
        event: "changed",
        layer_id: id,
        layer: { ...layer(id, id - 7), locked },
      });
    await open("annotator");
    session.chooseTool("brush");
    session.gestures.toolDown({ x: 5, y: 5 });
    expect(session.painting.stroking).toBe(true);
    lock(8, true);
    expect(told).toEqual([texts.layers.locked]);
    expect(session.lockedTarget?.id).toBe(8);
    expect(session.painting.stroking).toBe(false);
    const changes = (): string[] =>
      socket()
        .sentOps()
        .filter((op) => /^(stroke|edit|undo|redo)/.test(op));
    const untilNow = changes();
    session.gestures.toolMove([{ x: 90, y: 5 }]);
    session.gestures.toolUp();
    for (const name of ["brush", "eraser", "polygon", "lasso", "bucket"] as const) {
      session.chooseTool(name);
      session.gestures.toolDown({ x: 5, y: 5 });
      session.gestures.toolUp();
      expect(session.tools.outline).toBe(null);
    }
    session.undo();
    session.redo();
    session.painting.fill(session.layers.find(8)!);
    expect(changes()).toEqual(untilNow);
    expect(untilNow.at(-1)).toBe("stroke.end");
    expect(told).toEqual([texts.layers.locked]);
    // The server also refuses the pending messages. These problems cause no new notice.
    socket().receive({
      op: "problem",
      title: "Locked, says the server",
      status: 403,
      detail: "in its language",
      field: "layer",
    });
    expect(told).toEqual([texts.layers.locked]);

    session.layers.select(session.layers.find(7)!);
    expect(session.lockedTarget).toBe(null);
    session.layers.select(session.layers.find(8)!);
    session.chooseTool("orbit"); // a lock does not affect a tool for viewing
    expect(session.lockedTarget).toBe(null);
    lock(8, false);
    paint()();
    expect(changes().length).toBe(untilNow.length + 3);
  });

  it("a curator paints on a locked layer", async () => {
    await session.open();
    join("curator", [{ ...layer(7, 0), locked: true }]);
    session.view.setViewport(800, 600, 1);
    paint()();
    expect(session.lockedTarget).toBe(null);
    expect(told).toEqual([]);
  });

  it("who may only look chooses no tool that changes anything, takes nothing back, and is told why", async () => {
    await open("viewer");
    for (const name of ["brush", "eraser", "polygon", "lasso", "bucket", "line", "point"] as const)
      session.chooseTool(name);
    expect(session.tools.active).toBe("orbit");
    session.undo();
    session.redo();
    expect(
      socket()
        .sentOps()
        .filter((op) => op === "undo" || op === "redo"),
    ).toEqual([]);
    expect(told).toEqual([texts.brush.viewer_only]);
    session.chooseTool("pick");
    expect(session.tools.active).toBe("pick");
  });

  it("before the server has said who this is, tools that change anything wait, and nothing is said", async () => {
    await session.open();
    session.chooseTool("brush");
    expect([session.tools.active, told.length]).toEqual(["orbit", 0]);
  });

  it("that changes while a model is open is told, and puts the brush away where it may no longer be used", async () => {
    await open("annotator");
    session.chooseTool("brush");
    socket().lose();
    await vi.advanceTimersByTimeAsync(1000);
    join("viewer");
    expect([session.canPaint, session.tools.active]).toEqual([false, "orbit"]);
    expect(told).toEqual([texts.people.role_now("viewer")]);
    socket().lose();
    await vi.advanceTimersByTimeAsync(10_000);
    join("curator");
    expect(session.canCurate).toBe(true);
    expect(told.at(-1)).toBe(texts.people.role_now("curator"));
  });
});

describe("how a person shows the layers", () => {
  const kKeep = "PUT /api/v1/me/models/1/view";
  const shown = (): unknown[] =>
    session.layers.all.map((layer) => [
      layer.id,
      session.layers.visible(layer),
      session.layers.opacity(layer),
    ]);
  const toldServer = (): unknown => socket().of("layers").at(-1)?.layers;

  it("is kept for them alone, and what is as everybody has it is not kept", async () => {
    await open();
    answers.set(kKeep, [200, { layers: [] }]);
    session.layers.setVisible(session.layers.all[0]!, false);
    session.layers.setOpacity(session.layers.all[1]!, 0.4);
    expect(kept).toEqual([]);
    await vi.advanceTimersByTimeAsync(1000);
    expect(kept).toEqual([
      {
        layers: [
          { layer: 7, visible: false },
          { layer: 8, opacity: 0.4 },
        ],
      },
    ]);
    session.layers.setVisible(session.layers.all[0]!, true);
    session.layers.flush();
    await settle();
    expect(kept.at(-1)).toEqual({ layers: [{ layer: 8, opacity: 0.4 }] });
    session.layers.resetOverrides();
    session.close(); // immediately
    await settle();
    expect(kept.at(-1)).toEqual({ layers: [] });
  });

  it("is there when the model is opened, and what this page has not sent yet is newer", async () => {
    await session.open();
    session.view.setViewport(800, 600, 1);
    const again = (): void => {
      socket().open();
      socket().receive({
        ...welcome(),
        role: "viewer",
        model,
        layers: [layer(7, 0), layer(8, 1)],
        personal_view: { layers: [{ layer: 7, visible: false, order: 4 }, { layer: 99 }] },
      });
    };
    again();
    expect(shown()).toEqual([
      [8, true, 1],
      [7, false, 1],
    ]);
    expect(toldServer()).toEqual([{ layer: 7, visible: false, order: 4 }]);
    session.layers.setVisible(session.layers.find(7)!, true);
    await vi.advanceTimersByTimeAsync(1000); // the request fails because the server is unreachable
    socket().lose();
    await vi.advanceTimersByTimeAsync(1000);
    answers.set(kKeep, [200, { layers: [] }]);
    again();
    await settle();
    expect(session.layers.visible(session.layers.find(7)!)).toBe(true);
    expect(kept.at(-1)).toEqual({ layers: [{ layer: 7, order: 4 }] });
  });

  it("has an order of their own, which changes no layer for others", async () => {
    await open("viewer");
    answers.set(kKeep, [200, { layers: [] }]);
    session.layers.arrange([...session.layers.all].reverse());
    expect(session.layers.all.map(({ id, order }) => [id, order])).toEqual([
      [8, 1],
      [7, 0],
    ]);
    await vi.advanceTimersByTimeAsync(1000);
    expect(kept).toEqual([
      {
        layers: [
          { layer: 8, order: 0 },
          { layer: 7, order: 1 },
        ],
      },
    ]);
    expect(session.layers.hasOverrides).toBe(true);
  });

  it("is not what a named view shows, but for what they change there", async () => {
    await open();
    answers.set(kKeep, [200, { layers: [] }]);
    const back = session.layers.showView({
      layers: [
        { layer: 7, visible: false },
        { layer: 8, opacity: 0.2 },
      ],
    });
    await vi.advanceTimersByTimeAsync(1000);
    expect(kept).toEqual([]);
    session.layers.setVisible(session.layers.find(8)!, false);
    await vi.advanceTimersByTimeAsync(1000);
    expect(kept).toEqual([{ layers: [{ layer: 8, visible: false }] }]);
    back();
    expect(shown()).toEqual([
      [7, true, 1],
      [8, false, 1],
    ]);
  });
});

describe("another survey of the object", () => {
  const surveyed = { ...model, project: "default", object: 7, survey_date: "2022" };
  const survey = (id: number, date: string): object => ({
    model: id,
    slug: date,
    name: date,
    date,
  });

  it("is shown with the same camera and the layers of the same names, until the page closes", async () => {
    answers.set("GET /api/v1/models/1", [200, surveyed]);
    answers.set("GET /api/v1/projects/default/objects/7", [
      200,
      { id: 7, name: "Bust", surveys: [survey(2, "2019"), survey(1, "2022")] },
    ]);
    await session.open();
    session.view.setViewport(800, 600, 1);
    socket().open();
    socket().receive({ ...welcome(), role: "owner", model: surveyed, layers: [layer(7, 0)] });
    await settle();
    session.surveys.compareWith(session.surveys.others[0]!);
    const [own, other] = sockets as [FakeSocket, FakeSocket];
    other.open();
    const same = { ...layer(9, 0), name: "L7" };
    other.receive({ ...welcome(), model: { ...surveyed, id: 2 }, layers: [same, layer(10, 1)] });
    expect(other.of("layers").at(-1)!.layers).toEqual([{ layer: 9, visible: true, opacity: 1 }]);
    session.layers.setVisible(session.layers.find(7)!, false);
    expect(other.of("layers").at(-1)!.layers).toEqual([{ layer: 9, visible: false, opacity: 1 }]);
    session.view.orbitPixels(40, 0);
    await vi.advanceTimersByTimeAsync(50);
    expect(other.of("camera").at(-1)!.view).toEqual(own.of("camera").at(-1)!.view);
    session.close();
    expect(other.closed).toBe(true);
  });
});
