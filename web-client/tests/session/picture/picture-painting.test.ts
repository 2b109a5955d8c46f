import { describe, expect, it } from "vitest";
import type { Layer } from "../../../src/core/types";
import type { Api } from "../../../src/net/api";
import { PicturePainting } from "../../../src/session/picture/picture-painting";
import type { DrawnPart } from "../../../src/session/picture/picture-drawing";

const layer = { id: 7 } as Layer;
const dab = (x: number, color = "red"): DrawnPart => ({
  part: { stroke: { path: [[x, 0]], radius: 1 } },
  color,
});

/** A server whose responses the test gives. */
class FakeServer {
  readonly sent: { call: string; body: unknown; path: unknown }[] = [];
  readonly answers: { give: (value: unknown) => void; fail: (error: unknown) => void }[] = [];
  failures: unknown[] = [];
  changes: unknown[][] = [];
  redraws = 0;
  isShown = true;
  showsMarks = true;
  target: { layer: Layer; paint: { value: number } | { erase: true } } | null = {
    layer,
    paint: { value: 3 },
  };

  readonly painting = new PicturePainting({
    showsMarks: () => this.showsMarks,
    api: {
      json: (call: string, options: { body: unknown; path: unknown }) => this.ask(call, options),
      send: (call: string, options: { body: unknown; path: unknown }) => this.ask(call, options),
    } as unknown as Api,
    modelId: "pot",
    target: () => this.target,
    showChange: (...change) => void this.changes.push(change),
    failed: (error) => void this.failures.push(error),
    redraw: () => {
      ++this.redraws;
      return Promise.resolve(this.isShown);
    },
    changed: () => {},
  });

  paint(drawn: DrawnPart): void {
    this.painting.paint(drawn, ({ layer, paint }) =>
      this.ask("edit", { path: { layer: layer.id }, body: { ...drawn.part, ...paint } }),
    );
  }

  private ask(call: string, { body, path }: { body: unknown; path: unknown }): Promise<never> {
    this.sent.push({ call, body, path });
    return new Promise<never>((give, fail) =>
      this.answers.push({ give: give as (value: unknown) => void, fail }),
    );
  }
}

const settled = (): Promise<void> => new Promise((done) => setTimeout(done));

describe("painting on a picture", () => {
  it("keeps a mark until it is saved and drawn, and reports no change of a layer", async () => {
    const server = new FakeServer();
    const mark: DrawnPart = { part: { point: [1, 2] }, color: "red" };
    let save = (_saved: boolean): void => {};
    server.painting.mark(mark, () => new Promise((done) => (save = done)));
    server.painting.mark(dab(3), () => Promise.reject(new Error("no surface")));
    expect(server.painting.waiting).toHaveLength(2);
    save(true);
    await settled();
    expect(server.painting.waiting).toEqual([]);
    expect([server.redraws, server.changes]).toEqual([1, []]);
    expect(server.failures).toEqual([new Error("no surface")]);
  });

  it("keeps marks over a picture that does not show them, until they are undone", async () => {
    const server = new FakeServer();
    server.showsMarks = false;
    const mark: DrawnPart = { part: { point: [1, 2] }, color: "red" };
    server.painting.mark(mark, () => Promise.resolve(true));
    server.painting.mark(dab(3), () => Promise.resolve(false)); // not saved
    await settled();
    expect(server.painting.waiting).toEqual([mark]);
    const travels = (): Promise<void> => Promise.resolve();
    server.painting.travelMarks("undo", travels);
    server.painting.travelMarks("undo", travels); // of an earlier change
    await settled();
    expect(server.painting.waiting).toEqual([]);
    server.painting.travelMarks("redo", travels);
    await settled();
    expect(server.painting.waiting).toEqual([mark]);
    server.painting.leavePicture();
    expect(server.painting.waiting).toEqual([]);
  });

  it("sends one edit after the other, and then draws the picture once", async () => {
    const server = new FakeServer();
    const { painting } = server;
    const [first, second] = [dab(1), dab(2)];
    server.paint(first);
    server.paint(second);
    await settled();
    expect(painting.waiting).toEqual([first, second]);
    expect(server.sent).toEqual([
      {
        call: "edit",
        path: { layer: 7 },
        body: { ...first.part, value: 3 },
      },
    ]);
    server.answers[0]!.give({ texels_changed: 5, area_m2: 0.25 });
    await settled();
    expect(server.sent.length).toBe(2);
    expect(server.redraws).toBe(0);
    server.answers[1]!.give({ texels_changed: 0, area_m2: 0 });
    await settled();
    expect(server.changes).toEqual([
      [5, 0.25],
      [0, 0],
    ]);
    expect(server.redraws).toBe(1);
    expect(painting.waiting).toEqual([]);
  });

  it("shows parts until the picture contains them", async () => {
    const server = new FakeServer();
    const { painting } = server;
    server.isShown = false;
    server.paint(dab(1));
    server.answers[0]!.give({});
    await settled();
    expect(painting.waiting.length).toBe(1);
    server.isShown = true;
    painting.undo(layer);
    server.answers[1]!.give(undefined);
    await settled();
    expect(painting.waiting).toEqual([]);
  });

  it("forgets parts that a redraw for another reason shows", async () => {
    const server = new FakeServer();
    const { painting } = server;
    server.isShown = false;
    server.paint(dab(1));
    server.answers[0]!.give({});
    await settled();
    server.paint(dab(2));
    server.isShown = true;
    await painting.redraw();
    expect(painting.waiting).toEqual([dab(2)]);
    expect(server.redraws).toBe(2);
  });

  it("keeps the color in which each part was drawn", () => {
    const server = new FakeServer();
    const { painting } = server;
    server.paint(dab(1, "red"));
    server.paint(dab(2, "blue"));
    expect(painting.waiting.map(({ color }) => color)).toEqual(["red", "blue"]);
  });

  it("forgets a refused part, and sends the next one", async () => {
    const server = new FakeServer();
    const { painting } = server;
    server.paint(dab(1));
    server.paint(dab(2));
    const refused = new Error("locked");
    server.answers[0]!.fail(refused);
    await settled();
    expect(server.failures).toEqual([refused]);
    expect(painting.waiting).toEqual([dab(2)]);
    expect(server.sent.length).toBe(2);
  });

  it("erases, and sends nothing without a layer", () => {
    const server = new FakeServer();
    server.target = { layer, paint: { erase: true } };
    server.paint(dab(1));
    expect(server.sent[0]!.body).toMatchObject({ erase: true });
    server.target = null;
    server.paint(dab(2));
    expect(server.painting.waiting.length).toBe(1);
  });

  it("undoes and redoes edits of the layer, and draws the picture again", async () => {
    const server = new FakeServer();
    server.painting.undo(layer);
    server.painting.redo(layer);
    server.answers[0]!.give(undefined);
    await settled();
    server.answers[1]!.give(undefined);
    await settled();
    expect(server.sent).toEqual([
      {
        call: "POST /models/{model}/layers/{layer}/undo",
        path: { model: "pot", layer: 7 },
        body: undefined,
      },
      {
        call: "POST /models/{model}/layers/{layer}/redo",
        path: { model: "pot", layer: 7 },
        body: undefined,
      },
    ]);
    expect(server.redraws).toBe(1);
  });

  it("still sends the parts of an earlier picture, without showing them", async () => {
    const server = new FakeServer();
    server.paint(dab(1));
    server.painting.leavePicture();
    expect(server.painting.waiting).toEqual([]);
    server.answers[0]!.give({});
    await settled();
    expect(server.redraws).toBe(1);
  });
});
