import { beforeEach, describe, expect, it } from "vitest";

import { RecordEditors } from "../../src/session/record-editors";

type Said = { table: number; key: number; editing: boolean; take_over?: boolean };
let said: Said[];
let editors: RecordEditors;
const there = (key: number, session?: string, user?: string): void =>
  editors.onMessage({
    op: "record.editors",
    records: [
      {
        table: 4,
        key,
        ...(session === undefined ? {} : { session }),
        ...(user === undefined ? {} : { user }),
      },
    ],
  });

beforeEach(() => {
  said = [];
  editors = new RecordEditors({
    say: (what) => said.push(what),
    nameOf: (user) => (user === "bea" ? "Bea Ost" : user),
    changed: () => {},
  });
  editors.joined("me", "ada");
});

describe("who writes into a record", () => {
  it("what is opened is told once, and its end when nothing of the page has it any more", () => {
    const [form, cell] = [editors.claim(4, 7), editors.claim(4, 7)];
    expect(said).toEqual([{ table: 4, key: 7, editing: true }]);
    there(7, "me", "ada");
    form.release();
    form.release();
    expect(said.length).toBe(1);
    cell.release();
    expect(said.at(-1)).toEqual({ table: 4, key: 7, editing: false });
    expect(said.length).toBe(2);
  });

  it("somebody else is told apart from another window of one's own", () => {
    there(7, "other", "bea");
    there(8, "window", "ada");
    there(9, "me", "ada");
    expect([7, 8, 9, 10].map((key) => editors.other(4, key))).toEqual([
      { user: "Bea Ost", isMe: false },
      { user: "ada", isMe: true },
      null,
      null,
    ]);
    expect(editors.other(5, 7)).toBe(null);
    there(7);
    expect(editors.other(4, 7)).toBe(null);
  });

  it("whoever waits gets the record when it is left", () => {
    there(7, "other", "bea");
    const claim = editors.claim(4, 7);
    expect([claim.other?.user, claim.lost]).toEqual(["Bea Ost", false]);
    there(7);
    expect(said).toEqual([
      { table: 4, key: 7, editing: true },
      { table: 4, key: 7, editing: true },
    ]);
    there(7, "me", "ada");
    expect([claim.other, claim.had]).toEqual([null, true]);
  });

  it("a record that was taken over is lost, and may be taken back", () => {
    const claim = editors.claim(4, 7);
    there(7, "me", "ada");
    expect(claim.lost).toBe(false);
    there(7, "other", "bea");
    expect(claim.lost).toBe(true);
    claim.takeOver();
    expect(said.at(-1)).toEqual({ table: 4, key: 7, editing: true, take_over: true });
    expect(claim.other).toBe(null);
    there(7, "me", "ada");
    expect(claim.lost).toBe(false);
  });

  it("one that is opened a second time on this page was had from the first", () => {
    editors.claim(4, 7);
    there(7, "me", "ada");
    const second = editors.claim(4, 7);
    there(7, "other", "bea");
    expect(second.lost).toBe(true);
  });

  it("without a connection nobody is known to be there; a new one is told what is open, once", () => {
    const [form, cell, other] = [editors.claim(4, 7), editors.claim(4, 7), editors.claim(4, 8)];
    there(9, "other", "bea");
    editors.left();
    expect(editors.other(4, 9)).toBe(null);
    other.release();
    said = [];
    editors.joined("again", "ada");
    expect(said).toEqual([{ table: 4, key: 7, editing: true }]);
    there(7, "again", "ada");
    expect([form.other, cell.had]).toEqual([null, true]);
  });
});
