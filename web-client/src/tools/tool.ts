// A tool is what the left button, the pen or one finger does on the stage.

import type { PointerSample } from "../ui/input";
import type { Point } from "../net/stroke";

export type ToolName =
  | "orbit"
  | "pan"
  | "brush"
  | "eraser"
  | "polygon"
  | "lasso"
  | "bucket"
  | "pick"
  | "line"
  | "point"
  | "comment"
  | "measure"
  | "face";

/** The tools of the rail, in its order, with the keys that choose them. */
export const kToolKeys: Readonly<Record<Exclude<ToolName, "face">, string>> = {
  orbit: "V",
  pan: "H",
  brush: "B",
  eraser: "E",
  polygon: "A",
  lasso: "L",
  bucket: "G",
  line: "D",
  point: "S",
  pick: "I",
  measure: "M",
  comment: "C",
};
/** Those that add to a record of the layer's table. */
export const kMarkingTools: readonly ToolName[] = ["line", "point"];
/** Those that change what a layer shows. */
export const kPaintingTools: readonly ToolName[] = [
  "brush",
  "eraser",
  "polygon",
  "lasso",
  "bucket",
  ...kMarkingTools,
];
/** Those of whoever may do more than look. */
export const kChangingTools: readonly ToolName[] = [...kPaintingTools, "comment"];

export interface Tool {
  readonly name: ToolName;
  activate(): void;
  deactivate(): void;
  down(sample: PointerSample): void;
  move(samples: PointerSample[]): void;
  up(): void;
  /** Ends what `down` began without finishing it. */
  cancel(): void;
  /** The pointer moves with nothing pressed; null: it left. */
  hover?(sample: PointerSample | null): void;
  /** False when the key means nothing to it now. */
  key?(key: string): boolean;
  /** What it has drawn so far. */
  readonly outline?: Outline | null;
}

/** What is drawn over the picture. */
export interface Outline {
  points: readonly Point[];
  /** Those that were pressed one by one. */
  corners: readonly Point[];
  /** Where the pointer is, if a line leads there. */
  pointer: Point | null;
  /** The next press at the first point closes it. */
  closable: boolean;
  /** It goes round an area; otherwise it is a line. */
  area: boolean;
}
