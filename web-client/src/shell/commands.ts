// The commands with keys. `more-commands` contains the commands without keys, which are loaded
// later.

import { kStandardViews } from "../math/view-cube";
import { hasOptions, kChangingTools, kRailTools, kSnappingTools } from "../tools/tool";
import type { ModelSession } from "../session/model-session";
import { kCommandKeys, keyCapsOf, type KeyedCommand } from "../ui/keys/command-keys";
import { texts } from "../texts";
import type { Command } from "./command";
import type { PageHost } from "./open-dialog";
import { kTabs, tabTitle } from "./panel-tabs";

const kArrows: Readonly<Record<string, [number, number]>> = {
  ArrowLeft: [1, 0],
  ArrowRight: [-1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
const kArrowStep = 0.04;
const kZoomStep = 1.15;

/** Returns the reason why the user cannot change the model now. */
export function changeProblem(session: ModelSession): string | undefined {
  if (!session.canPaint) return texts.brush.viewer_only;
  return session.past.isActive ? texts.past.paint_refused : undefined;
}

export function keyCommands(host: PageHost): Command[] {
  const { session } = host;
  const { view, layers } = session;
  const words = texts.commands;
  const selected = layers.selected;
  const command = (id: KeyedCommand, rest: Omit<Command, "id" | "keys" | "caps">): Command => ({
    id,
    keys: kCommandKeys[id],
    caps: keyCapsOf(id),
    ...rest,
  });

  const changing = changeProblem(session);
  const painting = changing ?? (selected ? undefined : words.no_layer);
  const tools = kRailTools.map((tool) =>
    command(`tool.${tool}`, {
      group: texts.model.tools,
      title: texts.tools[tool],
      glyph: tool,
      problem: kChangingTools.includes(tool) ? changing : undefined,
      // If the tool is already active, changes the side of the strokes or the way of the wand, or
      // shows the options of the tool.
      run: () => {
        if (session.tools.active !== tool || !hasOptions(tool)) session.chooseTool(tool);
        else if (tool === "strokes") session.strokes?.draw(!session.strokes.drawsInside);
        else if (tool === "wand") session.selection?.useBrush(!session.selection.wand.brushes);
        else host.panel("layers");
      },
    }),
  );
  const snap = (): void => {
    const isActive = kSnappingTools.includes(session.tools.active);
    session.painting.setBrush((brush) => (brush.snaps = !isActive || !brush.snaps));
    if (!isActive) session.chooseTool("polygon");
  };
  const edit = { group: words.edit };
  const seen = { group: texts.view.title };
  const window = { group: texts.model.panel };
  const move =
    (by: (dx: number, dy: number) => void) =>
    (key: string): void => {
      const [x, y] = kArrows[key.replace("Shift+", "")]!;
      const pixels = Math.min(view.camera.width, view.camera.height) * kArrowStep;
      by(x * pixels, y * pixels);
    };
  const zoom = (factor: number) => (): void =>
    session.gestures.zoom(factor, view.camera.width / 2, view.camera.height / 2);
  const brush = (steps: 1 | -1) => (): void =>
    session.painting.setBrush((each) => each.stepWidth(steps));
  const noViews = session.views.all.length > 0 ? undefined : texts.kept_views.none;
  return [
    ...tools,
    command("polygon.snap", {
      group: texts.model.tools,
      title: `${texts.tools.polygon}: ${texts.areas.snaps}`,
      glyph: "polygon",
      problem: changing,
      run: snap,
    }),
    command("undo", {
      ...edit,
      title: texts.model.undo,
      glyph: "undo",
      problem: painting,
      run: () => session.undo(),
    }),
    command("redo", {
      ...edit,
      title: texts.model.redo,
      glyph: "redo",
      problem: painting,
      run: () => session.redo(),
    }),
    command("brush.narrower", { ...edit, title: words.narrower, glyph: "brush", run: brush(-1) }),
    command("brush.wider", { ...edit, title: words.wider, glyph: "brush", run: brush(1) }),
    command("view.orbit", {
      ...seen,
      title: texts.tools.orbit,
      isKeyOnly: true,
      run: move(session.gestures.orbit),
    }),
    command("view.pan", {
      ...seen,
      title: texts.tools.pan,
      isKeyOnly: true,
      run: move(session.gestures.pan),
    }),
    command("view.zoom_in", {
      ...seen,
      title: words.zoom_in,
      glyph: "plus",
      run: zoom(1 / kZoomStep),
    }),
    command("view.zoom_out", {
      ...seen,
      title: words.zoom_out,
      glyph: "minus",
      run: zoom(kZoomStep),
    }),
    command("view.fit", { ...seen, title: texts.views.fit, glyph: "fit", run: () => view.fit() }),
    command("view.first", {
      ...seen,
      title: texts.views.first,
      glyph: "home",
      run: () => view.flyToFirst(),
    }),
    ...kStandardViews.map((each) =>
      command(`view.${each}`, {
        ...seen,
        title: texts.views[each],
        glyph: "cube",
        run: () => view.standardView(each),
      }),
    ),
    command("view.perspective", {
      ...seen,
      title: texts.views.perspective,
      glyph: "cube",
      run: () => view.setPerspective(true),
    }),
    command("view.orthographic", {
      ...seen,
      title: texts.views.orthographic,
      glyph: "cube",
      run: () => view.setPerspective(false),
    }),
    command("light.next", {
      ...seen,
      title: words.next_light,
      glyph: "bulb",
      run: () => session.appearance.nextLight(),
    }),
    command("section.next", {
      ...seen,
      title: words.next_section,
      glyph: "section",
      run: () => session.appearance.nextSection(),
    }),
    command("views.next", {
      ...seen,
      title: words.next_view,
      glyph: "eye",
      problem: noViews,
      run: () => session.views.step(1),
    }),
    command("views.previous", {
      ...seen,
      title: words.previous_view,
      glyph: "eye",
      problem: noViews,
      run: () => session.views.step(-1),
    }),
    ...kTabs.map((tab) =>
      command(`tab.${tab}`, {
        ...window,
        title: tabTitle(tab),
        glyph: "panel",
        run: () => host.panel(tab),
      }),
    ),
    command("panel", {
      ...window,
      title: words.panel,
      glyph: "panel",
      run: () => host.panel(null),
    }),
    command("table", {
      ...window,
      title: texts.tables.open,
      glyph: "table",
      problem: session.tables.view || selected?.table !== undefined ? undefined : words.no_table,
      run: () => session.toggleTable(),
    }),
    command("past", {
      ...window,
      title: texts.past.title,
      glyph: "history",
      run: () => session.past.toggle(),
    }),
    command("figure", {
      ...window,
      title: texts.figures.open,
      glyph: "document",
      run: () => (session.model ? host.show({ dialog: "figure", view: null }) : undefined),
    }),
    command("commands", {
      ...window,
      title: words.title,
      isKeyOnly: true,
      run: () => host.show({ dialog: "commands" }),
    }),
    command("help", {
      ...window,
      title: texts.help.title,
      glyph: "help",
      run: () => host.show({ dialog: "help" }),
    }),
    command("escape", {
      ...window,
      title: words.leave,
      isKeyOnly: true,
      run: () => leave(session),
    }),
  ];
}

/**
 * Stops following, closes the open comment, or returns to the newest state. Only the first
 * applicable action runs. Returns false if no action applies.
 */
function leave(session: ModelSession): boolean {
  if (session.together.followed) session.together.stopFollowing();
  else if (session.comments.close()) return true;
  else if (session.past.isActive) session.past.goNow();
  else return false;
  return true;
}
