import { describe, expect, it } from "vitest";
import { linkedAddress } from "../../../src/features/linked/linked-dialog";

describe("A stable address", () => {
  it("contains the id of the model and no name", () => {
    expect(linkedAddress(12)).toBe("/id/models/12");
    expect(linkedAddress(12, "/manifest")).toBe("/id/models/12/manifest");
  });
});
