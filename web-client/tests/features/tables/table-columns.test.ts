import { describe, expect, it } from "vitest";
import { TableColumns } from "../../../src/features/tables/table-columns";
import type { Column, Table } from "../../../src/core/protocol.gen";

const column = (slug: string, kind: Column["kind"]): Column => ({ slug, kind }) as Column;
const table = { columns: [column("name", "text"), column("old", "boolean")] } as Table;

describe("the columns of a table", () => {
  it("are as wide as what they hold takes, in words as large as they are", () => {
    const columns = new TableColumns();
    const usual = columns.edges(table);
    expect(usual.slice(0, 3)).toEqual([92, 92 + 190, 92 + 190 + 110]);
    columns.growth = 2;
    expect(columns.edges(table)).toEqual(usual.map((edge) => edge * 2));
  });

  it("stay as they were dragged, but never so narrow that they are lost", () => {
    const columns = new TableColumns();
    columns.drag("name", 300.4);
    columns.drag("old", 3);
    expect([columns.widthOf(table.columns[0]!), columns.widthOf(table.columns[1]!)]).toEqual([
      300, 56,
    ]);
    columns.growth = 2;
    expect(columns.widthOf(table.columns[0]!)).toBe(300);
  });
});
