import { describe, expect, it } from "vitest";

import lock from "../../package-lock.json";

const packages = Object.entries(
  lock.packages as Record<string, { resolved?: string; engines?: { node?: string } }>,
);

describe("package-lock.json", () => {
  it("records no addresses", () => {
    expect(
      packages.filter(([, entry]) => entry.resolved !== undefined).map(([name]) => name),
    ).toEqual([]);
  });
  it("knows the compiled parts for other machines, without which npm ci refuses it", () => {
    const names = packages.map(([name]) => name);
    for (const part of [
      "@rollup/rollup-linux-arm64-gnu",
      "@rollup/rollup-linux-x64-gnu",
      "@esbuild/linux-arm64",
    ])
      expect(names).toContain(`node_modules/${part}`);
  });
  it("holds only packages that run on the Node of Debian 12", () => {
    const newer = packages.filter(
      ([, { engines }]) => engines?.node && /^>=\s*(19|2\d)/.test(engines.node),
    );
    expect(newer.map(([name]) => name)).toEqual([]);
  });
});
