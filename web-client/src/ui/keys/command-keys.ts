// The keys of the page's commands. They are defined only in this file. A key is written as
// "Ctrl+Shift+Z", with capital letters. `shell/commands` defines the actions of the commands.

import { texts } from "../../texts";

export const kCommandKeys = {
  "tool.orbit": ["V"],
  "tool.pan": ["H"],
  "tool.brush": ["B"],
  "tool.eraser": ["E"],
  "tool.polygon": ["A"],
  "tool.lasso": ["L"],
  "tool.strokes": ["Shift+L"],
  "polygon.snap": ["Shift+A"],
  "tool.bucket": ["G"],
  "tool.wand": ["Shift+G"],
  "tool.line": ["D"],
  "tool.point": ["S"],
  "tool.pick": ["I"],
  "tool.measure": ["M"],
  "tool.comment": ["C"],
  undo: ["Ctrl+Z"],
  redo: ["Ctrl+Shift+Z"],
  "brush.narrower": ["["],
  "brush.wider": ["]"],
  "view.orbit": ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"],
  "view.pan": ["Shift+ArrowLeft", "Shift+ArrowRight", "Shift+ArrowUp", "Shift+ArrowDown"],
  "view.zoom_in": ["+", "="],
  "view.zoom_out": ["-", "_"],
  "view.fit": ["Home"],
  "view.first": ["Shift+Home"],
  "view.front": ["1"],
  "view.back": ["2"],
  "view.left": ["3"],
  "view.right": ["4"],
  "view.top": ["5"],
  "view.bottom": ["6"],
  "view.perspective": ["P"],
  "view.orthographic": ["O"],
  "light.next": ["K"],
  "section.next": ["X"],
  "views.next": ["N"],
  "views.previous": ["Shift+N"],
  "tab.layers": ["Y"],
  "tab.records": ["R"],
  "tab.view": ["W"],
  "tab.comments": ["J"],
  "tab.activity": ["U"],
  panel: ["Q"],
  table: ["T"],
  past: ["Z"],
  figure: ["F"],
  commands: ["Ctrl+K"],
  help: ["?"],
  escape: ["Escape"],
} as const satisfies Record<string, readonly string[]>;

export type KeyedCommand = keyof typeof kCommandKeys;

const onMac = (): boolean => globalThis.navigator?.platform?.startsWith("Mac") ?? false;

/** Returns the key caps of a key, with the key names in the user's language. */
function capsOf(key: string): string[] {
  const names: Readonly<Record<string, string>> = texts.help.key_caps;
  return key.split(/\+(?=.)/).map((part) => {
    if (part === "Ctrl" && onMac()) return "⌘";
    return names[part.startsWith("Arrow") ? "Arrows" : part] ?? part.replace("-", "−");
  });
}

/** Returns the key caps of the command's first key. */
export const keyCapsOf = (command: KeyedCommand): string[] => capsOf(kCommandKeys[command][0]);

/** Returns a title with the command's key, for tooltips. */
export const withKey = (title: string, command: KeyedCommand): string =>
  `${title} (${keyCapsOf(command).join(" + ")})`;
