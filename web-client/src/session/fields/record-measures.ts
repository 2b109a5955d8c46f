// Measures of a record on the model, in addition to its columns: area, length of lines, number of
// points.

import { formatCount } from "../../core/locale";
import { markColumns } from "../../domain/marks";
import { formatArea, formatLength } from "../../domain/measure";
import type { Table, TableRecord } from "../../core/protocol.gen";
import { texts } from "../../texts";

export interface RecordMeasure {
  /** The server's name, which also sorts records. */
  name: "area_m2" | "length_m" | "point_count";
  label: string;
  /** Empty where the record has none. */
  text(record: TableRecord): string;
}

/** The measures that the table's records can have, in the server's order. */
export function measuresOf(table: Pick<Table, "columns">): RecordMeasure[] {
  const words = texts.tables;
  const area: RecordMeasure = {
    name: "area_m2",
    label: words.area,
    text: ({ area_m2: areaM2 }) => (areaM2 ? formatArea(areaM2) : ""),
  };
  const length: RecordMeasure = {
    name: "length_m",
    label: words.length,
    text: ({ length_m: lengthM }) => (lengthM ? formatLength(lengthM) : ""),
  };
  const points: RecordMeasure = {
    name: "point_count",
    label: words.points,
    text: ({ point_count: pointCount }) => (pointCount ? formatCount(pointCount) : ""),
  };
  return [
    area,
    markColumns(table, "line").length > 0 ? length : [],
    markColumns(table, "point").length > 0 ? points : [],
  ].flat();
}
