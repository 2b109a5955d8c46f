// The edits that wait for review, with a small fake server.
import { beforeEach, describe, expect, it, vi } from "vitest";
import { notices, type Notice } from "../../../src/ui/notices";
import { Reviews } from "../../../src/features/review/reviews";
import { texts } from "../../../src/texts";
import { ApiError } from "../../../src/net/api-error";
import { fakeApi } from "../../fake-api";
import type { Review, ReviewQueue, WaitingStroke } from "../../../src/core/protocol.gen";
import type { Layer } from "../../../src/core/types";

const stroke = (sequence: number, user: string): WaitingStroke => ({
  sequence,
  last: sequence,
  stroke: "0b6fbb21-7e3c-4b1c-9a55-2a2f6a1a9c01",
  user,
  op: "stroke",
  begun: "2026-05-01T12:00:00.000Z",
  time: "2026-05-01T12:00:00.000Z",
  texels_changed: 3,
  area_m2: 1e-6,
});
const queueOf = (strokes: WaitingStroke[]): ReviewQueue => ({
  strokes,
  total: strokes.length,
  people: [...new Set(strokes.map(({ user }) => user))].map((user) => ({
    user,
    strokes: strokes.filter((each) => each.user === user).length,
  })),
});

function make(role: "annotator" | "curator") {
  const layers = [
    { id: 1, name: "Cracks", labels: {}, slug: "cracks", review: true },
    { id: 2, name: "Plaster", labels: {}, slug: "plaster", review: false },
  ] as unknown as Layer[];
  const queues = new Map([
    [1, queueOf([stroke(4, "ada"), stroke(6, "ben")])],
    [2, queueOf([])],
  ]);
  const asked: number[] = [];
  const delays: Promise<void>[] = []; // delays of the next responses
  const sent: Review[] = [];
  let refusal: ApiError | null = null;
  const api = fakeApi({
    "GET /models/{model}/layers/{layer}/review": async ({ path, query }) => {
      const layer = Number(path.layer);
      const user = query?.user ?? null;
      asked.push(layer);
      const queue = queueOf(
        queues.get(layer)!.strokes.filter((each) => user === null || each.user === user),
      );
      await delays.shift();
      return queue;
    },
    "POST /models/{model}/layers/{layer}/review": ({ path, body }) => {
      const layer = Number(path.layer);
      const decision = body as Review;
      if (refusal) return Promise.reject(refusal);
      sent.push(decision);
      queues.set(
        layer,
        queueOf(
          queues
            .get(layer)!
            .strokes.filter(
              ({ sequence, user }) =>
                !(decision.all ?? (decision.user === user || decision.edits?.includes(sequence))),
            ),
        ),
      );
      return Promise.resolve({ sequence: 9, texels_changed: 0, area_m2: 0 });
    },
  });
  const list = {
    all: layers,
    find: (id: number) => layers.find((layer) => layer.id === id) ?? null,
  };
  const reviews = new Reviews(api, "m", {
    view: {} as never,
    layers: list as never,
    me: () => "ada",
    nameOf: (user) => user,
    canPaint: () => true,
    canCurate: () => role === "curator",
    changed: () => {},
  });
  return {
    reviews,
    asked,
    delays,
    sent,
    queues,
    layers,
    refuse: (problem: ApiError) => (refusal = problem),
  };
}

let told: readonly Notice[] = [];
beforeEach(() => {
  notices.subscribe((all) => (told = all));
  for (const { id } of told) notices.dismiss(id);
});

describe("what waits for review", () => {
  it("is read of layers that ask for it, and for curators of all", async () => {
    const annotator = make("annotator");
    await annotator.reviews.loadAll();
    expect(annotator.asked).toEqual([1]);
    expect(annotator.reviews.count).toBe(1); // only the annotator's own edit
    expect(annotator.reviews.waiting.map(({ layer }) => layer.id)).toEqual([1]);
    const curator = make("curator");
    await curator.reviews.loadAll();
    expect(curator.asked).toEqual([1, 2]);
    expect(curator.reviews.count).toBe(2);
  });

  it("is read once for what happens in one go, and once more when that is saved", async () => {
    vi.useFakeTimers();
    const { reviews, asked } = make("annotator");
    for (let i = 0; i < 20; ++i)
      reviews.onEvent({
        op: "layer",
        event: "edited",
        layer_id: 1,
        sequence: 10 + i,
        user: "ben",
        provisional: true,
      });
    reviews.onEvent({ op: "layer", event: "edited", layer_id: 2, sequence: 40, user: "ben" });
    await vi.runAllTimersAsync();
    vi.useRealTimers();
    expect(asked).toEqual([1, 1]);
  });

  it("is what the newest question was told, however late an older answer comes", async () => {
    const { reviews, queues, delays } = make("curator");
    let answer = (): void => {};
    delays.push(new Promise((resolve) => (answer = resolve)), Promise.resolve());
    const late = reviews.loadAll();
    queues.set(1, queueOf([stroke(4, "ada")]));
    await reviews.loadAll();
    answer();
    await late;
    expect(reviews.count).toBe(1);
  });

  it("tells its authors what became of it, and nobody else", () => {
    const { reviews } = make("annotator");
    const event = (user: string, authors: string[]) => ({
      op: "layer" as const,
      event: "edited" as const,
      layer_id: 1,
      sequence: 9,
      user,
      review: { decision: "reject" as const, authors, reason: "Too wide" },
    });
    reviews.onEvent(event("cleo", ["ben"]));
    reviews.onEvent(event("ada", ["ada"]));
    expect(told).toEqual([]);
    reviews.onEvent(event("cleo", ["ada", "ben"]));
    expect(told).toMatchObject([
      { kind: "problem", title: texts.review.told.reject("cleo", "Cracks"), detail: "Too wide" },
    ]);
    reviews.close();
  });

  it("is decided, and the decision taken back by the strokes that it was about", async () => {
    const { reviews, sent, layers } = make("curator");
    await reviews.loadAll();
    expect(await reviews.decide(layers[0]!, { decision: "accept", user: "ben" })).toBe(true);
    expect(reviews.count).toBe(1);
    expect(told).toMatchObject([
      { kind: "success", title: "1 edit accepted", link: { label: texts.review.take_back } },
    ]);
    const { link } = told[0]!;
    if (link && "act" in link) link.act();
    expect(sent).toEqual([
      { decision: "accept", user: "ben" },
      { decision: "reopen", edits: [6] },
    ]);
  });

  it("is read again where somebody else was quicker", async () => {
    const { reviews, queues, layers, refuse } = make("curator");
    await reviews.loadAll();
    queues.set(1, queueOf([]));
    refuse(new ApiError({ title: "Not waiting for review", status: 409 }));
    expect(await reviews.decide(layers[0]!, { decision: "reject", edits: [4] })).toBe(false);
    expect(told).toMatchObject([{ kind: "problem", title: "Not waiting for review" }]);
    expect(reviews.count).toBe(0);
  });
});
