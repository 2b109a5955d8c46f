// One command of a model's page: for keys, the help and the command palette.

import type { IconName } from "../ui/icons";

export interface Command {
  readonly id: string;
  /** Its part of the page, in this person's language. */
  readonly group: string;
  readonly title: string;
  /** As `ui/keys/command-keys` writes them. */
  readonly keys?: readonly string[];
  /** The first key, as caps. */
  readonly caps?: readonly string[];
  readonly glyph?: IconName;
  /** Why it is not possible now. Its key shows the reason, or does nothing. */
  readonly problem?: string | undefined;
  /** It makes sense only with its key. */
  readonly isKeyOnly?: boolean;
  /** Returns false if it had nothing to do. */
  run(key: string): boolean | void;
}
