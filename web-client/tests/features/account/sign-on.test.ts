import { describe, expect, it } from "vitest";

import {
  signOnAddress,
  signOnProblem,
  withoutProblem,
} from "../../../src/features/account/sign-on";
import { texts } from "../../../src/texts";

describe("sign-in with a provider", () => {
  it("returns to the page where it began", () => {
    expect(signOnAddress("museum", "/")).toBe("/sign-in/museum");
    expect(signOnAddress("museum", "/models/7?view=2&a=b")).toBe(
      "/sign-in/museum?return_to=%2Fmodels%2F7%3Fview%3D2%26a%3Db",
    );
  });

  it("shows a text for each reason", () => {
    expect(signOnProblem("")).toBe("");
    expect(signOnProblem("?view=2")).toBe("");
    expect(signOnProblem("?sign_in_problem=denied")).toBe(texts.sign_in.problems.denied);
    for (const unknown of ["later", "", "constructor", "__proto__"])
      expect(signOnProblem(`?sign_in_problem=${unknown}`)).toBe(texts.sign_in.problems.refused);
  });

  it("removes the reason from the address", () => {
    expect(withoutProblem("?sign_in_problem=denied")).toBe("");
    expect(withoutProblem("?view=2&sign_in_problem=denied")).toBe("?view=2");
    expect(withoutProblem("?view=a%20b")).toBe("?view=a%20b");
  });
});
