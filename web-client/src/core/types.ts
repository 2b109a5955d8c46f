// The generated types of the protocol, with the page's additions.

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

/** A problem according to RFC 9457, with the invalid field. */
export interface ProblemBody {
  status: number;
  title: string;
  detail?: string;
  field?: string;
  // Members for a mistake in an expression: its position and length in characters (code points),
  // possible corrections, and the kind of mistake.
  offset?: number;
  length?: number;
  suggestions?: string[];
  reason?: string;
  rows?: wire.RecordsReport; // only for requests with many records
}

/** Fills in absent members of a palette. `min` and `max` default to the outer points. */
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

/** All roles. Each role includes the rights of the previous ones. */
export const kRoles: readonly wire.Role[] = [
  "guest",
  "viewer",
  "annotator",
  "curator",
  "administrator",
  "owner",
];
/** The roles in a project, the lowest first. */
export const kProjectRoles: readonly wire.ProjectRole[] = ["viewer", "annotator", "curator"];

/**
 * Whether the role may download a model's scan and other files with the full quality of the scan.
 */
export const mayDownload = (
  role: wire.Role,
  { source_download: sourceDownload }: Pick<wire.Model, "source_download">,
): boolean => kRoles.indexOf(role) >= kRoles.indexOf(sourceDownload);
/** Whether the role may change the values of layers. */
export const mayPaint = (role: wire.Role): boolean =>
  kRoles.indexOf(role) >= kRoles.indexOf("annotator");
/** Whether the role may create, rename and delete layers and models. */
export const mayCurate = (role: wire.Role): boolean =>
  kRoles.indexOf(role) >= kRoles.indexOf("curator");
/**
 * Whether the layer still has its computed values. They cannot be changed until a user unlocks the
 * layer for manual editing.
 */
export const isAsComputed = ({
  computed,
  locked,
  edited_by_hand: editedByHand,
}: Pick<wire.Layer, "computed" | "locked" | "edited_by_hand">): boolean =>
  computed !== undefined && locked && editedByHand !== true;
/** Whether the role may invite users and set their roles. */
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
