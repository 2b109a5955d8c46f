import { describe, expect, it } from "vitest";

import { loadShare, modelsShown, shortAddress } from "../../src/domain/site-nodes";
import type { SiteNode } from "../../src/core/protocol.gen";

const node = (cores: number): SiteNode => ({
  id: "00000000-0000-4000-8000-000000000001",
  url: "https://museum.example/node/a",
  state: "ready",
  started: "2026-05-04T08:00:00Z",
  lease_s: 2.4,
  draining: false,
  version: "0.1.0",
  gpu: "",
  open_models: 0,
  participants: 0,
  cores_used: cores,
  models: [],
  models_total: 0,
});

describe("the address of a node", () => {
  it.each([
    ["https://museum.example/node/a", "museum.example/node/a"],
    ["http://10.0.0.7:8080/", "10.0.0.7:8080"],
    ["not an address", "not an address"],
  ])("%s", (url, wanted) => {
    expect(shortAddress(url)).toBe(wanted);
  });
});

describe("the load of a node", () => {
  it("is compared with the busiest node", () => {
    const nodes = [node(4), node(1), node(0)];
    expect(nodes.map((each) => loadShare(each, nodes))).toEqual([1, 0.25, 0]);
  });

  it("is small if no node does much", () => {
    const nodes = [node(0.2), node(0.1)];
    expect(nodes.map((each) => loadShare(each, nodes))).toEqual([0.2, 0.1]);
  });
});

describe("the models of a node", () => {
  const models = [
    { id: 1, name: "Villa" },
    { id: 2, name: "" },
    { id: 3, name: "Pot" },
  ];

  it("are named as far as there is room, and the others are counted", () => {
    expect(modelsShown({ models, models_total: 140 }, 2)).toEqual({
      names: ["Villa", "2"],
      others: 138,
    });
  });

  it("are all named if there are few", () => {
    expect(modelsShown({ models, models_total: 3 }, 3)).toEqual({
      names: ["Villa", "2", "Pot"],
      others: 0,
    });
  });
});
