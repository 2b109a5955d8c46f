import { beforeEach, describe, expect, it, vi } from "vitest";
import { Api } from "../../src/net/api";
import type { Layer, Me } from "../../src/core/types";
import { presencePalette } from "../../src/domain/palette";
import { OpenModelSession } from "../../src/shell/open-model-session";
import { handleKey } from "../../src/shell/keyboard";
import { keyCommands } from "../../src/shell/commands";
import { moreCommands } from "../../src/shell/more-commands";
import type { OpenDialog, PageHost } from "../../src/shell/open-dialog";
import { kCommandKeys } from "../../src/ui/keys/command-keys";
import { kRailTools } from "../../src/tools/tool";
import { texts } from "../../src/texts";
import { FakeSocket } from "../fake-socket";

let session: OpenModelSession;
let host: PageHost;
let shown: (OpenDialog | null)[];
let panels: (string | null)[];

beforeEach(() => {
  vi.stubGlobal("window", { location: { protocol: "http:", host: "here" }, devicePixelRatio: 1 });
  const api = new Api(async () => new Response("{}", { status: 500 }));
  session = new OpenModelSession(api, "1", (url, protocol) => new FakeSocket(url, protocol));
  shown = [];
  panels = [];
  host = {
    session,
    me: { user: "ida", full_name: "Ida Roe", role: "owner" } as Me,
    seesToKiosks: true,
    show: (dialog) => shown.push(dialog),
    aside: () => {},
    panel: (tab) => panels.push(tab),
    account: () => {},
    editTour: () => {},
    signedOut: () => {},
    startTour: () => {},
    sayWhoDownloads: () => {},
  };
  session.role = "owner";
});

const press = (key: string, held: Partial<KeyboardEvent> & { altGraph?: boolean } = {}): boolean =>
  handleKey(
    {
      key,
      ctrlKey: false,
      metaKey: false,
      altKey: false,
      shiftKey: false,
      getModifierState: () => held.altGraph ?? false,
      ...held,
    } as unknown as KeyboardEvent,
    host,
  );
const all = () => [...keyCommands(host), ...moreCommands(host)];
const layer = (id: number, more: Partial<Layer> = {}): Layer =>
  ({
    id,
    name: `L${id}`,
    labels: {},
    descriptions: {},
    palette: presencePalette("x", "#ff0000ff"),
    opacity: 1,
    visible: true,
    locked: false,
    order: id,
    type: "u8",
    kind: "numeric",
    ...more,
  }) as Layer;

describe("The commands", () => {
  it("have different ids, and no two of them share a key", () => {
    session.layers.takeAll([layer(1), layer(2)]);
    const ids = all().map(({ id }) => id);
    expect(new Set(ids).size).toBe(ids.length);
    const keys = all().flatMap(({ keys: own = [] }) => own);
    expect(new Set(keys).size).toBe(keys.length);
    // letters have the same effect with Shift unless a command defines another one
    expect(keys.length).toBeGreaterThan(50);
  });

  it("use every key of the list of keys, and no tool is without one", () => {
    expect(new Set(keyCommands(host).map(({ id }) => id))).toEqual(
      new Set(Object.keys(kCommandKeys)),
    );
    for (const tool of kRailTools) expect(kCommandKeys).toHaveProperty([`tool.${tool}`]);
  });

  it("say why they are not possible", () => {
    const problem = (id: string): string | undefined =>
      all().find((each) => each.id === id)?.problem;
    expect(problem("undo")).toBe(texts.commands.no_layer);
    session.layers.takeAll([layer(1)]);
    expect(problem("undo")).toBeUndefined();
    expect(problem("table")).toBe(texts.commands.no_table);
    expect(problem("views.next")).toBe(texts.kept_views.none);
    session.role = "viewer";
    expect(problem("tool.brush")).toBe(texts.brush.viewer_only);
    expect(problem("tool.measure")).toBeUndefined();
    expect(problem("open.where")).toBe(texts.brush.viewer_only);
    expect(all().some(({ id }) => id === "open.create")).toBe(false);
  });

  it("reach the layers by name", () => {
    session.layers.takeAll([
      layer(1, { name: "Moisture" }),
      layer(2, { labels: { en: "Cracks" } }),
    ]);
    const titles = all().map(({ title }) => title);
    expect(titles).toContain("Hide Moisture");
    expect(titles).toContain("Paint on Cracks");
    all()
      .find(({ title }) => title === "Hide Moisture")!
      .run("");
    expect(session.layers.visible(session.layers.find(1)!)).toBe(false);
    expect(all().map(({ title }) => title)).toContain("Show Moisture");
  });
});

describe("A key", () => {
  it("runs its command, in capital and small letters", () => {
    expect(press("m")).toBe(true);
    expect(session.tools.active).toBe("measure");
    expect(press("V", { shiftKey: true })).toBe(true);
    expect(session.tools.active).toBe("orbit");
    expect(press("y")).toBe(true);
    expect(press("Q")).toBe(true);
    expect(panels).toEqual(["layers", null]);
    expect(press("?", { shiftKey: true })).toBe(true);
    expect(shown).toEqual([{ dialog: "help" }]);
  });

  it("of the active tool shows its options again", () => {
    press("b");
    expect(panels).toEqual([]);
    press("b");
    expect(panels).toEqual(["layers"]);
    press("v");
    press("v");
    expect(panels).toEqual(["layers"]);
  });

  it("snaps the polygon, the lasso or the line to edges, and chooses the polygon for it", () => {
    const { brush } = session.painting;
    const snap = (): boolean => press("A", { shiftKey: true });
    expect(snap()).toBe(true);
    expect([session.tools.active, brush.snaps]).toEqual(["polygon", true]);
    snap();
    expect([session.tools.active, brush.snaps]).toEqual(["polygon", false]);
    press("d");
    snap();
    expect([session.tools.active, brush.snaps]).toEqual(["line", true]);
    session.tools.choose("lasso");
    snap();
    expect([session.tools.active, brush.snaps]).toEqual(["lasso", false]);
    press("v");
    snap();
    expect([session.tools.active, brush.snaps]).toEqual(["polygon", true]);
  });

  it("with Ctrl or Cmd is another one, and with Alt the browser's", () => {
    expect(press("k", { ctrlKey: true })).toBe(true);
    expect(press("k", { metaKey: true })).toBe(true);
    expect(shown).toEqual([{ dialog: "commands" }, { dialog: "commands" }]);
    expect(press("b", { ctrlKey: true })).toBe(false);
    expect(press("Home", { ctrlKey: true })).toBe(false);
    expect(press("k", { altKey: true })).toBe(false);
    expect(session.tools.active).toBe("orbit");
  });

  it("of brackets works where AltGr types them", () => {
    const { px } = session.painting.brush.width;
    expect(press("]", { altGraph: true, ctrlKey: true, altKey: true })).toBe(true);
    expect(session.painting.brush.width.px).toBeGreaterThan(px);
  });

  it("without a command or with nothing to do is left to others", () => {
    expect(press("§")).toBe(false);
    expect(press("Escape")).toBe(false);
  });
});
