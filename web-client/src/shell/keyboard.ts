// Shortcuts of the model page. Keys typed into a field or for an open dialog are excluded
// (`ui/keyboard`).

import type { StandardView } from "../math/camera";
import { kToolKeys, type ToolName } from "../tools/tool";
import type { OpenModelSession } from "./open-model-session";
import { kTabKeys, type PanelTab } from "./panel-tabs";

const kViews: StandardView[] = ["front", "back", "left", "right", "top", "bottom"];
const kToolOfKey = new Map(
  Object.entries(kToolKeys).map(([tool, key]) => [key.toLowerCase(), tool as ToolName]),
);
const kTabOfKey = new Map(
  Object.entries(kTabKeys).map(([tab, key]) => [key.toLowerCase(), tab as PanelTab]),
);
const kArrows: Record<string, [number, number]> = {
  ArrowLeft: [1, 0],
  ArrowRight: [-1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
const kArrowStep = 0.04;

/** What keys do with the page. */
export interface KeyHost {
  show(dialog: "help" | "figure"): void;
  /** Shows a tab of the side panel; null: shows or hides the panel. */
  panel(tab: PanelTab | null): void;
}

/** Runs the action of the key; returns false if it has none. */
export function handleKey(
  event: KeyboardEvent,
  session: OpenModelSession,
  { show, panel }: KeyHost,
): boolean {
  const { key } = event;
  if (event.ctrlKey || event.metaKey) {
    if (event.altKey || key.toLowerCase() !== "z") return false;
    if (event.shiftKey) session.redo();
    else session.undo();
    return true;
  }
  if (event.altKey) return false;
  if (session.tools.key(key)) return true;
  const tool = kToolOfKey.get(key.toLowerCase());
  if (tool) {
    session.chooseTool(tool);
    return true;
  }
  const tab = kTabOfKey.get(key.toLowerCase());
  if (tab) {
    panel(tab);
    return true;
  }
  const arrow = kArrows[key];
  if (arrow) {
    const pixels = Math.min(session.view.camera.width, session.view.camera.height) * kArrowStep;
    const move = event.shiftKey ? session.gestures.pan : session.gestures.orbit;
    move(arrow[0] * pixels, arrow[1] * pixels);
    return true;
  }
  const { width, height } = session.view.camera;
  switch (key) {
    case "Escape":
      if (!session.together.followed) {
        if (session.comments.close()) return true;
        if (!session.past.isActive) return false;
        session.past.goNow();
        return true;
      }
      session.together.stopFollowing();
      return true;
    case "+":
    case "=":
      session.gestures.zoom(1 / 1.15, width / 2, height / 2);
      return true;
    case "-":
    case "_":
      session.gestures.zoom(1.15, width / 2, height / 2);
      return true;
    case "Home":
      if (event.shiftKey) session.view.flyToFirst();
      else session.view.fit();
      return true;
    case "p":
    case "P":
      session.view.setPerspective(true);
      return true;
    case "o":
    case "O":
      session.view.setPerspective(false);
      return true;
    case "[":
    case "]":
      session.painting.setBrush((brush) => brush.stepWidth(key === "]" ? 1 : -1));
      return true;
    case "k":
    case "K":
      session.appearance.nextLight();
      return true;
    case "x":
    case "X":
      session.appearance.nextSection();
      return true;
    case "n":
    case "N":
      session.views.step(event.shiftKey ? -1 : 1);
      return true;
    case "z":
    case "Z":
      session.past.toggle();
      return true;
    case "q":
    case "Q":
      panel(null);
      return true;
    case "t":
    case "T":
      session.toggleTable();
      return true;
    case "f":
    case "F":
      if (session.model) show("figure");
      return true;
    case "?":
      show("help");
      return true;
  }
  const view = /^[1-6]$/.test(key) ? kViews[Number(key) - 1] : undefined;
  if (!view) return false;
  session.view.standardView(view);
  return true;
}
