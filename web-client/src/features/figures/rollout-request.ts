// The input of the dialogs for rollouts as a request.

import { readNumber, typedNumber } from "../../core/locale";
import type {
  FigureRollout,
  LayerOverride,
  LookShown,
  Point3,
  RolloutRequest,
  RolloutShape,
  RolloutSide,
} from "../../core/protocol.gen";
import type { Model } from "../../core/types";
import { centre, kFrames } from "../../math/camera";

export type TypedPoint = readonly [string, string, string];

/** The fields as typed. */
export interface RolloutInput {
  side: RolloutSide | "auto";
  shape: RolloutShape | "auto";
  /** `vertical`: through the middle of the model, in its up direction. `own`: the typed axis. */
  axis: "auto" | "vertical" | "own";
  point: TypedPoint;
  direction: TypedPoint;
  cut: string;
  pixel: string;
  relief: boolean;
}
export type RolloutField = "point" | "direction" | "cut" | "pixel";

const kNothing: TypedPoint = ["", "", ""];
export const kNewRollout: RolloutInput = {
  side: "auto",
  shape: "auto",
  axis: "auto",
  point: kNothing,
  direction: kNothing,
  cut: "",
  pixel: "",
  relief: true,
};

const numbersOf = (typed: TypedPoint): Point3 => [
  readNumber(typed[0]),
  readNumber(typed[1]),
  readNumber(typed[2]),
];

/** Returns the first field whose number is invalid, or null. */
export function wrongField({
  axis,
  point,
  direction,
  cut,
  pixel,
}: RolloutInput): RolloutField | null {
  if (axis === "own" && !numbersOf(point).every(Number.isFinite)) return "point";
  const length = Math.hypot(...numbersOf(direction));
  if (axis === "own" && !(length > 0 && Number.isFinite(length))) return "direction";
  if (cut.trim() !== "" && !(Math.abs(readNumber(cut)) <= 360)) return "cut";
  if (pixel.trim() !== "" && !(readNumber(pixel) > 0)) return "pixel";
  return null;
}

/** As wrongField(), for a figure, which has no width of a pixel. */
export const wrongSurface = (input: RolloutInput): RolloutField | null =>
  wrongField({ ...input, pixel: "" });

/** Returns the input with the vertical axis in its empty fields, so users only change a part. */
export function withAxisFields(
  input: RolloutInput,
  { bounds, up }: Pick<Model, "bounds" | "up">,
): RolloutInput {
  const typed = ([x, y, z]: readonly number[]): TypedPoint => [
    typedNumber(Number(x!.toPrecision(6))),
    typedNumber(Number(y!.toPrecision(6))),
    typedNumber(Number(z!.toPrecision(6))),
  ];
  const isEmpty = (point: TypedPoint): boolean => point.every((part) => part.trim() === "");
  return {
    ...input,
    point: isEmpty(input.point) ? typed(centre(bounds)) : input.point,
    direction: isEmpty(input.direction) ? typed(kFrames[up].up) : input.direction,
  };
}

/** Returns the surface and its shading. The input must be valid. */
export function rolloutOf(
  { side, shape, axis, point, direction, cut, relief }: RolloutInput,
  { bounds, up }: Pick<Model, "bounds" | "up">,
): FigureRollout {
  const own = { point: numbersOf(point), direction: numbersOf(direction) };
  const vertical = { point: toPoint(centre(bounds)), direction: toPoint(kFrames[up].up) };
  return {
    ...(axis === "auto" ? {} : { axis: axis === "own" ? own : vertical }),
    ...(side === "auto" ? {} : { side }),
    ...(shape === "auto" ? {} : { shape }),
    ...(cut.trim() === "" ? {} : { cut: readNumber(cut) }),
    relief,
  };
}

const toPoint = ([x, y, z]: readonly [number, number, number]): Point3 => [x, y, z];

/** The input must be valid. */
export function rolloutRequest(
  input: RolloutInput,
  model: Pick<Model, "bounds" | "up">,
  shown: { layers?: LayerOverride[]; looks?: LookShown[] },
): RolloutRequest {
  return {
    ...rolloutOf(input, model),
    ...(input.pixel.trim() === "" ? {} : { mm_per_pixel: readNumber(input.pixel) }),
    ...(shown.layers ? { layers: shown.layers } : {}),
    ...(shown.looks ? { looks: shown.looks } : {}),
  };
}

const kPreviewPixels = 800; // on the longer side

/**
 * Returns a request for a small picture of the same sheet. With `zoom`, the picture has more pixels
 * by this factor.
 */
export function previewOf(
  request: RolloutRequest,
  sheet: { width: number; height: number; mm_per_pixel: number },
  zoom = 1,
): RolloutRequest & { mm_per_pixel: number } {
  const coarser = Math.max(sheet.width, sheet.height) / kPreviewPixels;
  return { ...request, mm_per_pixel: (sheet.mm_per_pixel * Math.max(1, coarser)) / zoom };
}
