// Measured figures: what there is to choose of one, and what the server is asked for. What is shown
// on the model is a view's matter, or the person's own.

import { readNumber, typedNumber } from "../core/locale";
import type {
  FigureDirection,
  FigureFormat,
  FigureLabels,
  FigureRequest,
  Point3,
} from "../core/protocol.gen";
import type { ViewContent } from "./views";

export const kDirections: readonly FigureDirection[] = [
  "top",
  "bottom",
  "front",
  "back",
  "left",
  "right",
];
export const kFormats: readonly FigureFormat[] = ["pdf", "svg", "png", "tiff"];
export const kPapers = ["a5", "a4", "a3"] as const;
export const kOrientations = ["portrait", "landscape"] as const;
/** 5 is 1 : 5. */
export const kScales: readonly number[] = [1, 2, 2.5, 5, 10, 20, 25, 50, 100, 200, 250, 500];
export const kResolutions: readonly number[] = [150, 300, 600];
export const kScaleRange = { least: 0.01, most: 1_000_000 };
export const kDpiRange = { least: 50, most: 600 };
/** Pixels an inch at which a sheet is some 700 pixels wide: enough to judge it by. */
const kPreviewDpi = { a5: 100, a4: 80, a3: 60 };

export type Paper = (typeof kPapers)[number];
export type Orientation = (typeof kOrientations)[number];
/** As the person or the named view sees it, along an axis, or square to a face that is picked. */
export type FigureFrom = "camera" | FigureDirection | "face";

/** What is chosen for one figure after the other. */
export interface FigureChoices {
  from: FigureFrom;
  scale: number | null; // null: the largest at which all of it is on the sheet
  paper: Paper;
  orientation: Orientation | null; // null: the one with room for the larger scale
  dpi: number;
  format: FigureFormat;
  legend: boolean;
}

/** What is written on the sheet; empty: as the server has it. */
export interface FigureWords {
  title: string;
  caption: string;
  credit: string;
}

/** A place of the surface that is to be seen square, world. */
export interface Face {
  center: Point3;
  normal: Point3;
}

/** Camera, layers, looks and light, or a named view that has them. */
export type FigureShown = ViewContent | { view: string };

export const usualFigure = (): FigureChoices => ({
  from: "camera",
  scale: null,
  paper: "a4",
  orientation: null,
  dpi: 300,
  format: "pdf",
  legend: true,
});

export const isScale = (value: unknown): value is number =>
  typeof value === "number" && value >= kScaleRange.least && value <= kScaleRange.most;
export const isDpi = (value: unknown): value is number =>
  Number.isInteger(value) &&
  (value as number) >= kDpiRange.least &&
  (value as number) <= kDpiRange.most;

/**
 * What a browser kept, which may be of another version of the page, or anybody's: what is no choice
 * is the usual one.
 */
export function figureChoices(kept: unknown): FigureChoices {
  const usual = usualFigure();
  const known = (typeof kept === "object" && kept !== null ? kept : {}) as Record<string, unknown>;
  const oneOf = <T>(value: unknown, choices: readonly T[], otherwise: T): T =>
    choices.includes(value as T) ? (value as T) : otherwise;
  return {
    from: oneOf<FigureFrom>(known["from"], ["camera", ...kDirections, "face"], usual.from),
    scale: isScale(known["scale"]) ? known["scale"] : usual.scale,
    paper: oneOf(known["paper"], kPapers, usual.paper),
    orientation: oneOf(known["orientation"], [null, ...kOrientations], usual.orientation),
    dpi: isDpi(known["dpi"]) ? known["dpi"] : usual.dpi,
    format: oneOf(known["format"], kFormats, usual.format),
    legend: oneOf(known["legend"], [true, false], usual.legend),
  };
}

/** What is asked for; null: a face is still to be picked. */
export function figureRequest(
  shown: FigureShown,
  { from, scale, orientation, ...choices }: FigureChoices,
  words: FigureWords,
  face: Face | null,
  labels: FigureLabels | null,
): FigureRequest | null {
  if (from === "face" && !face) return null;
  const direction = from === "face" ? face! : from === "camera" ? {} : { direction: from };
  const written = Object.entries(words).flatMap(([name, text]) =>
    text.trim() === "" ? [] : [[name, text.trim()]],
  );
  return {
    ...shown,
    ...direction,
    ...choices,
    ...(scale === null ? {} : { scale }),
    ...(orientation === null ? {} : { orientation }),
    ...(Object.fromEntries(written) as Partial<FigureWords>),
    ...(labels ? { labels } : {}),
  };
}

/** The same sheet as a small picture. */
export const previewRequest = (request: FigureRequest): FigureRequest => ({
  ...request,
  format: "png",
  dpi: kPreviewDpi[request.paper ?? "a4"],
});

/** A scale as people write it, "1 : 40", "2:1" or the 40 alone; NaN where it is none. */
export function readScale(typed: string): number {
  const parts = typed.split(":").map(readNumber);
  const [onPaper, inWorld] = parts.length === 1 ? [1, parts[0]!] : [parts[0]!, parts[1]!];
  const scale = parts.length > 2 || !(onPaper > 0 && inWorld > 0) ? Number.NaN : inWorld / onPaper;
  return isScale(scale) ? scale : Number.NaN;
}

/** "1 : 40", "2 : 1". */
export function scaleText(scale: number): string {
  const number = (value: number): string => typedNumber(Number(value.toPrecision(6)));
  return scale < 1 ? `${number(1 / scale)} : 1` : `1 : ${number(scale)}`;
}
