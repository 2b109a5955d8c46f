// Column widths of a table. They depend on the kind of the values until a user drags the edges.

import type { Column, Table } from "../../core/protocol.gen";
import { measuresOf } from "../../session/fields/record-measures";

const kKeyWidth = 92;
const kMeasureWidth = 110;
const kWidths: Partial<Record<Column["kind"], number>> = {
  text: 190,
  numeric: 126,
  integer: 120,
  boolean: 110,
  date: 126,
  timestamp: 200,
  url: 200,
  relation: 190,
};
const kUsualWidth = 150;
const kLeastWidth = 56;

export class TableColumns {
  /** The ratio of the text size to the default. */
  growth = 1;
  private readonly _dragged = new Map<string, number>();

  widthOf({ slug, kind }: Pick<Column, "slug" | "kind">): number {
    return this._dragged.get(slug) ?? (kWidths[kind] ?? kUsualWidth) * this.growth;
  }

  /**
   * Returns the left edges of the columns and of the measures, then the right edge of the last one.
   */
  edges(table: Table): number[] {
    const edges = [this._dragged.get("key") ?? kKeyWidth * this.growth];
    const widths = [
      ...table.columns.map((column) => this.widthOf(column)),
      ...measuresOf(table).map(
        ({ name }) => this._dragged.get(name) ?? kMeasureWidth * this.growth,
      ),
    ];
    for (const width of widths) edges.push(edges[edges.length - 1]! + width);
    return edges;
  }

  drag(name: string, width: number): void {
    this._dragged.set(name, Math.max(kLeastWidth, Math.round(width)));
  }
}
