// The interface of tools. A tool handles the left button, the pen or one finger on the stage.

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
  | "strokes"
  | "wand"
  | "pick"
  | "line"
  | "point"
  | "comment"
  | "measure"
  | "face"
  | "part";

/** The tools of the tool rail, in their order. */
export const kRailTools: readonly Exclude<ToolName, "face" | "part">[] = [
  "orbit",
  "pan",
  "brush",
  "eraser",
  "polygon",
  "lasso",
  "strokes",
  "bucket",
  "wand",
  "line",
  "point",
  "pick",
  "measure",
  "comment",
];
/** Tools that add marks to a record of the layer's table. */
export const kMarkingTools: readonly ToolName[] = ["line", "point"];
/** Tools that can follow edges in the picture. */
export const kSnappingTools: readonly ToolName[] = ["polygon", "lasso", "line"];
/** Tools that select a part of the surface. */
export const kSelectingTools: readonly ToolName[] = ["polygon", "lasso", "strokes", "wand"];
/** Tools that keep the selection: tools that select, and tools that only look at the model. */
export const kSelectionKeepingTools: readonly ToolName[] = [
  ...kSelectingTools,
  "orbit",
  "pan",
  "pick",
  "measure",
];
/** Tools that change the content of a layer. */
export const kPaintingTools: readonly ToolName[] = [
  "brush",
  "eraser",
  "polygon",
  "lasso",
  "strokes",
  "bucket",
  "wand",
  ...kMarkingTools,
];
/** Tools for users with more rights than a viewer. */
export const kChangingTools: readonly ToolName[] = [...kPaintingTools, "comment"];

export interface Tool {
  readonly name: ToolName;
  activate(): void;
  deactivate(): void;
  down(sample: PointerSample): void;
  move(samples: PointerSample[]): void;
  up(): void;
  /** Cancels the action that `down` began. */
  cancel(): void;
  /** The pointer moves without a pressed button. Null means that it has left the stage. */
  hover?(sample: PointerSample | null): void;
  /** Handles a key. Returns false if the tool does not use the key at the moment. */
  key?(key: string, shift?: boolean): boolean;
  /** The current drawing. */
  readonly outline?: Outline | null;
}

/** A drawing over the frame. */
export interface Outline {
  points: readonly Point[];
  /** The points that were set click by click. */
  corners: readonly Point[];
  /** The place of a click at the pointer, if a segment leads to it. */
  pointer: Point | null;
  /** The points between the last point and the pointer, if this segment follows an edge. */
  edge?: readonly Point[];
  /** Whether a click on the first point closes the outline. */
  closable: boolean;
  /** Whether the drawing encloses an area. Otherwise it is a line. */
  area: boolean;
}

/** Whether the side panel shows options of the tool, above the layers. */
export const hasOptions = (tool: ToolName): boolean =>
  kPaintingTools.includes(tool) || tool === "measure";
