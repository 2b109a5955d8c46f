// Problems of a figure, and the dialog's fields that show them.

import { readNumber } from "../../core/locale";
import type { ProblemBody } from "../../core/types";
import { isDpi, kDpiRange, readScale } from "../../domain/figures";
import { texts } from "../../texts";

const words = texts.figures;

/** `field` is empty if the dialog has no field for the problem. */
export interface FieldProblem {
  field: string;
  text: string;
}

/** Maps a member of the request to the dialog's field. */
const kFieldOf: Readonly<Record<string, string>> = {
  direction: "from",
  normal: "from",
  center: "from",
  camera: "from",
  view: "from",
  rollout: "from",
  tolerance_mm: "areas",
};
const kFields: readonly string[] = [
  "views",
  "from",
  "scale",
  "paper",
  "orientation",
  "dpi",
  "format",
  "areas",
  "title",
  "caption",
  "credit",
  "title_block",
  "labels",
];

/** Returns the field for a problem that the server reported. */
export function fieldProblem({ field = "", title, detail }: ProblemBody): FieldProblem {
  const part = field.split(/[.[]/)[0]!;
  const own = kFieldOf[part] ?? part;
  return { field: kFields.includes(own) ? own : "", text: detail ?? title };
}

/** Returns the problem of a typed scale or resolution that is invalid, or null. */
export function typingProblem(scale: string | null, dpi: string | null): FieldProblem | null {
  if (scale !== null && Number.isNaN(readScale(scale)))
    return { field: "scale", text: words.wrong_scale };
  return dpi !== null && !isDpi(readNumber(dpi))
    ? { field: "dpi", text: words.wrong_dpi(kDpiRange.least, kDpiRange.most) }
    : null;
}
