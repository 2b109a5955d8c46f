import { describe, expect, it } from "vitest";
import type { Bill } from "../../../src/core/protocol.gen";
import { BillEdits } from "../../../src/features/bills/bill-edits";
import { ApiError, cancelled } from "../../../src/net/api-error";
import { fakeApi } from "../../fake-api";

const kBill: Bill = {
  id: 3,
  name: "Facade",
  currency: "EUR",
  version: 1,
  items: [
    { number: "01", kind: "group" },
    { number: "01.0010", unit: "m2" },
  ],
};
const kGet = "GET /projects/{project}/bills/{bill}";
const kPut = "PUT /projects/{project}/bills/{bill}";
const kQuantities = "GET /projects/{project}/bills/{bill}/quantities";
const read = (): unknown => ({ value: kBill, etag: '"v1"' });

async function opened(answers: Parameters<typeof fakeApi>[0]): Promise<BillEdits> {
  const edits = new BillEdits(fakeApi({ [kGet]: read, ...answers }), "demo", 3, () => {});
  await edits.load();
  return edits;
}

describe("The open bill", () => {
  it("undoes consecutive changes of one field at once", async () => {
    const edits = await opened({});
    edits.choose(1);
    edits.change({ ...edits.item!, short_text: "C" }, "short_text");
    edits.change({ ...edits.item!, short_text: "Cl" }, "short_text");
    edits.change({ ...edits.item!, unit: "m" }, "unit");
    edits.undo();
    expect(edits.item).toMatchObject({ short_text: "Cl", unit: "m2" });
    edits.undo();
    expect(edits.item).toEqual(kBill.items[1]);
    expect(edits.isChanged).toBe(false);
    edits.redo();
    edits.redo();
    expect(edits.item).toMatchObject({ short_text: "Cl", unit: "m" });
    expect([edits.canUndo, edits.canRedo]).toEqual([true, false]);
  });

  it("is saved with the version that was read", async () => {
    const sent: unknown[] = [];
    const edits = await opened({
      [kPut]: ({ body, header }) => {
        sent.push(header, body);
        return { value: { ...kBill, ...(body as object), version: 2 }, etag: '"v2"' };
      },
    });
    edits.rename("North");
    expect(await edits.save()).toBe(true);
    edits.rename("South");
    expect(await edits.save()).toBe(true);
    expect(sent).toMatchObject([
      { "If-Match": '"v1"' },
      { name: "North" },
      { "If-Match": '"v2"' },
      { name: "South" },
    ]);
    expect(edits.isChanged).toBe(false);
  });

  it("keeps the changes if another user has saved it", async () => {
    const edits = await opened({
      [kPut]: () => {
        throw new ApiError({ status: 412, title: "Stale" });
      },
    });
    edits.rename("North");
    expect(await edits.save()).toBe(false);
    expect([edits.isOutdated, edits.draft?.name]).toEqual([true, "North"]);
    await edits.load();
    expect([edits.isOutdated, edits.draft?.name]).toEqual([false, "Facade"]);
  });

  it("selects the item with the wrong field", async () => {
    const edits = await opened({});
    edits.choose(1);
    edits.change({ ...edits.item!, unit_price: "x" }, "unit_price");
    edits.choose(0);
    expect(await edits.save()).toBe(false);
    expect(edits.problem).toEqual({ field: "items[1].unit_price", text: "" });
    expect(edits.chosen).toBe(1);
  });

  it("knows that its quantities are out of date", async () => {
    const quantities = { bill: 3, version: 1, currency: "EUR", positions: [], total: "0.00" };
    const edits = await opened({ [kQuantities]: () => quantities });
    await edits.measure("en");
    expect([edits.isStale, edits.quantities]).toEqual([false, quantities]);
    edits.choose(1);
    edits.change({ ...edits.item!, unit: "m" }, "unit");
    expect(edits.isStale).toBe(true);
    edits.undo();
    expect(edits.isStale).toBe(false);
  });

  it("reports no problem if the user cancels the measuring", async () => {
    const edits = await opened({
      [kQuantities]: ({ signal }) =>
        new Promise((_, reject) => signal!.addEventListener("abort", () => reject(cancelled()))),
    });
    const measuring = edits.measure("en");
    await Promise.resolve();
    await Promise.resolve();
    expect(edits.isMeasuring).toBe(true);
    edits.cancelMeasuring();
    await measuring;
    expect([edits.isMeasuring, edits.measuringProblem]).toEqual([false, ""]);
  });
});
