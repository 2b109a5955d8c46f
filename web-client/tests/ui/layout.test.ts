import type { ReactiveController } from "lit";
import { afterEach, describe, expect, it, vi } from "vitest";
import { FileDrop } from "../../src/ui/drop";
import { growing, growth } from "../../src/ui/growth";
import { hasFingersOnly } from "../../src/ui/pointers";
import { hiddenEnds } from "../../src/ui/scroll-fade";

afterEach(() => vi.unstubAllGlobals());

describe("a row that scrolls", () => {
  it("hides nothing where all fits", () => {
    expect(hiddenEnds(0, 300, 300)).toEqual({ before: false, after: false });
  });
  it("hides what lies beyond its end, its beginning, or both", () => {
    expect(hiddenEnds(0, 300, 500)).toEqual({ before: false, after: true });
    expect(hiddenEnds(100, 300, 500)).toEqual({ before: true, after: true });
    expect(hiddenEnds(200, 300, 500)).toEqual({ before: true, after: false });
  });
  it("is at its end also where browsers round", () => {
    expect(hiddenEnds(1, 300, 500).before).toBe(false);
    expect(hiddenEnds(198.6, 300, 500).after).toBe(false);
  });
});

describe("pointers", () => {
  const withPointers = (...matching: string[]): void => {
    vi.stubGlobal("matchMedia", (query: string) => ({ matches: matching.includes(query) }));
  };

  it("are fingers only where nothing finer is there", () => {
    withPointers("(pointer: coarse)");
    expect(hasFingersOnly()).toBe(true);
    withPointers("(pointer: coarse)", "(any-pointer: fine)");
    expect(hasFingersOnly()).toBe(false);
    withPointers("(any-pointer: fine)");
    expect(hasFingersOnly()).toBe(false);
  });
});

describe("growth", () => {
  it("is that of the root's words, and lengths follow it", () => {
    vi.stubGlobal("document", { documentElement: {} });
    vi.stubGlobal("getComputedStyle", () => ({ fontSize: "24px" }));
    expect(growth()).toBe(1.5);
    expect(growing(330)).toBe("20.625rem");
  });
});

describe("a place for files", () => {
  class Place extends EventTarget {
    drawn = 0;
    readonly updateComplete = Promise.resolve(true);
    addController(_: ReactiveController): void {}
    removeController(_: ReactiveController): void {}
    requestUpdate(): void {
      this.drawn += 1;
    }
  }
  const event = (type: string, files: string[]): Event => {
    const items = files.map(() => ({ webkitGetAsEntry: () => null }));
    const dataTransfer = {
      types: files.length > 0 ? ["Files"] : ["text/plain"],
      files: files.map((name) => new File([""], name)),
      items,
    };
    return Object.assign(new Event(type, { cancelable: true }), { dataTransfer });
  };
  /** Returns the drop target, and functions that send events to it. */
  function place(may = true): {
    host: Place;
    drop: FileDrop;
    taken: string[][];
    send(type: string, files: string[]): Event;
  } {
    const host = new Place();
    const taken: string[][] = [];
    const drop = new FileDrop(
      host,
      (files) => taken.push(files.map(({ name }) => name)),
      () => may,
    );
    const send = (type: string, files: string[]): Event => {
      const sent = event(type, files);
      host.dispatchEvent(sent);
      return sent;
    };
    return { host, drop, taken, send };
  }

  it("shows that files are held over it, and takes them", async () => {
    const { host, drop, taken, send } = place();
    expect(send("dragover", ["a.csv"]).defaultPrevented).toBe(true);
    expect(drop.over).toBe(true);
    send("dragover", ["a.csv"]);
    expect(host.drawn).toBe(1);
    expect(send("drop", ["a.csv", "b.csv"]).defaultPrevented).toBe(true);
    await Promise.resolve();
    expect(drop.over).toBe(false);
    expect(taken).toEqual([["a.csv", "b.csv"]]);
  });
  it("ends to show it when they leave", () => {
    const { drop, send } = place();
    send("dragover", ["a.csv"]);
    send("dragleave", []);
    expect(drop.over).toBe(false);
  });
  it("leaves text, and all that it may not take, to what is around it", async () => {
    for (const { drop, taken, sent } of [place(), place(false)].map((each, index) => ({
      ...each,
      sent: ["dragover", "drop"].map((type) => each.send(type, index === 0 ? [] : ["a.csv"])),
    }))) {
      await Promise.resolve();
      expect(sent.map(({ defaultPrevented }) => defaultPrevented)).toEqual([false, false]);
      expect([drop.over, taken]).toEqual([false, []]);
    }
  });
  it("leaves files to a place within it", async () => {
    const { host, drop, taken } = place();
    for (const type of ["dragover", "drop"]) {
      const sent = event(type, ["a.csv"]);
      sent.preventDefault();
      host.dispatchEvent(sent);
    }
    await Promise.resolve();
    expect([drop.over, taken]).toEqual([false, []]);
  });
});
