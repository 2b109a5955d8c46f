import { expect, test } from "vitest";
import type { Template } from "../../../src/core/protocol.gen";
import { firstTermKey } from "../../../src/features/layers/template-dialog";

const template: Template = {
  name: "Stone",
  tables: [
    {
      name: "Terms",
      slug: "terms",
      terms: [
        { code: "family", label: "Family" },
        { code: "crack", label: "Crack", parent: "family" },
      ],
    },
    { name: "Flat", slug: "flat", terms: [{ code: "one", label: "One" }] },
    { name: "Places", slug: "places", columns: [{ name: "Term" }] },
  ],
  layers: [
    { name: "Condition", table: "terms", type: "u16" },
    { name: "Flat", table: "flat", type: "u16" },
    { name: "Places", table: "places", type: "u16" },
  ],
};

test("the brush begins with the first term below a family, in a list with families", () => {
  expect([0, 1, 2, 3].map((layer) => firstTermKey(template, layer))).toEqual([2, null, null, null]);
});
