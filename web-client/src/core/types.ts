// The generated types of the protocol, with what the page needs to be complete.

import type * as wire from "./protocol.gen";

export type {
  Atlas,
  CellValue,
  CellValues,
  Column,
  ColumnKind,
  HistogramBin,
  Job,
  KeyStatistics,
  LayerCreate,
  LayerPatch,
  MapColor,
  MapColumn,
  MapContents,
  Me,
  Model,
  ModelPatch,
  PalettePoint,
  RecordsReport,
  Resolution,
  Role,
  ShapeRecipe,
  Statistics,
  Table,
  TableRecord,
  Transfer,
  TransferReport,
  Unit,
  VertexPropertyName,
  ValueType,
} from "./protocol.gen";

export interface Palette extends wire.Palette {
  min: number;
  max: number;
  points: wire.PalettePoint[];
}

export interface Layer extends wire.Layer {
  palette: Palette;
}

/** RFC 9457, with the field that is wrong. */
export interface ProblemBody {
  status: number;
  title: string;
  detail?: string;
  field?: string;
  offset?: number; // of an expression: the character that is wrong, from 0
  rows?: wire.RecordsReport; // of records in bulk
}

/** `min` and `max` default to the outer points. */
export function completePalette(palette: wire.Palette): Palette {
  const points = [...(palette.points ?? [])].sort((a, b) => a.at - b.at);
  return {
    ...palette,
    points,
    min: palette.min ?? points[0]?.at ?? 0,
    max: palette.max ?? points[points.length - 1]?.at ?? 1,
  };
}

export const completeLayer = (layer: wire.Layer): Layer => ({
  ...layer,
  palette: completePalette(layer.palette),
});

/** Each may do what the ones before may. */
export const kRoles: readonly wire.Role[] = [
  "guest",
  "viewer",
  "annotator",
  "curator",
  "administrator",
  "owner",
];
/** What people may be in one project, ascending. */
export const kProjectRoles: readonly wire.ProjectRole[] = ["viewer", "annotator", "curator"];

/** Who gets the files of a model's scan, and what is as good as they are. */
export const mayDownload = (
  role: wire.Role,
  { source_download: sourceDownload }: Pick<wire.Model, "source_download">,
): boolean => kRoles.indexOf(role) >= kRoles.indexOf(sourceDownload);
/** Who may change what layers hold. */
export const mayPaint = (role: wire.Role): boolean =>
  kRoles.indexOf(role) >= kRoles.indexOf("annotator");
/** Who may change what layers and models there are, and what they are called. */
export const mayCurate = (role: wire.Role): boolean =>
  kRoles.indexOf(role) >= kRoles.indexOf("curator");
/**
 * Its values are what was computed: nobody changes them until it is unlocked to be edited by hand.
 */
export const isAsComputed = ({
  computed,
  locked,
  edited_by_hand: editedByHand,
}: Pick<wire.Layer, "computed" | "locked" | "edited_by_hand">): boolean =>
  computed !== undefined && locked && editedByHand !== true;
/** Who may invite people, and say what they may do. */
export const mayAdminister = (role: wire.Role): boolean =>
  kRoles.indexOf(role) >= kRoles.indexOf("administrator");

const kRanges: Record<wire.ValueType, [number, number]> = {
  u8: [0, 255],
  u16: [0, 65535],
  u32: [0, 4294967295],
  i8: [-128, 127],
  i16: [-32768, 32767],
  i32: [-2147483648, 2147483647],
  f16: [-65504, 65504],
  f32: [-3.4028234663852886e38, 3.4028234663852886e38],
};

export const valueRange = (type: wire.ValueType): [number, number] => kRanges[type];
export const holdsFractions = (type: wire.ValueType): boolean => type === "f16" || type === "f32";
