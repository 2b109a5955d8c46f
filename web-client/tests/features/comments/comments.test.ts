import { beforeEach, describe, expect, it, vi } from "vitest";

import { Comments, type CommentsHost } from "../../../src/features/comments/comments";
import { notices } from "../../../src/ui/notices";
import { kMostLooked, PinSight, type PinPlace } from "../../../src/session/pin-sight";
import { commentOf, hashOfComment } from "../../../src/ui/routes";
import { Api } from "../../../src/net/api";
import { OrbitCamera } from "../../../src/math/camera";
import { mentionBegun, peopleLike } from "../../../src/domain/mentions";
import {
  findThreads,
  isUnread,
  mentions,
  textParts,
  threadsOf,
  withThreadRead,
} from "../../../src/domain/comments";
import type { Point } from "../../../src/net/stroke";
import type { Comment } from "../../../src/core/protocol.gen";
import type { Vec3 } from "../../../src/math/vector";
import { CommentTool } from "../../../src/features/comments/comment-tool";

const written = (id: number, more: Partial<Comment> = {}): Comment => ({
  id,
  model: 1,
  position: [0, -1, 0],
  normal: [0, -1, 0],
  state: "open",
  text: `text ${id}`,
  user: "ada",
  time: "2026-05-04T12:00:00.000Z",
  deleted: false,
  version: 1,
  ...more,
});
const reply = (id: number, thread: number, more: Partial<Comment> = {}): Comment => {
  const { position: _p, normal: _n, state: _s, ...rest } = written(id);
  return { ...rest, thread, ...more };
};

describe("threads", () => {
  const comments = [
    reply(4, 1, { user: "bob", text: "Yes, @carl" }),
    written(2),
    written(1),
    reply(3, 1),
    written(5, { state: "resolved" }),
  ];

  it("have their replies in order, and those that were written in last come first", () => {
    expect(
      threadsOf(comments).map(({ first, replies, newest }) => [
        first.id,
        replies.map(({ id }) => id),
        newest,
      ]),
    ).toEqual([
      [5, [], 5],
      [1, [3, 4], 4],
      [2, [], 2],
    ]);
  });

  it("are found by state, by who takes part, and by words of names and texts", () => {
    const ids = (state: "open" | "resolved" | "all", of: string | null, words: string): number[] =>
      findThreads(threadsOf(comments), { state, of, words }).map(({ first }) => first.id);
    expect(ids("all", null, "")).toEqual([5, 1, 2]);
    expect(ids("open", null, "")).toEqual([1, 2]);
    expect(ids("resolved", null, "")).toEqual([5]);
    expect(ids("all", "bob", "")).toEqual([1]);
    expect(ids("all", "Carl", "")).toEqual([1]);
    expect(ids("all", null, " YES bob ")).toEqual([1]);
    expect(ids("all", null, "text 2")).toEqual([2]);
  });

  it("without their first comment are none", () => {
    expect(threadsOf([reply(3, 1)])).toEqual([]);
  });

  it("are unread while somebody else wrote what was not seen", () => {
    const [thread] = threadsOf([written(1), reply(3, 1, { user: "bob" })]);
    const none = { upto: 0, threads: {} };
    expect(isUnread(thread!, none, "ada")).toBe(true);
    expect(isUnread(thread!, none, "bob")).toBe(true);
    expect(isUnread(thread!, { upto: 1, threads: {} }, "bob")).toBe(false);
    expect(isUnread(thread!, { upto: 2, threads: {} }, "ada")).toBe(true);
    expect(isUnread(thread!, withThreadRead(none, thread!), "ada")).toBe(false);
    expect(isUnread(threadsOf([written(1, { deleted: true })])[0]!, none, "carl")).toBe(false);
  });
});

describe("the text of a comment", () => {
  const people = new Set(["ada", "Carl.B"]);
  const told = (text: string): string =>
    textParts(text, people)
      .map(({ kind, text }) => (kind === "text" ? text : `[${kind} ${text}]`))
      .join("");

  it("has links without what belongs to the sentence", () => {
    expect(told("See https://example.org/a_(b), or (http://x.org).")).toBe(
      "See [link https://example.org/a_(b)], or ([link http://x.org]).",
    );
    expect(told("https://example.org/?q=1&r=2#s!")).toBe("[link https://example.org/?q=1&r=2#s]!");
  });

  it("has no links that do anything else", () => {
    for (const text of [
      "javascript:alert(1)",
      "data:text/html,x",
      "https://",
      "http://:80",
      "file:///etc",
      "xhttps//a",
    ]) {
      expect(textParts(text, people)).toEqual([{ kind: "text", text }]);
    }
    const parts = textParts('https://a.org/"onclick="x <b>https://b.org</b>', people);
    expect(parts.filter(({ kind }) => kind === "link").map(({ text }) => text)).toEqual([
      "https://a.org/",
      "https://b.org",
    ]);
  });

  it("marks the names of people, in any case, and of nobody else", () => {
    expect(told("@ada, @ADA. @carl.b! @nobody ada@ada.org @adam @ada's")).toBe(
      "[mention @ada], [mention @ADA]. [mention @carl.b]! @nobody ada@ada.org @adam [mention @ada]'s",
    );
    expect(mentions("hello @Ada", "ada")).toBe(true);
    expect(mentions("hello ada", "ada")).toBe(false);
  });

  it("keeps every character", () => {
    const text = "a\n\n b\t@ada https://x.org. 😀 <script>";
    expect(
      textParts(text, people)
        .map((part) => part.text)
        .join(""),
    ).toBe(text);
  });
});

describe("addresses of comments", () => {
  it("are read back", () => {
    expect(commentOf(hashOfComment(12))).toBe(12);
    for (const hash of ["", "#comment=", "#comment=0", "#comment=x", "#comment=1e3", "#layer=1"])
      expect(commentOf(hash)).toBeNull();
  });
});

describe("the comment tool", () => {
  it("begins where one taps, turns where one drags, and by Enter in the middle", () => {
    const [tapped, turned]: [Point[], Point[]] = [[], []];
    const tool = new CommentTool(
      {
        orbit: (dx, dy) => turned.push([dx, dy]),
        pan: () => {},
        tap: ({ x, y }) => tapped.push([x, y]),
      },
      () => ({ x: 400, y: 300 }),
    );
    tool.down({ x: 10, y: 10 });
    tool.up();
    tool.down({ x: 10, y: 10 });
    tool.move([{ x: 60, y: 10 }]);
    tool.up();
    expect(tapped).toEqual([[10, 10]]);
    expect(turned).toEqual([[50, 0]]);
    expect(tool.key("Enter")).toBe(true);
    expect(tool.key("x")).toBe(false);
    expect(tapped[1]).toEqual([400, 300]);
  });
});

/** Returns a camera that sees a ball of radius 1 around the origin from the front (from −y). */
function frontCamera(): OrbitCamera {
  const camera = new OrbitCamera();
  camera.setModel({ min: [-1, -1, -1], max: [1, 1, 1] }, "z");
  camera.resize(800, 600);
  camera.standardView("front");
  return camera;
}
const front: PinPlace = { id: 1, position: [0, -1, 0], normal: [0, -1, 0] };
const back: PinPlace = { id: 2, position: [0, 1, 0], normal: [0, 1, 0] };
const side: PinPlace = { id: 3, position: [0.6, -0.8, 0], normal: [0.6, -0.8, 0] };

describe("what is seen of pins", () => {
  let camera: OrbitCamera;
  let places: PinPlace[];
  let asked: Point[][];
  let surface: (pixels: Point[]) => (Vec3 | null)[];
  let sight: PinSight;

  beforeEach(() => {
    camera = frontCamera();
    places = [front, back, side];
    asked = [];
    surface = (pixels) => pixels.map(() => null);
    sight = new PinSight({
      camera: () => camera,
      places: () => places,
      lookAt: async (_, pixels) => {
        asked.push(pixels);
        return surface(pixels);
      },
      changed: () => {},
    });
  });

  it("is what faces the camera while it moves", () => {
    expect([front, back, side].map((place) => sight.isSeen(place))).toEqual([true, false, true]);
  });

  it("is what nothing lies before, once it rests", async () => {
    // an obstacle is in front of the point at the side; the back is visible through a hole
    surface = () => [front.position, back.position, [0.55, -1.5, 0]];
    await sight.look();
    expect(asked[0]).toHaveLength(3);
    expect([front, back, side].map((place) => sight.isSeen(place))).toEqual([true, true, false]);
    sight.cameraMoved();
    expect(sight.isSeen(side)).toBe(false);
    expect(sight.isSeen(back)).toBe(false);
    expect(sight.isSeen(front)).toBe(true);
  });

  it("is what the surface hides by no more than a hair", async () => {
    surface = () => [[0, -1.001, 0], [0, -1, 0], null];
    await sight.look();
    expect([front, back, side].map((place) => sight.isSeen(place))).toEqual([true, false, true]);
  });

  it("is nothing that a section cuts away, which the server is not asked of", async () => {
    camera.section = [[0, 1, 0, 0]]; // keeps the half on the far side
    surface = () => [back.position, back.position];
    await sight.look();
    expect(asked[0]).toHaveLength(2); // a single point is requested twice
    expect([front, back, side].map((place) => sight.isSeen(place))).toEqual([false, true, false]);
  });

  it("is not answered for a camera that moved on", async () => {
    surface = (pixels) => pixels.map(() => [0, -9, 0]);
    const looking = sight.look();
    sight.cameraMoved();
    await looking;
    expect(sight.isSeen(front)).toBe(true);
  });

  it("is asked of what lies in the picture, and of no more than the server takes", async () => {
    places = Array.from({ length: kMostLooked + 5 }, (_, index) => ({ ...front, id: index }));
    await sight.look();
    expect(asked[0]).toHaveLength(kMostLooked);
    camera.target = [100, 0, 0];
    await sight.look();
    expect(asked).toHaveLength(1);
  });
});

class FakeStorage {
  kept = new Map<string, string>();
  getItem = (name: string): string | null => this.kept.get(name) ?? null;
  setItem = (name: string, value: string): void => void this.kept.set(name, value);
}

describe("names behind an @", () => {
  const people = [
    { user: "ada", full_name: "Ada Lovelace", color: "#aa3333" },
    { user: "Adam.B", full_name: "", color: "#aa3333" },
    { user: "bob", full_name: "Robert Ádám", color: "#aa3333" },
    { user: "carl", full_name: "", color: "#aa3333" },
  ];
  const found = (word: string): string[] => peopleLike(people, word).map(({ user }) => user);

  it("are begun where the caret stands behind one, and not in an address of a mail", () => {
    expect(mentionBegun("see @ad", 7)).toEqual({ at: 4, word: "ad" });
    expect(mentionBegun("see @ad now", 7)).toEqual({ at: 4, word: "ad" });
    expect(mentionBegun("@", 1)).toEqual({ at: 0, word: "" });
    expect(mentionBegun("see @ad now", 9)).toBeNull();
    expect(mentionBegun("bob@ad", 6)).toBeNull();
    expect(mentionBegun("see ad", 6)).toBeNull();
  });

  it("are found by how they begin, then by parts of them and of full names, in any case and without accents", () => {
    expect(found("")).toEqual(["ada", "Adam.B", "bob", "carl"]);
    expect(found("AD")).toEqual(["ada", "Adam.B", "bob"]);
    expect(found("love")).toEqual(["ada"]);
    expect(found("b")).toEqual(["bob", "Adam.B"]);
    expect(found("zoe")).toEqual([]);
    const many = Array.from({ length: 50 }, (_, n) => ({
      user: `p${n}`,
      full_name: "",
      color: "#aa3333",
    }));
    expect(peopleLike(many, "p")).toHaveLength(6);
  });
});

describe("the comments of a model", () => {
  let answers: Map<string, () => [status: number, body: unknown]>;
  let calls: { call: string; body: unknown; key: string | null }[];
  let comments: Comments;
  const settle = (): Promise<void> => new Promise((resolve) => setTimeout(resolve, 0));
  const list = (...all: Comment[]): void =>
    void answers.set("GET /api/v1/models/1/comments?limit=1000", () => [
      200,
      { comments: all, total: all.length },
    ]);

  function open(): Comments {
    const camera = frontCamera();
    const api = new Api(async (path, init) => {
      const call = `${init!.method} ${path}`;
      const headers = init!.headers as Record<string, string>;
      calls.push({
        call,
        body: init!.body ? JSON.parse(init!.body as string) : null,
        key: headers["Idempotency-Key"] ?? headers["If-Match"] ?? null,
      });
      const [status, body] = answers.get(call)?.() ?? [503, { title: "Unavailable", status: 503 }];
      return new Response(status === 204 ? null : JSON.stringify(body), { status });
    });
    return new Comments(api, "1", {
      view: { camera, flyTo: () => {} },
      layers: { all: [], selected: null },
      tables: {},
      here: () => [],
      model: () => ({ id: 1, project: 7 }),
      began: () => {},
      changed: () => {},
    } as unknown as CommentsHost);
  }

  beforeEach(async () => {
    vi.stubGlobal("sessionStorage", new FakeStorage());
    vi.stubGlobal("localStorage", new FakeStorage());
    answers = new Map<string, () => [number, unknown]>([
      ["POST /api/v1/models/1/profile", () => [200, { samples: [] }]],
      [
        "POST /api/v1/models/1/pick",
        () => [200, { hit: true, position: [0, -1, 0], normal: [0, -1, 0], values: {} }],
      ],
    ]);
    calls = [];
    list(written(1), reply(2, 1, { user: "bob" }), written(3, { state: "resolved" }));
    comments = open();
    comments.welcome("ada");
    await settle();
  });

  it("have pins for those of the chosen state, and for the one that is looked at", () => {
    const pins = (): number[] => comments.pins.map(({ first }) => first.id);
    expect(pins()).toEqual([1]);
    comments.chooseState("all");
    expect(pins().sort()).toEqual([1, 3]);
    comments.chooseState("open");
    comments.show(3);
    expect(pins()).toEqual([1, 3]);
    comments.pinsShown = false;
    expect(pins()).toEqual([3]);
    expect(comments.openCount).toBe(1);
  });

  it("may name the people of the project, who are asked for once, and again where that failed", async () => {
    expect(await comments.loadPeople()).toEqual([]);
    const dora = { user: "dora", full_name: "Dora D." };
    answers.set("GET /api/v1/projects/7/people?limit=1000", () => [
      200,
      { people: [{ user: "ada", full_name: "", color: "#aa3333" }, dora], total: 2 },
    ]);
    const asked = (): number => calls.filter(({ call }) => call.includes("/people")).length;
    expect(asked()).toBe(1);
    expect(await Promise.all([comments.loadPeople(), comments.loadPeople()])).toEqual([
      [dora],
      [dora],
    ]);
    await comments.loadPeople();
    expect(asked()).toBe(2);
    expect(comments.people.has("dora")).toBe(true);
  });

  it("follow what others do", () => {
    comments.onEvent({
      op: "comment",
      event: "created",
      comment_id: 4,
      comment: reply(4, 1, { user: "bob", text: "Look" }),
      user: "bob",
    });
    expect(comments.find(1)!.replies.map(({ id }) => id)).toEqual([2, 4]);
    expect(comments.said).toContain("Look");
    comments.onEvent({
      op: "comment",
      event: "changed",
      comment_id: 1,
      comment: written(1, { version: 3, state: "resolved" }),
    });
    comments.onEvent({
      op: "comment",
      event: "changed",
      comment_id: 1,
      comment: written(1, { version: 2 }),
    });
    expect(comments.find(1)!.first.state).toBe("resolved");
    comments.show(1);
    comments.onEvent({ op: "comment", event: "deleted", comment_id: 1 });
    expect(comments.find(1)).toBeNull();
    expect(comments.card).toBeNull();
  });

  it("that name this person are shown as a notice, but to who reads the thread", () => {
    let told: readonly string[] = [];
    const stop = notices.subscribe((shown) => (told = shown.map(({ detail }) => detail)));
    const replyWith = (id: number, text: string): void =>
      comments.onEvent({
        op: "comment",
        event: "created",
        comment_id: id,
        comment: reply(id, 1, { user: "bob", text }),
        user: "bob",
      });
    replyWith(4, "@ada first");
    replyWith(5, "for everybody");
    comments.show(1);
    replyWith(6, "@ada second");
    expect(told).toEqual(["@ada first"]);
    expect(comments.said).toContain("@ada second");
    stop();
  });

  it("keep what happens while they are read, and forget what happened before", async () => {
    // comment 3 was deleted while the connection was lost
    list(written(1), reply(2, 1, { user: "bob" }));
    comments.welcome("ada");
    comments.onEvent({
      op: "comment",
      event: "created",
      comment_id: 4,
      comment: written(4, { user: "bob" }),
      user: "bob",
    });
    comments.onEvent({ op: "comment", event: "deleted", comment_id: 2 });
    await settle();
    expect(comments.threads.map(({ first, replies }) => [first.id, replies.length])).toEqual([
      [4, 0],
      [1, 0],
    ]);
  });

  it("are told not to be there when they cannot be read, and read again", async () => {
    answers.delete("GET /api/v1/models/1/comments?limit=1000");
    comments = open();
    comments.welcome("ada");
    await settle();
    expect(comments.failed).toBe(true);
    list(written(1));
    await comments.load();
    expect(comments.failed).toBe(false);
    expect(comments.threads).toHaveLength(1);
  });

  it("are read once they were looked at, also by the next page", async () => {
    expect(comments.unreadCount).toBe(1);
    comments.markRead(comments.find(1)!);
    expect(comments.unreadCount).toBe(0);
    comments.onEvent({
      op: "comment",
      event: "created",
      comment_id: 4,
      comment: reply(4, 1, { user: "bob" }),
      user: "bob",
    });
    expect(comments.unreadCount).toBe(1);
    comments.markAllRead();
    comments = open();
    comments.welcome("ada");
    await settle();
    expect(comments.unreadCount).toBe(0);
    comments.welcome("carl");
    await settle();
    expect(comments.unreadCount).toBe(2);
  });

  it("keep what is written for the next page, and for its person alone", async () => {
    await comments.begin({ x: 1, y: 1 });
    expect(comments.card).toBe("new");
    comments.setDraft("new", { text: "Half a th" });
    comments.setDraft("reply 1", { text: "Yes" });
    expect(comments.close()).toBe(true);
    expect(comments.close()).toBe(false);
    comments = open();
    comments.welcome("ada");
    expect(comments.draft("new")).toMatchObject({ text: "Half a th", position: [0, -1, 0] });
    expect(comments.draft("reply 1")?.text).toBe("Yes");
    comments.welcome("bob");
    expect(comments.draft("new")).toBeNull();
  });

  it("of which nothing was written leave nothing behind", async () => {
    await comments.begin({ x: 1, y: 1 });
    comments.setDraft("new", { text: "  " });
    comments.close();
    expect(comments.draft("new")).toBeNull();
  });

  it("are sent again with the key of the same text", async () => {
    comments.setDraft("reply 1", { text: "Yes" });
    await expect(comments.sendReply(1)).rejects.toThrow();
    await expect(comments.sendReply(1)).rejects.toThrow();
    comments.setDraft("reply 1", { text: "Yes!" });
    answers.set("POST /api/v1/comments/1/replies", () => [201, reply(9, 1, { text: "Yes!" })]);
    await comments.sendReply(1);
    const keys = calls
      .filter(({ call }) => call === "POST /api/v1/comments/1/replies")
      .map(({ key }) => key);
    expect(keys[0]).toBe(keys[1]);
    expect(keys[2]).not.toBe(keys[1]);
    expect(comments.draft("reply 1")).toBeNull();
    expect(comments.find(1)!.replies.at(-1)!.text).toBe("Yes!");
  });

  it("show what somebody else made of one that could not be changed", async () => {
    answers.set("PATCH /api/v1/comments/1", () => [
      412,
      { title: "Changed meanwhile", status: 412, detail: "Read it again." },
    ]);
    answers.set("GET /api/v1/comments/1", () => [200, written(1, { version: 2, text: "Theirs" })]);
    await expect(comments.change(comments.find(1)!.first, { text: "Mine" })).rejects.toThrow(
      "Read it again.",
    );
    expect(calls.find(({ call }) => call === "PATCH /api/v1/comments/1")!.key).toBe('"v1"');
    expect(comments.find(1)!.first.text).toBe("Theirs");
  });
});
