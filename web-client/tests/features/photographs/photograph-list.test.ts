import { beforeEach, describe, expect, it } from "vitest";
import type { Photograph } from "../../../src/core/protocol.gen";
import { PhotographList } from "../../../src/features/photographs/photograph-list";
import { ApiError, cancelled } from "../../../src/net/api-error";
import { fakeApi } from "../../fake-api";

const photographs = (from: number, count: number): Photograph[] =>
  Array.from({ length: count }, (_, i) => ({ id: from + i }) as Photograph);
const flush = (): Promise<void> => new Promise((done) => setTimeout(done));

let list: PhotographList;
let asked: unknown[];
let waiting: { answer: (count: number, total: number) => void; fail: (error: Error) => void }[];

beforeEach(() => {
  asked = [];
  waiting = [];
  list = new PhotographList(
    fakeApi({
      "GET /models/{model}/photographs": ({ query, signal }) => {
        asked.push(query);
        return new Promise((answer, fail) => {
          signal?.addEventListener("abort", () => fail(cancelled()));
          waiting.push({
            answer: (count, total) =>
              answer({
                photographs: photographs(Number(query?.offset), count),
                total,
                with_picture: 0,
              }),
            fail,
          });
        });
      },
    }),
    "pot",
    () => {},
  );
});

describe("the list of all photographs", () => {
  it("is read page by page", async () => {
    void list.choose("", false);
    expect([list.isLoading, list.total]).toEqual([true, null]);
    waiting[0]!.answer(60, 70);
    await flush();
    expect([list.photographs.length, list.hasMore, list.isLoading]).toEqual([60, true, false]);
    void list.readMore();
    waiting[1]!.answer(10, 70);
    await flush();
    expect(list.photographs.map(({ id }) => id)).toEqual(Array.from({ length: 70 }, (_, i) => i));
    expect(list.hasMore).toBe(false);
    expect(asked).toEqual([
      { limit: 60, offset: 0 },
      { limit: 60, offset: 60 },
    ]);
  });

  it("is that of the newest text and choice", async () => {
    void list.choose("north", false);
    void list.choose("south", true);
    waiting[1]!.answer(2, 2);
    await flush();
    expect(asked[1]).toEqual({ limit: 60, offset: 0, q: "south", has_picture: false });
    expect([list.total, list.problem]).toEqual([2, ""]);
  });

  it("stays when a page cannot be read", async () => {
    void list.choose("", false);
    waiting[0]!.answer(60, 70);
    await flush();
    void list.readMore();
    waiting[1]!.fail(new ApiError({ status: 503, title: "Busy", detail: "Try again later." }));
    await flush();
    expect([list.photographs.length, list.isLoading]).toEqual([60, false]);
    expect(list.problem).toContain("Try again later.");
  });

  it("ends with its dialog", async () => {
    void list.choose("", false);
    list.stop();
    await flush();
    expect([list.problem, list.isLoading]).toEqual(["", false]);
  });
});
