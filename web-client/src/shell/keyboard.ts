// Keys of the model page, and of choices. A key that someone types into a field, or that a dialog
// is open for, is not one of these.

import type { StandardView } from "../math/camera";
import type { ToolName } from "../tools/tool";
import type { ModelSession } from "./model-session";

const kViews: StandardView[] = ["front", "back", "left", "right", "top", "bottom"];
const kTools: Record<string, ToolName> = {
  b: "brush",
  e: "eraser",
  a: "polygon",
  l: "lasso",
  g: "bucket",
  i: "pick",
  m: "measure",
  d: "line",
  s: "point",
  c: "comment",
  v: "orbit",
  h: "pan",
};
const kArrows: Record<string, [number, number]> = {
  ArrowLeft: [1, 0],
  ArrowRight: [-1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
const kArrowStep = 0.04; // share of the window per key press

/**
 * Whether the event's innermost target takes typed text or has its own use for keys, or lies in
 * something open.
 */
export function is_for_field(event: KeyboardEvent): boolean {
  const path = event.composedPath(); // across shadow roots, which closest() does not leave
  const [target] = path;
  if (!(target instanceof HTMLElement)) return false;
  if (path.some((each) => each instanceof HTMLElement && each.matches("dialog, [popover]")))
    return true;
  if (target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement) return true;
  if (target instanceof HTMLInputElement)
    return target.type !== "range" || event.key.startsWith("Arrow");
  return target.getAttribute("role") === "separator" || target.isContentEditable;
}

/** Does what the key stands for; false when it stands for nothing here. */
export function handle_key(
  event: KeyboardEvent,
  session: ModelSession,
  show: (dialog: "help" | "figure") => void,
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
  const tool = kTools[key.toLowerCase()];
  if (tool) {
    session.choose_tool(tool);
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
      if (!session.together.followed) return session.comments.close();
      session.together.stop_following();
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
      session.view.fit();
      return true;
    case "p":
    case "P":
      session.view.set_perspective(true);
      return true;
    case "o":
    case "O":
      session.view.set_perspective(false);
      return true;
    case "[":
    case "]":
      session.painting.set_brush((brush) => brush.step_width(key === "]" ? 1 : -1));
      return true;
    case "k":
    case "K":
      session.appearance.next_light();
      return true;
    case "x":
    case "X":
      session.appearance.next_section();
      return true;
    case "n":
    case "N":
      session.views.step(event.shiftKey ? -1 : 1);
      return true;
    case "t":
    case "T":
      session.toggle_table();
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
  session.view.standard_view(view);
  return true;
}

/** Where an arrow key leads from the choice `at` of `count`; null for other keys. */
export function arrow_step(key: string, at: number, count: number): number | null {
  const step = { ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1 }[key];
  return step === undefined || count === 0 ? null : (at + step + count) % count;
}

/** The innermost element that takes keys; null: none in particular. */
export function has_keyboard(): HTMLElement | null {
  let active = document.activeElement;
  while (active?.shadowRoot?.activeElement) active = active.shadowRoot.activeElement;
  return active instanceof HTMLElement && active !== document.body ? active : null;
}
