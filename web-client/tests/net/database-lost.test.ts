// The node of the page loses its database. It still draws the model, but saves nothing.

import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { Connection, type ConnectionCallbacks } from "../../src/net/connection";
import type { StrokeHandle, StrokeOptions } from "../../src/net/stroke";
import type { DatabaseState } from "../../src/core/protocol.gen";
import { FakeSocket, welcome } from "../fake-socket";

const kHere = "wss://museum.example/api/v1/models/1/live";
const kAtA = "wss://museum.example/node/a/api/v1/models/1/live";
const camera = { view: [1], projection: [1], width: 640, height: 480 };
const strokeOptions: StrokeOptions = {
  layer: 7,
  value: 3,
  erase: false,
  camera,
  radius: { px: 12 },
  shape: "disc",
  through: false,
};

let sockets: FakeSocket[];
let states: string[];
let saving: { waiting: number; failing: boolean };
let problems: number;
let connection: Connection;

const first = (): FakeSocket => sockets[0]!;
const newest = (): FakeSocket => sockets[sockets.length - 1]!;
const database = (reachable: boolean): DatabaseState => ({ op: "database", reachable });
const batches = (of: FakeSocket): number[] => of.of("stroke.extend").map(({ n }) => n);

function painted(n: number): StrokeHandle {
  const stroke = connection.beginStroke(strokeOptions)!;
  for (let i = 0; i < n; ++i) stroke.extend([[i, i]]);
  return stroke;
}
/** Waits for the next connection of the search, and returns the time until it. */
function nextAttempt(): number {
  const before = sockets.length;
  let waitedMs = 0;
  while (sockets.length === before && waitedMs < 60_000) {
    vi.advanceTimersByTime(50);
    waitedMs += 50;
  }
  return waitedMs;
}

beforeEach(() => {
  vi.useFakeTimers();
  sockets = [];
  states = [];
  problems = 0;
  const ignore = (): void => {};
  const callbacks: ConnectionCallbacks = {
    state: (state) => states.push(state),
    saving: (state) => (saving = state),
    problem: () => (problems += 1),
    welcome: ignore,
    frame: ignore,
    applied: ignore,
    saved: ignore,
    layer: ignore,
    look: ignore,
    tool: ignore,
    model: ignore,
    record: ignore,
    table: ignore,
    editors: ignore,
    comment: ignore,
    view: ignore,
    snapshot: ignore,
    selection: ignore,
    presence: ignore,
    picked: ignore,
    takenUp: ignore,
  };
  connection = new Connection(
    {
      url: kHere,
      client: "test",
      devicePixelRatio: 1,
      makeSocket: (url, protocol) => {
        sockets.push(new FakeSocket(url, protocol));
        return newest();
      },
      nextFrame: (callback) => callback(),
      random: () => 0.5,
    },
    callbacks,
  );
  connection.open();
  first().open();
  first().receive(welcome());
  states = [];
});

afterEach(() => {
  connection.close();
  vi.useRealTimers();
});

describe("a connection to a node without its database", () => {
  it("stays open, and still turns the model", () => {
    first().receive(database(false));
    expect([connection.state, connection.databaseLost]).toEqual(["open", true]);
    connection.setCamera(camera, false);
    expect(first().of("camera")).toHaveLength(1);
    expect(states).toEqual([]);
  });

  it("keeps strokes, and sends each once when the database is back", () => {
    first().receive(database(false));
    const stroke = painted(2);
    stroke.end();
    expect(saving).toEqual({ waiting: 2, failing: true });
    vi.advanceTimersByTime(200);
    expect(batches(first())).toEqual([]);

    first().receive(database(true));
    expect(connection.databaseLost).toBe(false);
    expect(batches(first())).toEqual([0, 1]);
    expect(first().sentOps().at(-1)).toBe("stroke.end");
    for (const n of [0, 1])
      first().receive({ op: "saved", stroke: stroke.stroke, n, sequence: n + 1 });
    expect(saving).toEqual({ waiting: 0, failing: false });
    vi.advanceTimersByTime(20_000);
    expect(batches(first())).toEqual([0, 1]);
  });

  it("sends strokes again that were under way, and shows no problem for them", () => {
    painted(2);
    const [applied, refused] = first().of("stroke.extend");
    first().receive(database(false));
    first().receive({ op: "unsaved", ids: [applied!.id] });
    first().receive({
      op: "problem",
      ref: refused!.id,
      type: "/problems#unavailable",
      title: "Not saved",
      status: 503,
      detail: "This node has lost its connection to the database.",
    });
    expect([saving.waiting, problems]).toEqual([2, 0]);
    vi.advanceTimersByTime(200);
    expect(batches(first())).toEqual([0, 1]);
    first().receive(database(true));
    expect(batches(first())).toEqual([0, 1, 0, 1]);
    expect(first().of("stroke.extend").slice(2)).toEqual([applied, refused]);
  });

  it("forgets the state of the node when it is lost", () => {
    first().receive(database(false));
    first().lose();
    expect([connection.state, connection.databaseLost]).toEqual(["lost", false]);
    nextAttempt();
    expect(sockets.length).toBe(2);
    newest().open();
    newest().receive(welcome());
    vi.advanceTimersByTime(60_000);
    expect(sockets.length).toBe(2);
  });
});

describe("the search for another node", () => {
  it("asks the site with growing pauses of at most eight seconds", () => {
    first().receive(database(false));
    const pauses: number[] = [];
    for (let i = 0; i < 7; ++i) {
      pauses.push(nextAttempt());
      newest().lose();
    }
    expect(pauses).toEqual([250, 500, 1000, 2000, 4000, 8000, 8000]);
    expect(new Set(sockets.map(({ url }) => url))).toEqual(new Set([kHere]));
    expect(connection.state).toBe("open");
  });

  it("continues at the node that welcomes the page, with the strokes that wait", () => {
    first().receive(database(false));
    connection.setCamera(camera, false);
    const stroke = painted(1);
    nextAttempt();
    newest().open();
    expect(newest().sentOps()).toEqual(["hello"]);
    expect([connection.state, first().closed]).toEqual(["open", false]);
    newest().receive(welcome());
    expect(first().closed).toBe(true);
    expect(states).toEqual(["lost", "connecting", "open"]);
    expect([connection.state, connection.databaseLost, connection.moved]).toEqual([
      "open",
      false,
      false,
    ]);
    expect(newest().of("camera")).toHaveLength(1);
    expect(batches(newest())).toEqual([0]);
    newest().receive({ op: "saved", stroke: stroke.stroke, n: 0, sequence: 1 });
    expect(saving).toEqual({ waiting: 0, failing: false });
    vi.advanceTimersByTime(9000);
    expect(sockets.length).toBe(2);
  });

  it.each([
    ["that another node has the model", { op: "moved", url: "/node/a" } as const, kAtA],
    ["that an unknown node has the model", { op: "moved" } as const, kHere],
    ["that a foreign node has it", { op: "moved", url: "https://other.example" } as const, kHere],
    ["that it has no database either", database(false), kHere],
  ])("goes on if a node answers %s", (_, message, next) => {
    first().receive(database(false));
    nextAttempt();
    const asked = newest();
    asked.open();
    asked.receive(message);
    expect([asked.closed, first().closed, connection.state]).toEqual([true, false, "open"]);
    expect(nextAttempt()).toBe(500);
    expect(newest().url).toBe(next);
  });

  it("continues at the node that has the model, wherever the site leads", () => {
    first().receive(database(false));
    nextAttempt();
    newest().open();
    newest().receive({ op: "moved", url: "/node/a" });
    nextAttempt();
    newest().open();
    newest().receive(welcome());
    expect([first().closed, connection.state, connection.databaseLost]).toEqual([
      true,
      "open",
      false,
    ]);
  });

  it("asks the site again if the node that has the model does not answer", () => {
    first().receive(database(false));
    nextAttempt();
    newest().open();
    newest().receive({ op: "moved", url: "/node/a" });
    nextAttempt();
    newest().lose();
    nextAttempt();
    expect(sockets.map(({ url }) => url)).toEqual([kHere, kHere, kAtA, kHere]);
  });

  it("goes on if a node does not answer", () => {
    first().receive(database(false));
    nextAttempt();
    const asked = newest();
    expect(nextAttempt()).toBe(30_500);
    expect(asked.closed).toBe(true);
    asked.receive(welcome()); // too late
    expect(first().closed).toBe(false);
  });

  it("ends when the database is back", () => {
    first().receive(database(false));
    nextAttempt();
    const asked = newest();
    first().receive(database(true));
    expect(asked.closed).toBe(true);
    asked.receive(welcome());
    vi.advanceTimersByTime(60_000);
    expect([sockets.length, first().closed, connection.state]).toEqual([2, false, "open"]);
  });

  it("ends with the connection", () => {
    first().receive(database(false));
    nextAttempt();
    connection.close();
    expect(newest().closed).toBe(true);
    vi.advanceTimersByTime(60_000);
    expect(sockets.length).toBe(2);
  });

  it("ends when the node reports that the model moved", () => {
    first().receive(database(false));
    nextAttempt();
    const asked = newest();
    first().receive({ op: "moved", url: "/node/b" });
    expect(asked.closed).toBe(true);
    expect(newest().url).toBe("wss://museum.example/node/b/api/v1/models/1/live");
    expect(connection.databaseLost).toBe(false);
  });
});
