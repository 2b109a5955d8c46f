// Handles keys of the model page. Keys for a field or an open dialog are excluded (`ui/keyboard`).

import { keyCommands } from "./commands";
import type { PageHost } from "./open-dialog";

/**
 * Returns the key in the notation of `ui/keys/command-keys`, or null for a shortcut of the browser.
 */
export function keyOf(event: KeyboardEvent): string | null {
  const { key } = event;
  const name = key.length === 1 ? key.toUpperCase() : key;
  const shift = event.shiftKey ? "Shift+" : "";
  // AltGr, which Windows reports as Ctrl + Alt, types brackets on many keyboards.
  if (event.getModifierState("AltGraph")) return `${shift}${name}`;
  if (event.altKey) return null;
  return `${event.ctrlKey || event.metaKey ? "Ctrl+" : ""}${shift}${name}`;
}

/** Whether the key opens the list of commands. This key also works in fields. */
export const opensCommands = (event: KeyboardEvent): boolean => keyOf(event) === "Ctrl+K";

/** Runs the command of the key. Returns false if the key has no command. */
export function handleKey(event: KeyboardEvent, host: PageHost): boolean {
  const key = keyOf(event);
  if (key === null) return false;
  const isPlain = !key.startsWith("Ctrl+");
  if (isPlain && host.session.tools.key(event.key, event.shiftKey)) return true;
  const commands = keyCommands(host);
  const run = (name: string): boolean | null => {
    const found = commands.find(({ keys }) => keys?.includes(name));
    return found ? found.run(name) !== false : null;
  };
  // On most keyboards, "?" and "+" require Shift. For letters, Shift makes no difference.
  return run(key) ?? (isPlain ? run(key.replace("Shift+", "")) : null) ?? false;
}
