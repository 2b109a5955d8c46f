import fc from "fast-check";
import { describe, expect, it } from "vitest";
import type { BillItem } from "../../src/core/protocol.gen";
import {
  bodyOf,
  decimalOf,
  draftOf,
  endOf,
  inserted,
  isGroup,
  parentOf,
  placeOf,
  removed,
  replaced,
  visibleItems,
} from "../../src/domain/bills";

const group = (number: string): BillItem => ({ number, kind: "group" });
const kItems: readonly BillItem[] = [
  group("01"),
  { number: "01.0010" },
  { number: "01.0020" },
  group("02"),
  group("02.01"),
  { number: "02.01.0010" },
];
const numbers = (items: readonly BillItem[]): string[] => items.map(({ number }) => number);

describe("The items of a bill", () => {
  it("have descendants", () => {
    expect(kItems.map((_, index) => endOf(kItems, index))).toEqual([3, 2, 3, 6, 6, 6]);
    expect(visibleItems(kItems, new Set(["02"]))).toEqual([0, 1, 2, 3]);
    expect(numbers(removed(kItems, 3))).toEqual(["01", "01.0010", "01.0020"]);
  });

  it("get free numbers at the selected place", () => {
    const at = (selected: number | null, kind: "group" | "position"): string => {
      const { items, index } = inserted(kItems, selected, kind);
      return `${index} ${items[index]!.number}`;
    };
    expect(at(0, "position")).toBe("3 01.0030");
    expect(at(1, "position")).toBe("2 01.0015");
    expect(at(2, "position")).toBe("3 01.0030");
    expect(at(5, "position")).toBe("6 02.01.0020");
    expect(at(0, "group")).toBe("6 03");
    expect(at(5, "group")).toBe("6 02.02");
    expect(inserted([], null, "group").items).toEqual([group("01")]);
  });

  it("take their descendants along to another number", () => {
    const moved = replaced(kItems, 4, group("01.01"));
    expect(numbers(moved.items)).toEqual(["01", "01.0010", "01.0020", "01.01", "01.01.0010", "02"]);
    expect(moved.index).toBe(3);
    expect(numbers(replaced(kItems, 3, group("07")).items).slice(3)).toEqual([
      "07",
      "07.01",
      "07.01.0010",
    ]);
  });

  it("stay in the order that the server demands, whatever is added and removed", () => {
    const step = fc.record({
      kind: fc.constantFrom("group", "position", "remove"),
      at: fc.nat(30),
    });
    fc.assert(
      fc.property(fc.array(step, { maxLength: 60 }), (steps) => {
        let items: readonly BillItem[] = [];
        for (const { kind, at } of steps) {
          const index = items.length > 0 ? at % items.length : null;
          if (kind !== "remove") items = inserted(items, index, kind).items;
          else if (index !== null) items = removed(items, index);
        }
        expect(new Set(numbers(items)).size).toBe(items.length);
        const groups = new Set([""]);
        for (const item of items) {
          expect(groups).toContain(parentOf(item.number));
          if (isGroup(item)) groups.add(item.number);
        }
      }),
    );
  });
});

describe("The numbers of a bill", () => {
  it("are exact decimals, or refused", () => {
    expect(decimalOf(" 1250.50 ")).toBe("1250.50");
    expect(decimalOf(".5")).toBe("0.5");
    expect(decimalOf("-2.")).toBe("-2");
    for (const wrong of ["", "x", "1e3", "1.2345678", "123456789012", "1,2,3"])
      expect(decimalOf(wrong)).toBeNull();
  });

  it("are sent without empty ones, and the wrong one is named", () => {
    const item: BillItem = {
      number: "01",
      unit_price: "2.50",
      quantity: "",
      rules: [
        { measure: "area", table: 1, factor: " ", size: { over: "", up_to: "" }, where: " " },
      ],
    };
    const draft = { name: " Facade ", currency: "EUR", items: [item] };
    expect(bodyOf(draft)).toEqual({
      body: {
        name: "Facade",
        currency: "EUR",
        items: [{ number: "01", unit_price: "2.50", rules: [{ measure: "area", table: 1 }] }],
      },
    });
    const wrong = { ...item, rules: [{ measure: "area" as const, size: { up_to: "x" } }] };
    expect(bodyOf({ ...draft, items: [group("00"), wrong] })).toEqual({
      wrong: "items[1].rules[0].size.up_to",
    });
  });

  it("come back as they were", () => {
    const items: BillItem[] = [
      {
        number: "1",
        rounding: { smallest: "0.10" },
        rules: [{ measure: "volume", depth: { metres: "0.02" } }],
      },
    ];
    const bill = { id: 1, version: 2, name: "A", currency: "EUR", items };
    expect(bodyOf(draftOf(bill))).toEqual({ body: { name: "A", currency: "EUR", items } });
  });

  it("belong to the item that a problem names", () => {
    expect(placeOf("items[3].rules[0].where")).toEqual({ index: 3, within: "rules[0].where" });
    expect(placeOf("name")).toEqual({ index: null, within: "name" });
  });
});
