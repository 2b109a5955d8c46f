// Figures to scale: the options of a figure and the request to the server. A figure shows a saved
// view or the user's current view.

import { readNumber, typedNumber } from "../core/locale";
import type {
  FigureDimension,
  FigureDirection,
  FigureFormat,
  FigureLabels,
  FigureRequest,
  FigureRollout,
  FigureView,
  Point3,
} from "../core/protocol.gen";
import { keptBlockTexts, titleBlock, type BlockTexts, type KeptBlockTexts } from "./figure-block";
import { kFewestViews, kViewsChoices, type ViewsChoice } from "./figure-views";
import type { Vec3 } from "../math/vector";
import type { ViewContent } from "./views";

export const kDirections: readonly FigureDirection[] = [
  "top",
  "bottom",
  "front",
  "back",
  "left",
  "right",
];
export const kFormats: readonly FigureFormat[] = ["pdf", "svg", "dxf", "png", "tiff"];
/** How layers of classes and of records are drawn. */
export const kAreas = ["pixels", "outlines"] as const;
/** The offered tolerances of outlines, in millimeters on paper. */
export const kTolerances: readonly number[] = [0.05, 0.1, 0.2, 0.5, 1];
export const kPapers = ["a5", "a4", "a3"] as const;
export const kOrientations = ["portrait", "landscape"] as const;
/** The offered scales. 5 means 1 : 5. */
export const kScales: readonly number[] = [1, 2, 2.5, 5, 10, 20, 25, 50, 100, 200, 250, 500];
export const kResolutions: readonly number[] = [150, 300, 600];
export const kScaleRange = { least: 0.01, most: 1_000_000 };
export const kDpiRange = { least: 50, most: 600 };
/** The resolution in dots per inch at which a sheet is about 700 pixels wide, for the preview. */
const kPreviewDpi = { a5: 100, a4: 80, a3: 60 };

export type Paper = (typeof kPapers)[number];
export type Areas = (typeof kAreas)[number];
export type Orientation = (typeof kOrientations)[number];
/**
 * The direction of a figure: the camera of the current or saved view, an axis, or the normal of a
 * picked face. A rollout has all directions around an axis.
 */
export type FigureFrom = "camera" | FigureDirection | "face" | "rollout";
export const kFigureFrom: readonly FigureFrom[] = ["camera", ...kDirections, "face", "rollout"];

/** Options that are kept from one figure to the next. */
export interface FigureChoices {
  /** Several views on the sheet have their own directions instead of `from`. */
  views: ViewsChoice;
  from: FigureFrom;
  scale: number | null; // null for the largest scale that fits the sheet
  paper: Paper;
  orientation: Orientation | null; // null for the orientation with the larger scale
  dpi: number;
  format: FigureFormat;
  areas: Areas;
  tolerance_mm: number;
  legend: boolean;
  dimensions: boolean;
  title_block: boolean;
  block_texts: KeptBlockTexts;
}

/** Texts on the sheet. If a text is empty, the server uses its default. */
export interface FigureWords {
  title: string;
  caption: string;
  credit: string;
}

/** A point on the surface that the figure shows from the front, in world coordinates. */
export interface Face {
  center: Point3;
  normal: Point3;
}

/** The camera, layers, surface images and light, or a saved view with them. */
export type FigureShown = ViewContent | { view: string };

export const usualFigure = (): FigureChoices => ({
  views: "one",
  from: "camera",
  scale: null,
  paper: "a4",
  orientation: null,
  dpi: 300,
  format: "pdf",
  areas: "pixels",
  tolerance_mm: 0.1,
  legend: true,
  dimensions: true,
  title_block: false,
  block_texts: keptBlockTexts(null),
});

export const isScale = (value: unknown): value is number =>
  typeof value === "number" && value >= kScaleRange.least && value <= kScaleRange.most;
export const isDpi = (value: unknown): value is number =>
  Number.isInteger(value) &&
  (value as number) >= kDpiRange.least &&
  (value as number) <= kDpiRange.most;

/**
 * Reads choices from the browser's storage. They may be invalid or from another version of the
 * page. The default replaces an invalid choice.
 */
export function figureChoices(kept: unknown): FigureChoices {
  const usual = usualFigure();
  const known = (typeof kept === "object" && kept !== null ? kept : {}) as Record<string, unknown>;
  const oneOf = <T>(value: unknown, choices: readonly T[], otherwise: T): T =>
    choices.includes(value as T) ? (value as T) : otherwise;
  return {
    views: oneOf(known["views"], kViewsChoices, usual.views),
    from: oneOf(known["from"], kFigureFrom, usual.from),
    scale: isScale(known["scale"]) ? known["scale"] : usual.scale,
    paper: oneOf(known["paper"], kPapers, usual.paper),
    orientation: oneOf(known["orientation"], [null, ...kOrientations], usual.orientation),
    dpi: isDpi(known["dpi"]) ? known["dpi"] : usual.dpi,
    format: oneOf(known["format"], kFormats, usual.format),
    areas: oneOf(known["areas"], kAreas, usual.areas),
    tolerance_mm: oneOf(known["tolerance_mm"], kTolerances, usual.tolerance_mm),
    legend: oneOf(known["legend"], [true, false], usual.legend),
    dimensions: oneOf(known["dimensions"], [true, false], usual.dimensions),
    title_block: oneOf(known["title_block"], [true, false], usual.title_block),
    block_texts: keptBlockTexts(known["block_texts"]),
  };
}

/** Returns whether the figure is a sheet with texts, a legend and a picture. */
export const hasSheet = ({ format }: FigureChoices): boolean => format !== "dxf";
/** Returns whether the sheet has several views. A drawing for CAD programs is a single one. */
export const hasViews = (choices: FigureChoices): boolean =>
  choices.views !== "one" && hasSheet(choices);
/** Returns whether the figure is a single rollout. */
export const isRollout = (choices: FigureChoices): boolean =>
  choices.from === "rollout" && !hasViews(choices);
/** Returns whether the figure can have dimensions. Several views have different planes. */
export const hasDimensions = (choices: FigureChoices): boolean =>
  !isRollout(choices) && !hasViews(choices);
/** Returns whether the user can choose between pixels and outlines. */
export const hasAreas = (choices: FigureChoices): boolean =>
  !isRollout(choices) && (choices.format === "pdf" || choices.format === "svg");
/** Returns whether the figure has outlines. A drawing for CAD programs always has them. */
export const hasOutlines = (choices: FigureChoices): boolean =>
  choices.format === "dxf" || (hasAreas(choices) && choices.areas === "outlines");

/** The parts of a request that not every figure has. */
export interface FigureParts {
  face?: Face | null;
  labels?: FigureLabels | null;
  rollout?: FigureRollout | null;
  block?: BlockTexts | null; // null for no title block
  views?: readonly FigureView[] | null; // null for a single view
  /** The points of a measurement. The distances between them become dimensions. */
  measured?: readonly Vec3[];
}

/** Returns the distances between successive points, without those of length 0. */
function dimensionsOf(points: readonly Vec3[]): FigureDimension[] {
  return points.slice(1).flatMap((to, index) => {
    const from = points[index]!;
    return from.every((value, axis) => value === to[axis])
      ? []
      : [{ from: [...from] as Point3, to: [...to] as Point3 }];
  });
}

/** Builds the request. Returns null without the required face, rollout or views. */
export function figureRequest(
  shown: FigureShown,
  chosen: FigureChoices,
  words: FigureWords,
  parts: FigureParts = {},
): FigureRequest | null {
  const { scale, paper, orientation, dpi, format, legend } = chosen;
  const { block } = parts;
  const content = contentOf(shown, chosen, parts);
  if (!content) return null;
  const written = Object.entries(words).flatMap(([name, text]) =>
    text.trim() === "" || !hasSheet(chosen) ? [] : [[name, text.trim()]],
  );
  return {
    ...content,
    paper,
    dpi,
    format,
    ...(hasSheet(chosen) ? { legend } : {}),
    ...(hasSheet(chosen) && block ? { title_block: titleBlock(block) } : {}),
    ...(scale === null ? {} : { scale }),
    ...(orientation === null ? {} : { orientation }),
    ...(hasAreas(chosen) && chosen.areas === "outlines" ? { areas: chosen.areas } : {}),
    ...(hasOutlines(chosen) ? { tolerance_mm: chosen.tolerance_mm } : {}),
    ...(Object.fromEntries(written) as Partial<FigureWords>),
  };
}

/** Returns what the figure shows and from where. A rollout has neither camera, light nor labels. */
function contentOf(
  shown: FigureShown,
  chosen: FigureChoices,
  { face, labels, rollout = null, views, measured = [] }: FigureParts,
): FigureRequest | null {
  const { from } = chosen;
  const named = labels ? { labels } : {};
  if (hasViews(chosen))
    return views && views.length >= kFewestViews ? { ...shown, ...named, views: [...views] } : null;
  if (from === "rollout") {
    if (!rollout || "view" in shown) return rollout && { ...shown, rollout };
    const { layers, looks } = shown;
    return { ...(layers ? { layers } : {}), ...(looks ? { looks } : {}), rollout };
  }
  if (from === "face" && !face) return null;
  const direction = from === "face" ? face! : from === "camera" ? {} : { direction: from };
  const dimensions = chosen.dimensions ? dimensionsOf(measured) : [];
  return {
    ...shown,
    ...direction,
    ...named,
    ...(dimensions.length > 0 ? { dimensions } : {}),
  };
}

/**
 * Requests the same sheet as a small image. For a drawing without a sheet, this is the same part of
 * the object.
 */
export function previewRequest(request: FigureRequest): FigureRequest {
  const bare = { legend: false, title: "", caption: "", credit: "" };
  const preview: FigureRequest = {
    ...request,
    ...(request.format === "dxf" ? bare : {}),
    format: "png",
    dpi: kPreviewDpi[request.paper ?? "a4"],
  };
  delete preview.areas;
  delete preview.tolerance_mm;
  return preview;
}

/** Parses a scale such as "1 : 40", "2:1" or 40. Returns NaN for any other text. */
export function readScale(typed: string): number {
  const parts = typed.split(":").map(readNumber);
  const [onPaper, inWorld] = parts.length === 1 ? [1, parts[0]!] : [parts[0]!, parts[1]!];
  const scale = parts.length > 2 || !(onPaper > 0 && inWorld > 0) ? Number.NaN : inWorld / onPaper;
  return isScale(scale) ? scale : Number.NaN;
}

/** Formats a scale, such as "1 : 40" or "2 : 1". */
export function scaleText(scale: number): string {
  const number = (value: number): string => typedNumber(Number(value.toPrecision(6)));
  return scale < 1 ? `${number(1 / scale)} : 1` : `1 : ${number(scale)}`;
}
