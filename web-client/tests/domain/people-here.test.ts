import { describe, expect, it } from "vitest";

import { contrast, followersOf, inkOn, leadsBack, peopleHere } from "../../src/domain/people-here";
import type { PresenceUser } from "../../src/core/protocol.gen";

const viewer = (session: string, name: string, more: Partial<PresenceUser> = {}): PresenceUser => ({
  session,
  name,
  color: "#0072b2",
  ...more,
});

describe("people at a model", () => {
  it("one's own comes first, the others as they came", () => {
    const people = peopleHere([viewer("a", "ada"), viewer("b", "bea"), viewer("c", "carl")], "b");
    expect(people.map(({ user, own }) => [user, own])).toEqual([
      ["bea", true],
      ["ada", false],
      ["carl", false],
    ]);
  });

  it("who has two windows is one person, to be followed in the one they ask from, or point in", () => {
    const windows = [
      viewer("a1", "ada"),
      viewer("a2", "ada", { full_name: "Ada Lovelace", pointer: { position: [0, 0, 0] } }),
      viewer("b", "bea"),
    ];
    const [, ada] = peopleHere(windows, "b");
    expect([ada!.user, ada!.full_name, ada!.viewer!.session]).toEqual([
      "ada",
      "Ada Lovelace",
      "a2",
    ]);
    windows[0]!.leading = true;
    expect(peopleHere(windows, "b")[1]!.viewer!.session).toBe("a1");
  });

  it("one's own second window may be followed, this one not", () => {
    expect(peopleHere([viewer("a", "ada")], "a")[0]!.viewer).toBe(null);
    expect(peopleHere([viewer("a", "ada"), viewer("a2", "ada")], "a")[0]!.viewer!.session).toBe(
      "a2",
    );
  });

  it("who follows with two windows is one follower", () => {
    const viewers = [
      viewer("a", "ada"),
      viewer("b1", "bea", { following: "a" }),
      viewer("b2", "bea", { following: "a" }),
      viewer("c", "carl"),
    ];
    expect(followersOf(peopleHere(viewers, "a"), "a").map(({ user }) => user)).toEqual(["bea"]);
  });

  it("following that leads back is known, over any number of people", () => {
    const chain = [
      viewer("a", "ada"),
      viewer("b", "bea", { following: "c" }),
      viewer("c", "carl", { following: "a" }),
      viewer("d", "dora"),
    ];
    expect(["b", "c", "d", "a"].map((session) => leadsBack(chain, session, "a"))).toEqual([
      true,
      true,
      false,
      true,
    ]);
    // two users followed each other at the same time; the function must not run forever
    const ring = [viewer("b", "bea", { following: "c" }), viewer("c", "carl", { following: "b" })];
    expect(leadsBack(ring, "b", "a")).toBe(false);
  });
});

describe("ink on a colour", () => {
  it("has the contrast of WCAG: black and white 21, a colour with itself 1", () => {
    expect(contrast("#000000", "#ffffff")).toBeCloseTo(21, 6);
    expect(contrast("#777777", "#ffffff")).toBeCloseTo(4.48, 2);
    expect(contrast("#336699", "#336699")).toBe(1);
  });

  it("is the one that is read best, on each colour that the server gives", () => {
    const colors = [
      "#d55e00",
      "#0072b2",
      "#009e73",
      "#cc79a7",
      "#e69f00",
      "#56b4e9",
      "#7b5ea7",
      "#5c7a29",
    ];
    for (const color of colors) expect(contrast(color, inkOn(color)), color).toBeGreaterThan(3.8);
    expect([inkOn("#e69f00"), inkOn("#0072b2"), inkOn("#ffffff"), inkOn("#000000")]).toEqual([
      "#20292a",
      "#ffffff",
      "#20292a",
      "#ffffff",
    ]);
  });
});
