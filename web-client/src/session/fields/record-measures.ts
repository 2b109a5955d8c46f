// Measures of a record on the model, in addition to its columns: its area, the length of its lines,
// and the number of points.

import { formatCount } from "../../core/locale";
import { markColumns } from "../../domain/marks";
import { formatArea, formatLength } from "../../domain/measure";
import type { Table, TableRecord } from "../../core/protocol.gen";
import { texts } from "../../texts";

export interface RecordMeasure {
  /** The server's name of the measure, by which records can also be sorted. */
  name: "area_m2" | "length_m" | "point_count";
  label: string;
  /** Returns the measure as text. It is empty if the record has no such measure. */
  text(record: TableRecord): string;
}

/** Returns the measures that records of the table can have, in the server's order. */
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
