// A command of the model page, for keys, the help and the command palette.

import type { IconName } from "../ui/icons";

export interface Command {
  readonly id: string;
  /** The group of the command in the help, in the user's language. */
  readonly group: string;
  readonly title: string;
  /** The keys, in the notation of `ui/keys/command-keys`. */
  readonly keys?: readonly string[];
  /** The key caps of the first key. */
  readonly caps?: readonly string[];
  readonly glyph?: IconName;
  /**
   * The reason why the command is unavailable. The key of the command shows the reason or has no
   * effect.
   */
  readonly problem?: string | undefined;
  /** Whether the command is useful only with its key. */
  readonly isKeyOnly?: boolean;
  /** Runs the command. Returns false if the command had no effect. */
  run(key: string): boolean | void;
}
