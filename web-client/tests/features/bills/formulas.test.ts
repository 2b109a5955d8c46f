import fc from "fast-check";
import { describe, expect, it } from "vitest";
import { formulaResult } from "../../../src/features/bills/formulas";

const valueOf = (text: string): string => {
  const result = formulaResult(text);
  if (!("value" in result)) throw new Error(`${text}: ${result.problem} at ${result.at}`);
  return result.value;
};

describe("A formula", () => {
  it.each([
    ["2 * 1,20 * 0,85", "2.04"],
    ["1/3", "0.333333"],
    ["2/3", "0.666667"],
    ["-(2/3)", "-0.666667"],
    ["1/3*3 =", "1"],
    ["2x3:4", "1.5"],
    ["1,5²+2³", "10.25"],
    ["-2^2", "-4"],
    ["(1+2)^3−7", "20"],
    ["0,0000005", "0.000001"],
    ["-0,0000001", "0"],
    ["123456789012345678901234567890", "123456789012345678901234567890"],
  ])("computes %s", (text, expected) => {
    expect(valueOf(text)).toBe(expected);
  });

  it.each([
    ["", 0],
    ["2 * 1,20 *", 10],
    ["2,", 0],
    ["1.000,5", 0],
    ["(1", 2],
    ["1 a", 2],
    ["2^x", 2],
  ])("has a mistake: %s", (text, at) => {
    expect(formulaResult(text)).toEqual({ problem: "mistake", at });
  });

  it("has no result if it divides by zero, or is too large or too long", () => {
    for (const text of ["1/0", "1/(2-2)", "((9^9)^9)^9", `1${"+1".repeat(300)}`])
      expect(formulaResult(text)).toMatchObject({ problem: "no_result" });
    expect(formulaResult(`${"(".repeat(60)}1`)).toMatchObject({ problem: "mistake" });
  });

  it("agrees with whole numbers", () => {
    const small = fc.integer({ min: 0, max: 1_000_000 });
    fc.assert(
      fc.property(small, small, small, (a, b, c) => {
        expect(valueOf(`${a} + ${b} * ${c} - ${b}`)).toBe(String(a + b * c - b));
      }),
    );
  });
});
