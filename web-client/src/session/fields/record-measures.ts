// What a record has on the model beside what its columns hold: surface, length of its lines, number
// of its points.

import { format_count } from "../../core/locale";
import { mark_columns } from "../../domain/marks";
import { format_area, format_length } from "../../domain/measure";
import type { Table, TableRecord } from "../../core/protocol.gen";
import { texts } from "../../texts";

export interface RecordMeasure {
  /** As the server calls it, and orders records by it. */
  name: "area_m2" | "length_m" | "point_count";
  label: string;
  /** Empty where the record has nothing of it. */
  text(record: TableRecord): string;
}

/** Those that the table's records can have, in the order of the server. */
export function measures_of(table: Pick<Table, "columns">): RecordMeasure[] {
  const words = texts.tables;
  const area: RecordMeasure = {
    name: "area_m2",
    label: words.area,
    text: ({ area_m2 }) => (area_m2 ? format_area(area_m2) : ""),
  };
  const length: RecordMeasure = {
    name: "length_m",
    label: words.length,
    text: ({ length_m }) => (length_m ? format_length(length_m) : ""),
  };
  const points: RecordMeasure = {
    name: "point_count",
    label: words.points,
    text: ({ point_count }) => (point_count ? format_count(point_count) : ""),
  };
  return [
    area,
    mark_columns(table, "line").length > 0 ? length : [],
    mark_columns(table, "point").length > 0 ? points : [],
  ].flat();
}
