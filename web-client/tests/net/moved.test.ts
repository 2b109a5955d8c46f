// Another node of the site takes over the model while the page is connected.

import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { Connection, type ConnectionCallbacks } from "../../src/net/connection";
import { addressAtNode } from "../../src/net/node-address";
import type { StrokeHandle, StrokeOptions } from "../../src/net/stroke";
import type { Moved } from "../../src/core/protocol.gen";
import { FakeSocket, welcome } from "../fake-socket";

const kHere = "wss://museum.example/api/v1/models/1/live";
const kAtB = "wss://museum.example/node/b/api/v1/models/1/live";
const kAtC = "wss://museum.example/node/c/api/v1/models/1/live";
const strokeOptions: StrokeOptions = {
  layer: 7,
  value: 3,
  erase: false,
  camera: { view: [1], projection: [1], width: 640, height: 480 },
  radius: { px: 12 },
  shape: "disc",
  through: false,
};

let sockets: FakeSocket[];
let states: [string, boolean][];
let saving: { waiting: number; failing: boolean };
let connection: Connection;

const socket = (): FakeSocket => sockets[sockets.length - 1]!;
const addresses = (): string[] => sockets.map(({ url }) => url);
const moved = (url?: string): Moved => ({ op: "moved", ...(url === undefined ? {} : { url }) });
const batches = (of: FakeSocket): number[] => of.of("stroke.extend").map(({ n }) => n);

function connect(strokes: Parameters<typeof welcome>[0] = []): void {
  socket().open();
  socket().receive(welcome(strokes));
}
/** Waits for the next attempt, and returns the time until it. */
function nextAttempt(): number {
  const before = sockets.length;
  let waitedMs = 0;
  while (sockets.length === before && waitedMs < 60_000) {
    vi.advanceTimersByTime(50);
    waitedMs += 50;
  }
  return waitedMs;
}
function painted(n: number): StrokeHandle {
  const stroke = connection.beginStroke(strokeOptions)!;
  for (let i = 0; i < n; ++i) stroke.extend([[i, i]]);
  return stroke;
}

beforeEach(() => {
  vi.useFakeTimers();
  sockets = [];
  states = [];
  const ignore = (): void => {};
  const callbacks: ConnectionCallbacks = {
    state: (state) => states.push([state, connection.moved]),
    saving: (state) => (saving = state),
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
    problem: ignore,
    takenUp: ignore,
  };
  connection = new Connection(
    {
      url: kHere,
      client: "test",
      devicePixelRatio: 1,
      makeSocket: (url, protocol) => {
        sockets.push(new FakeSocket(url, protocol));
        return socket();
      },
      nextFrame: ignore,
      random: () => 0.5,
    },
    callbacks,
  );
  connection.open();
});

afterEach(() => {
  connection.close();
  vi.useRealTimers();
});

describe("the address at a node", () => {
  it.each([
    ["no address", undefined, kHere],
    ["an address of this origin", "https://museum.example/node/b", kAtB],
    ["a slash at the end", "https://museum.example/node/b/", kAtB],
    ["a path", "/node/b", kAtB],
    ["the site itself", "https://museum.example", kHere],
    ["another host", "https://elsewhere.example/node/b", kHere],
    ["another port", "https://museum.example:8443/node/b", kHere],
    ["another scheme", "http://museum.example/node/b", kHere],
    ["a script", "javascript:alert(1)", kHere],
    ["another host without a scheme", "//elsewhere.example/node/b", kHere],
    ["no address at all", "http://", kHere],
    ["a query and a fragment", "/node/b?x=1#y", kAtB],
  ])("%s", (_, node, wanted) => {
    expect(addressAtNode(kHere, node)).toBe(wanted);
  });

  it("keeps the query of the page's own address", () => {
    expect(addressAtNode(`${kHere}?as=kiosk`, "/node/b")).toBe(`${kAtB}?as=kiosk`);
  });
});

describe("a model that moved", () => {
  it("is opened at its node at once", () => {
    connect();
    const before = socket();
    before.receive(moved("https://museum.example/node/b"));
    expect(addresses()).toEqual([kHere, kAtB]);
    expect(before.closed).toBe(true);
    expect(connection.moved).toBe(true);
    connect();
    expect([connection.state, connection.moved]).toEqual(["open", false]);
  });

  it("is opened at the site if its node is not known", () => {
    connect();
    socket().receive(moved());
    expect(addresses()).toEqual([kHere, kHere]);
  });

  it("is never opened at another site", () => {
    connect();
    socket().receive(moved("https://elsewhere.example/node/b"));
    expect(addresses()).toEqual([kHere, kHere]);
  });

  it("is opened at its node if the first answer says that it moved", () => {
    socket().open();
    socket().receive(moved("/node/b"));
    connect();
    expect(addresses()).toEqual([kHere, kAtB]);
    expect(connection.state).toBe("open");
  });

  it("that moves twice is followed twice", () => {
    connect();
    socket().receive(moved("/node/b"));
    connect();
    socket().receive(moved("/node/c"));
    expect(addresses()).toEqual([kHere, kAtB, kAtC]);
    connect();
    expect(connection.state).toBe("open");
  });

  it("is asked for with growing pauses of at most a second while two nodes name each other", () => {
    connect();
    socket().receive(moved("/node/b"));
    const pauses: number[] = [];
    for (const node of ["/node/c", "/node/b", "/node/c", "/node/b", "/node/c"]) {
      socket().open();
      socket().receive(moved(node));
      expect(connection.state).toBe("lost");
      pauses.push(nextAttempt());
    }
    expect(pauses).toEqual([250, 500, 1000, 1000, 1000]);
    expect(addresses().slice(2)).toEqual([kAtC, kAtB, kAtC, kAtB, kAtC]);
  });

  it("is asked for at the site if its node does not answer", () => {
    connect();
    socket().receive(moved("/node/b"));
    socket().lose();
    expect(connection.moved).toBe(true);
    expect(nextAttempt()).toBe(250);
    expect(addresses()).toEqual([kHere, kAtB, kHere]);
  });

  it("is asked for at the site after its node has ended", () => {
    connect();
    socket().receive(moved("/node/b"));
    connect();
    socket().lose();
    nextAttempt();
    expect(addresses()).toEqual([kHere, kAtB, kHere]);
    expect(connection.moved).toBe(false);
  });

  it("is not opened again by a page that is closed", () => {
    connect();
    connection.close();
    sockets[0]!.receive(moved("/node/b"));
    vi.advanceTimersByTime(60_000);
    expect(sockets.length).toBe(1);
  });

  it("tells the page why it is not connected", () => {
    connect();
    states = [];
    socket().receive(moved("/node/b"));
    connect();
    expect(states).toEqual([
      ["lost", true],
      ["connecting", true],
      ["open", false],
    ]);
  });
});

describe("strokes of a model that moved", () => {
  it("are not saved until they were sent to the node, once and under the same ids", () => {
    connect();
    const stroke = painted(3);
    stroke.end();
    const before = socket();
    before.receive({ op: "saved", stroke: stroke.stroke, n: 0, sequence: 1 });
    before.receive(moved("/node/b"));
    expect(saving).toEqual({ waiting: 2, failing: false });
    connect();
    vi.advanceTimersByTime(5000);
    const resent = socket().sent.filter(({ op }) => op.startsWith("stroke."));
    expect(resent).toEqual(
      before.sent.filter(
        (message) =>
          message.op.startsWith("stroke.") && !(message.op === "stroke.extend" && message.n === 0),
      ),
    );
    for (const n of [1, 2])
      socket().receive({ op: "saved", stroke: stroke.stroke, n, sequence: n + 1 });
    expect(saving).toEqual({ waiting: 0, failing: false });
  });

  it("are sent once although the old node also reported them as unsaved", () => {
    connect();
    const stroke = painted(2);
    const [first, second] = socket().of("stroke.extend");
    socket().receive({ op: "unsaved", ids: [first!.id] });
    socket().receive({ op: "unsaved", ids: [second!.id] });
    socket().receive(moved("/node/b"));
    connect();
    vi.advanceTimersByTime(5000);
    expect(batches(socket())).toEqual([0, 1]);
    expect(sockets.length).toBe(2);
    for (const n of [0, 1])
      socket().receive({ op: "saved", stroke: stroke.stroke, n, sequence: n + 1 });
    expect(saving).toEqual({ waiting: 0, failing: false });
  });

  it("are kept although the old node refused them because the model moved", () => {
    connect();
    painted(1);
    const [refused] = socket().of("stroke.extend");
    socket().receive({
      op: "problem",
      ref: refused!.id,
      type: "/problems#moved",
      title: "Model moved",
      status: 307,
      detail: "Another node of this site owns the model now.",
    });
    expect(saving.waiting).toBe(1);
    socket().receive(moved("/node/b"));
    connect();
    expect(socket().of("stroke.extend")).toEqual([refused]);
  });

  it("go on while they are being drawn", () => {
    connect();
    const stroke = painted(1);
    socket().receive(moved("/node/b"));
    stroke.extend([[8, 8]]);
    socket().open();
    stroke.extend([[9, 9]]);
    expect(batches(socket())).toEqual([]);
    socket().receive(welcome([{ stroke: stroke.stroke, n: -1 }]));
    stroke.extend([[10, 10]]);
    stroke.end();
    expect(batches(socket())).toEqual([0, 1, 2, 3]);
    expect(
      socket()
        .sentOps()
        .filter((op) => op === "stroke.begin"),
    ).toHaveLength(1);
    expect(socket().sentOps().at(-1)).toBe("stroke.end");
  });

  it("are not sent again if the node already has them in the journal", () => {
    connect();
    const stroke = painted(2);
    socket().receive(moved("/node/b"));
    connect([{ stroke: stroke.stroke, n: 1 }]);
    expect(batches(socket())).toEqual([]);
    expect(saving.waiting).toBe(0);
  });
});
