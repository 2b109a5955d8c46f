import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { fakeApi } from "../../fake-api";
import { Activities, type ActivitiesHost } from "../../../src/features/activity/activity";
import { toldDay } from "../../../src/domain/times";
import { byDay, withFirstPage, withNextPage } from "../../../src/domain/activity";
import { ApiError } from "../../../src/net/api-error";
import type { Activity, ActivityList } from "../../../src/core/protocol.gen";

const line = (id: number, minute: number, more: Partial<Activity> = {}): Activity => {
  const time = `2026-05-04T12:${String(minute).padStart(2, "0")}:00.000Z`;
  return { id, time, begun: time, kind: "edit", op: "stroke", count: 1, ...more };
};
const ids = ({ lines }: { lines: readonly Activity[] }): number[] => lines.map(({ id }) => id);

describe("a log of activity", () => {
  const known = { lines: [line(4, 40), line(3, 30), line(2, 20), line(1, 10)], next: "a place" };

  it("takes a newer first page, where a line that went on has moved to the top", () => {
    const page = { lines: [line(5, 50), line(3, 49, { count: 2 }), line(4, 40)], next: "earlier" };
    const now = withFirstPage(known, page);
    expect(ids(now)).toEqual([5, 3, 4, 2, 1]);
    expect(now.lines[1]!.count).toBe(2);
    expect(now.next).toBe("a place");
  });

  it("forgets what does not meet the page, and what the page lacks though it would stand there", () => {
    expect(
      ids(withFirstPage(known, { lines: [line(9, 59), line(8, 58)], next: "earlier" })),
    ).toEqual([9, 8]);
    // comment 3 has been deleted
    const gone = withFirstPage(known, { lines: [line(4, 40), line(2, 20)], next: "earlier" });
    expect(ids(gone)).toEqual([4, 2, 1]);
    expect(ids(withFirstPage(known, { lines: [], next: undefined }))).toEqual([]);
  });

  it("goes on with the next page, no line twice", () => {
    const now = withNextPage(known, { lines: [line(1, 10), line(6, 5)], next: undefined });
    expect(ids(now)).toEqual([4, 3, 2, 1, 6]);
    expect(now.next).toBeUndefined();
  });

  it("is told by days", () => {
    const now = new Date(2026, 4, 4, 18);
    const at = (id: number, day: number): Activity =>
      line(id, 0, { time: new Date(2026, 4, day, 12).toISOString() });
    const days = byDay([at(4, 4), at(3, 4), at(2, 3), at(1, 1)], (iso) => toldDay(iso, now));
    expect(days.map(({ day, lines }) => [day, lines.length])).toEqual([
      ["today", 2],
      ["yesterday", 1],
      ["1 May 2026", 1],
    ]);
  });
});

describe("the activity of a model", () => {
  const asked: unknown[] = [];
  let answer: (asked: { before: string | undefined }) => Promise<ActivityList>;
  const api = fakeApi({
    "GET /projects/{project}/activity": ({ path, query = {} }) => {
      asked.push([path.project, query]);
      return answer({ before: query.before });
    },
  });
  const flown: unknown[] = [];
  const host = {
    comments: { goTo: (id: number) => flown.push(id) },
    layers: { find: () => null, all: [] },
    model: () => ({ id: 7, project: 1 }),
    me: () => "ada",
    changed: () => {},
  } as unknown as ActivitiesHost;
  let activity: Activities;
  const settle = async (): Promise<void> => {
    for (let i = 0; i < 10; ++i) await Promise.resolve();
  };

  beforeEach(() => {
    vi.useFakeTimers();
    asked.length = flown.length = 0;
    answer = ({ before }) =>
      Promise.resolve(
        before === undefined ? { activity: [line(2, 20)], next: "x" } : { activity: [line(1, 10)] },
      );
    activity = new Activities(api, host);
  });
  afterEach(() => {
    activity.close();
    vi.useRealTimers();
  });

  it("is read while somebody looks, once for all that happens in one go, and once more when that is saved", async () => {
    activity.outdated();
    vi.runAllTimers();
    expect(asked).toEqual([]);
    activity.watch(true);
    await settle();
    expect(asked).toEqual([[1, { limit: 50, before: undefined, model: "7" }]]);
    for (let i = 0; i < 5; ++i) activity.outdated();
    vi.runAllTimers();
    await settle();
    expect(asked).toHaveLength(3);
    activity.outdated();
    vi.advanceTimersByTime(900);
    activity.outdated();
    vi.advanceTimersByTime(200);
    await settle();
    expect(asked).toHaveLength(4); // the server may not have saved the second change yet
    vi.advanceTimersByTime(2900);
    await settle();
    expect(asked).toHaveLength(5);
    activity.outdated();
    activity.watch(false);
    vi.runAllTimers();
    expect(asked).toHaveLength(5);
  });

  it("is unseen after another person's change, until it is read", async () => {
    activity.outdated("ada");
    activity.outdated();
    expect(activity.unseen).toBe(false); // this user's own change
    activity.outdated("bea");
    expect(activity.unseen).toBe(true);
    activity.watch(true);
    expect(activity.unseen).toBe(false);
    activity.outdated("bea");
    expect(activity.unseen).toBe(false);
    await settle();
  });

  it("goes on where the page ended, and of the whole project begins anew", async () => {
    activity.watch(true);
    await settle();
    expect([ids(activity), activity.hasMore]).toEqual([[2], true]);
    await activity.more();
    expect([ids(activity), activity.hasMore]).toEqual([[2, 1], false]);
    activity.whole = true;
    expect(activity.lines).toEqual([]);
    await settle();
    expect(asked[2]).toEqual([1, { limit: 50, before: undefined, model: undefined }]);
  });

  it("gets the earlier lines that were asked for, also if news come at the same time", async () => {
    activity.watch(true);
    await settle();
    let late: (page: ActivityList) => void = () => {};
    const later = (): Promise<ActivityList> => new Promise((resolve) => (late = resolve));
    const atOnce = answer;
    answer = (question) => (question.before === undefined ? atOnce(question) : later());
    let more = activity.more();
    await activity.load();
    expect(activity.busy).toBe(true);
    late({ activity: [line(1, 10)], next: "y" });
    await more;
    expect([ids(activity), activity.busy]).toEqual([[2, 1], false]);

    // so many new lines that the log starts again: the earlier lines continue the new log
    more = activity.more();
    answer = ({ before }) =>
      Promise.resolve(
        before === undefined
          ? { activity: [line(9, 50)], next: "z" }
          : { activity: [line(before === "z" ? 8 : 0, 40)] },
      );
    await activity.load();
    late({ activity: [line(0, 5)] });
    await more;
    expect([ids(activity), activity.hasMore, activity.busy]).toEqual([[9, 8], false, false]);
  });

  it("tells that it could not be read, and takes no answer that came too late", async () => {
    answer = () => Promise.reject(new ApiError({ status: 503, title: "Away", detail: "" }));
    activity.watch(true);
    await settle();
    expect([activity.failed, activity.busy]).toEqual([true, false]);
    let late: (page: ActivityList) => void = () => {};
    answer = () => new Promise((resolve) => (late = resolve));
    const first = activity.load();
    answer = () => Promise.resolve({ activity: [line(3, 30)] });
    await activity.load();
    late({ activity: [line(9, 9)] });
    await first;
    expect([ids(activity), activity.failed]).toEqual([[3], false]);
  });

  it("leads to comments that are there, and nowhere without a thing", async () => {
    const comment = line(1, 1, { kind: "comment", op: "written", model: 7, comment: 5 });
    expect(activity.leadsSomewhere(comment)).toBe(true);
    expect(activity.leadsSomewhere(line(1, 1, { kind: "comment", op: "written", model: 7 }))).toBe(
      false,
    );
    expect(activity.leadsSomewhere(line(1, 1, { kind: "layer", op: "deleted", model: 7 }))).toBe(
      false,
    );
    expect(activity.leadsSomewhere(line(1, 1, { kind: "model", op: "changed", model: 8 }))).toBe(
      true,
    );
    await activity.goTo(comment);
    expect(flown).toEqual([5]);
  });
});
