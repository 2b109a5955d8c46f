// What is wrong with a figure, and at which field of its dialog that is said.

import { readNumber } from "../../core/locale";
import type { ProblemBody } from "../../core/types";
import { isDpi, kDpiRange, readScale } from "../../domain/figures";
import { texts } from "../../texts";

const words = texts.figures;

/** `field` is empty where the dialog has none for it. */
export interface FieldProblem {
  field: string;
  text: string;
}

/** Which of the dialog's fields a part of the request is chosen in. */
const kFieldOf: Readonly<Record<string, string>> = {
  direction: "from",
  normal: "from",
  center: "from",
  camera: "from",
  view: "from",
};
const kFields: readonly string[] = [
  "from",
  "scale",
  "paper",
  "orientation",
  "dpi",
  "format",
  "title",
  "caption",
  "credit",
  "labels",
];

/** Of the server. */
export function fieldProblem({ field = "", title, detail }: ProblemBody): FieldProblem {
  const part = field.split(/[.[]/)[0]!;
  const own = kFieldOf[part] ?? part;
  return { field: kFields.includes(own) ? own : "", text: detail ?? title };
}

/** What was typed is none of the choices of its field; null: nothing was typed there. */
export function typingProblem(scale: string | null, dpi: string | null): FieldProblem | null {
  if (scale !== null && Number.isNaN(readScale(scale)))
    return { field: "scale", text: words.wrong_scale };
  return dpi !== null && !isDpi(readNumber(dpi))
    ? { field: "dpi", text: words.wrong_dpi(kDpiRange.least, kDpiRange.most) }
    : null;
}
