// A tool handles the left button, the pen or one finger on the stage.

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
  | "face"
  | "part";

/** The tools of the tool rail, in its order. */
export const kRailTools: readonly Exclude<ToolName, "face" | "part">[] = [
  "orbit",
  "pan",
  "brush",
  "eraser",
  "polygon",
  "lasso",
  "bucket",
  "line",
  "point",
  "pick",
  "measure",
  "comment",
];
/** Tools that add to a record of the layer's table. */
export const kMarkingTools: readonly ToolName[] = ["line", "point"];
/** Tools during which a selected area stays: those that select, and those that look. */
export const kSelectingTools: readonly ToolName[] = [
  "polygon",
  "lasso",
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
  "bucket",
  ...kMarkingTools,
];
/** Tools for people with more rights than a viewer. */
export const kChangingTools: readonly ToolName[] = [...kPaintingTools, "comment"];

export interface Tool {
  readonly name: ToolName;
  activate(): void;
  deactivate(): void;
  down(sample: PointerSample): void;
  move(samples: PointerSample[]): void;
  up(): void;
  /** Ends the action of `down` without finishing it. */
  cancel(): void;
  /** The pointer moves without a pressed button; null: it left. */
  hover?(sample: PointerSample | null): void;
  /** Returns false if the tool does not use the key now. */
  key?(key: string): boolean;
  /** The current drawing. */
  readonly outline?: Outline | null;
}

/** A drawing over the picture. */
export interface Outline {
  points: readonly Point[];
  /** Points that were clicked one by one. */
  corners: readonly Point[];
  /** The pointer's position, if a segment leads to it. */
  pointer: Point | null;
  /** A click at the first point closes it. */
  closable: boolean;
  /** Whether it encloses an area; otherwise it is a line. */
  area: boolean;
}

/** Whether the side panel has options of the tool, at the top of the layers. */
export const hasOptions = (tool: ToolName): boolean =>
  kPaintingTools.includes(tool) || tool === "measure";
