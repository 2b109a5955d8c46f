import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import golden from "../../../protocol/golden/frame_headers.json";
import { Connection, type ConnectionCallbacks } from "../../src/net/connection";
import { kLongestRoundTripMs, kUsualDelayMs } from "../../src/net/batch-flow";
import { kLongestWaitMs, type StrokeHandle, type StrokeOptions } from "../../src/net/stroke";
import type { ChangeMessage } from "../../src/net/outbox";
import type { Layer } from "../../src/core/protocol.gen";
import { FakeSocket, welcome } from "../fake-socket";

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
let frames: (() => void)[];
let callbacks: {
  [Name in keyof ConnectionCallbacks]: ReturnType<typeof vi.fn<ConnectionCallbacks[Name]>>;
};
let connection: Connection;
let shelved: ChangeMessage[]; // the browser's storage, which remains when the page closes

const socket = (): FakeSocket => sockets[sockets.length - 1]!;
const draw = (): void => frames.splice(0).forEach((frame) => frame());
const saving = (): unknown => callbacks.saving.mock.lastCall?.[0];

function connect(strokes: Parameters<typeof welcome>[0] = []): void {
  socket().open();
  socket().receive(welcome(strokes));
}

/** Extends the stroke by batches of one point, which the server paints at once. */
function extendPainted(stroke: StrokeHandle, batches: number): void {
  for (let n = 0; n < batches; ++n) {
    stroke.extend([[n, n]]);
    socket().receive({ op: "applied", stroke: stroke.stroke, n, sequence: 1 + n });
  }
}

beforeEach(() => {
  vi.useFakeTimers();
  sockets = [];
  frames = [];
  callbacks = {
    state: vi.fn(),
    welcome: vi.fn(),
    frame: vi.fn(),
    saving: vi.fn(),
    applied: vi.fn(),
    saved: vi.fn(),
    layer: vi.fn(),
    look: vi.fn(),
    tool: vi.fn(),
    model: vi.fn(),
    record: vi.fn(),
    table: vi.fn(),
    editors: vi.fn(),
    comment: vi.fn(),
    view: vi.fn(),
    snapshot: vi.fn(),
    selection: vi.fn(),
    presence: vi.fn(),
    picked: vi.fn(),
    problem: vi.fn(),
    takenUp: vi.fn(),
  };
  shelved = [];
  connection = new Connection(
    {
      url: "ws://here/api/v1/models/1/live",
      client: "test",
      devicePixelRatio: 2,
      makeSocket: (url, protocol) => {
        sockets.push(new FakeSocket(url, protocol));
        return socket();
      },
      makeQueue: (user) => {
        expect(user).toBe("owner");
        return {
          read: async () => [...shelved],
          put: (message) => void shelved.push(message),
          remove: (ids) => void (shelved = shelved.filter(({ id }) => !ids.includes(id))),
        };
      },
      nextFrame: (callback) => void frames.push(callback),
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

describe("opening", () => {
  it("says hello with the subprotocol, and is open after the welcome", () => {
    expect(socket().protocol).toBe("strata.v1");
    socket().open();
    expect(socket().sent).toEqual([
      { op: "hello", client: "test", dpr: 2, accept: ["jpeg", "png"] },
    ]);
    expect(connection.state).toBe("connecting");
    socket().receive(welcome());
    expect(connection.state).toBe("open");
  });

  it("takes no stroke while too much waits to be saved, and says that this is why", () => {
    connect();
    const stroke = connection.beginStroke(strokeOptions)!;
    extendPainted(stroke, 5001);
    expect([connection.beginStroke(strokeOptions), connection.full]).toEqual([null, true]);
    socket().receive({ op: "saved", stroke: stroke.stroke, n: 0, sequence: 1 });
    expect(connection.full).toBe(false);
    expect(connection.beginStroke(strokeOptions)).not.toBeNull();
  });

  it("takes no stroke before it is open", () => {
    expect(connection.beginStroke(strokeOptions)).toBeNull();
    socket().open();
    expect(connection.beginStroke(strokeOptions)).toBeNull();
  });
});

describe("cameras", () => {
  it("only the newest camera of a drawn picture is sent, with ascending numbers", () => {
    connect();
    connection.setCamera({ ...camera, width: 1 }, true);
    connection.setCamera({ ...camera, width: 2 }, true);
    connection.setCamera({ ...camera, width: 3 }, true);
    expect(socket().of("camera")).toEqual([]);
    draw();
    connection.setCamera({ ...camera, width: 4 }, false);
    draw();
    expect(
      socket()
        .of("camera")
        .map(({ seq, width, moving }) => [seq, width, moving]),
    ).toEqual([
      [1, 3, true],
      [2, 4, false],
    ]);
  });

  it("a camera waits while the socket is busy, and only the newest leaves then", () => {
    connect();
    socket().bufferedAmount = 1e6;
    connection.setCamera({ ...camera, width: 1 }, true);
    draw();
    connection.setCamera({ ...camera, width: 2 }, true);
    draw();
    expect(socket().of("camera")).toEqual([]);
    socket().bufferedAmount = 0;
    draw();
    expect(
      socket()
        .of("camera")
        .map((message) => message.width),
    ).toEqual([2]);
  });

  it("the number in a frame says whether the frame shows the current camera", () => {
    connect();
    connection.setCamera({ ...camera, width: 1 }, true);
    draw();
    expect(connection.cameraInFrame(0)).toBeNull();
    expect(connection.cameraInFrame(1)).toBe(1);
    connection.setCamera({ ...camera, width: 2 }, true);
    expect(connection.cameraInFrame(1)).toBeNull(); // the newer camera is not sent yet
    draw();
    expect(connection.cameraInFrame(1)).toBeNull();
    expect(connection.cameraInFrame(2)).toBe(2);
    // the same camera at rest, for which the server may draw no frame
    connection.setCamera({ ...camera, width: 2 }, false);
    draw();
    expect([2, 3].map((seq) => connection.cameraInFrame(seq))).toEqual([2, 2]);
    expect(connection.cameraInFrame(1)).toBeNull();
  });

  it("after a reconnect the last camera and layer settings are sent again", () => {
    connect();
    connection.setCamera(camera, true);
    connection.setLayerOverrides([
      { layer: 7, visible: false },
      { layer: 8, opacity: 0.5 },
    ]);
    draw();
    socket().lose();
    vi.advanceTimersByTime(300);
    socket().open();
    // layer 8 was deleted in the meantime, and the server would have refused the whole message
    socket().receive({ ...welcome(), layers: [{ id: 7 } as Layer] });
    expect(
      socket()
        .of("camera")
        .map(({ seq, moving }) => [seq, moving]),
    ).toEqual([[2, false]]);
    expect(socket().of("layers")).toEqual([
      { op: "layers", layers: [{ layer: 7, visible: false }] },
    ]);
  });

  it("nothing is viewed any more once nobody looks", () => {
    connect();
    connection.setCamera(camera, false);
    draw();
    connection.stopViewing();
    socket().lose();
    vi.advanceTimersByTime(300);
    connect();
    expect(socket().sentOps()).toEqual(["hello"]);
  });
});

describe("strokes", () => {
  it("a stroke is sent in numbered batches", () => {
    connect();
    const stroke = connection.beginStroke(strokeOptions)!;
    stroke.extend([[1, 1]]);
    stroke.extend([
      [2, 2],
      [3, 3],
    ]);
    stroke.end();
    expect(socket().sentOps()).toEqual([
      "hello",
      "stroke.begin",
      "stroke.extend",
      "stroke.extend",
      "stroke.end",
    ]);
    expect(
      socket()
        .of("stroke.extend")
        .map(({ n, path }) => [n, path]),
    ).toEqual([
      [0, [[1, 1]]],
      [
        1,
        [
          [2, 2],
          [3, 3],
        ],
      ],
    ]);
    const [begin] = socket().of("stroke.begin");
    expect(begin).toMatchObject({ layer: 7, value: 3, radius_px: 12, shape: "disc", camera });
    expect(begin).not.toHaveProperty("erase");
  });

  it("a long path is split at the server's limit of points", () => {
    connect(); // path_points is 4
    connection
      .beginStroke(strokeOptions)!
      .extend(Array.from({ length: 9 }, (_, i): [number, number] => [i, 0]));
    const paths = socket()
      .of("stroke.extend")
      .map((message) => message.path);
    expect(paths.every((path) => path.length <= 4)).toBe(true);
    expect(paths.map((path) => path.map(([x]) => x))).toEqual([[0, 1, 2, 3], [4, 5, 6, 7], [8]]);
  });

  it("an erasing stroke has no value and may have its radius in millimetres", () => {
    connect();
    connection.beginStroke({ ...strokeOptions, erase: true, radius: { mm: 2.5 } });
    const [begin] = socket().of("stroke.begin");
    expect(begin).toMatchObject({ erase: true, radius_mm: 2.5 });
    expect(begin).not.toHaveProperty("value");
    expect(begin).not.toHaveProperty("radius_px");
  });

  it("a stroke names the shape of its brush, and the slant that it reaches where there is a limit", () => {
    connect();
    connection.beginStroke({ ...strokeOptions, shape: 12, max_angle_deg: 60 });
    connection.beginStroke({ ...strokeOptions, shape: "square" });
    const [limited, plain] = socket().of("stroke.begin");
    expect(limited).toMatchObject({ shape: 12, max_angle_deg: 60 });
    expect(plain).toMatchObject({ shape: "square" });
    expect(plain).not.toHaveProperty("max_angle_deg");
  });

  it("what is applied still counts as unsaved until it is saved", () => {
    connect();
    const stroke = connection.beginStroke(strokeOptions)!;
    stroke.extend([[1, 1]]);
    stroke.end();
    expect(saving()).toEqual({ waiting: 1, failing: false });
    socket().receive({ op: "applied", stroke: stroke.stroke, n: 0, sequence: 5 });
    expect(saving()).toEqual({ waiting: 1, failing: false });
    socket().receive({ op: "saved", stroke: stroke.stroke, n: 0, sequence: 5 });
    expect(saving()).toEqual({ waiting: 0, failing: false });
  });
});

describe("a lost connection", () => {
  it("is opened again with growing pauses, until close", () => {
    const pauses: number[] = [];
    for (let attempt = 0; attempt < 8; ++attempt) {
      const before = sockets.length;
      socket().lose();
      expect(connection.state).toBe("lost");
      let waitedMs = 0;
      while (sockets.length === before && waitedMs < 60_000) {
        vi.advanceTimersByTime(50);
        waitedMs += 50;
      }
      pauses.push(waitedMs);
    }
    expect(pauses).toEqual([250, 500, 1000, 2000, 4000, 8000, 8000, 8000]);
    socket().lose();
    connection.close();
    const count = sockets.length;
    vi.advanceTimersByTime(60_000);
    expect(sockets.length).toBe(count);
  });

  it("is opened at once when a person asks", () => {
    connect();
    socket().lose();
    connection.check();
    expect(sockets.length).toBe(2);
    connect();
    vi.advanceTimersByTime(60_000);
    expect(sockets.length).toBe(2);
  });

  it("resends exactly what was not saved, in order and under the same ids", () => {
    connect();
    const stroke = connection.beginStroke(strokeOptions)!;
    for (let i = 0; i < 4; ++i) stroke.extend([[i, i]]);
    stroke.end();
    const before = socket();
    before.receive({ op: "saved", stroke: stroke.stroke, n: 0, sequence: 1 });
    before.lose();
    expect(saving()).toEqual({ waiting: 3, failing: false });
    vi.advanceTimersByTime(300);
    connect([{ stroke: stroke.stroke, n: 1 }]); // the response for batch 1 was lost
    const again = socket().sent.filter((message) => message.op !== "hello");
    const wanted = before.sent.filter(
      (message) => message.op !== "hello" && !(message.op === "stroke.extend" && message.n <= 1),
    );
    expect(again).toEqual(wanted);
    expect(again.map((message) => message.op)).toEqual([
      "stroke.begin",
      "stroke.extend",
      "stroke.extend",
      "stroke.end",
    ]);
    expect(saving()).toEqual({ waiting: 2, failing: false });
  });

  it("keeps what is not saved beyond the page, and nothing else", () => {
    connect();
    const stroke = connection.beginStroke(strokeOptions)!;
    stroke.extend([[1, 1]]);
    stroke.extend([[2, 2]]);
    stroke.end();
    connection.sendChange({ op: "undo", id: "u", layer: 7 });
    expect(shelved.map(({ op }) => op)).toEqual([
      "stroke.begin",
      "stroke.extend",
      "stroke.extend",
      "stroke.end",
      "undo",
    ]);
    socket().receive({ op: "saved", stroke: stroke.stroke, n: 0, sequence: 1 });
    expect(shelved.map(({ op }) => op)).toEqual([
      "stroke.begin",
      "stroke.extend",
      "stroke.end",
      "undo",
    ]);
    socket().receive({ op: "saved", stroke: stroke.stroke, n: 1, sequence: 2 });
    expect(shelved.map(({ op }) => op)).toEqual(["undo"]);
    socket().receive({
      op: "problem",
      ref: "u",
      status: 409,
      title: "Nothing to undo",
      detail: "",
    });
    expect(shelved).toEqual([]);
  });

  it("sends what an earlier page left, before its own, and ends the stroke that was being drawn", async () => {
    shelved = [
      {
        op: "stroke.begin",
        id: "b",
        stroke: "s",
        layer: 7,
        value: 3,
        camera,
        radius_px: 12,
        shape: "disc",
      },
      { op: "stroke.extend", id: "e0", stroke: "s", n: 0, path: [[1, 1]] },
      { op: "stroke.extend", id: "e1", stroke: "s", n: 1, path: [[2, 2]] },
      { op: "undo", id: "u", layer: 7 },
    ];
    connect([{ stroke: "s", n: 0 }]); // the earlier page did not receive the response to this batch
    connection.sendChange({ op: "redo", id: "mine", layer: 7 });
    await vi.advanceTimersByTimeAsync(0);
    expect(callbacks.takenUp.mock.calls).toEqual([[3]]);
    expect(saving()).toEqual({ waiting: 3, failing: false });
    expect(
      socket()
        .sent.slice(-5)
        .map((message) => ("id" in message ? message.id : "")),
    ).toEqual(["b", "e1", expect.any(String), "u", "mine"]);
    expect(
      socket()
        .of("stroke.end")
        .map(({ stroke }) => stroke),
    ).toEqual(["s"]);
    socket().receive({ op: "saved", stroke: "s", n: 1, sequence: 5 });
    for (const id of ["u", "mine"]) socket().receive({ op: "saved", id, sequence: 6 });
    expect([shelved, saving()]).toEqual([[], { waiting: 0, failing: false }]);
  });

  it("keeps nothing of a model that is gone", () => {
    connect();
    connection.sendChange({ op: "undo", id: "u", layer: 7 });
    connection.forget();
    expect(shelved).toEqual([]);
  });

  it("keeps no points that waited when the model went", () => {
    connect();
    const stroke = connection.beginStroke(strokeOptions)!;
    for (let n = 0; n < 4; ++n) stroke.extend([[n, n]]);
    vi.advanceTimersByTime(kLongestRoundTripMs + kUsualDelayMs + 1);
    stroke.extend([[4, 4]]);
    expect(socket().of("stroke.extend")).toHaveLength(4);
    connection.forget();
    vi.advanceTimersByTime(kLongestWaitMs);
    expect(shelved).toEqual([]);
  });

  it("sends waiting points when a batch of an earlier stroke was painted", () => {
    connect();
    const first = connection.beginStroke(strokeOptions)!;
    for (let n = 0; n < 4; ++n) first.extend([[n, n]]);
    first.end();
    vi.advanceTimersByTime(kLongestRoundTripMs + kUsualDelayMs + 1);
    const second = connection.beginStroke(strokeOptions)!;
    second.extend([[4, 4]]);
    expect(socket().of("stroke.extend")).toHaveLength(4);
    socket().receive({ op: "saved", stroke: first.stroke, n: 0, sequence: 1 });
    expect(socket().of("stroke.extend")).toHaveLength(5);
  });

  it("does not wait for the batches of a refused stroke", () => {
    connect();
    const refused = connection.beginStroke(strokeOptions)!;
    for (let n = 0; n < 4; ++n) refused.extend([[n, n]]);
    for (const { id } of [...socket().of("stroke.begin"), ...socket().of("stroke.extend")])
      socket().receive({
        op: "problem",
        ref: id,
        status: 403,
        title: "Forbidden",
        detail: "",
        type: "/problems#forbidden",
      });
    vi.advanceTimersByTime(kLongestRoundTripMs + kUsualDelayMs + 1);
    refused.extend([[4, 4]]);
    const next = connection.beginStroke(strokeOptions)!;
    next.extend([[5, 5]]);
    expect(socket().of("stroke.extend")).toHaveLength(5);
  });

  it("sends nothing again when all was saved", () => {
    connect();
    const stroke = connection.beginStroke(strokeOptions)!;
    stroke.extend([[1, 1]]);
    stroke.end();
    socket().receive({ op: "saved", stroke: stroke.stroke, n: 0, sequence: 1 });
    socket().lose();
    vi.advanceTimersByTime(300);
    connect();
    expect(socket().sentOps()).toEqual(["hello"]);
  });

  it("goes on with a stroke that was being drawn", () => {
    connect();
    const stroke = connection.beginStroke(strokeOptions)!;
    stroke.extend([[1, 1]]);
    socket().lose();
    stroke.extend([[2, 2]]);
    vi.advanceTimersByTime(300);
    connect();
    stroke.extend([[3, 3]]);
    stroke.end();
    expect(socket().sentOps()).toEqual([
      "hello",
      "stroke.begin",
      "stroke.extend",
      "stroke.extend",
      "stroke.extend",
      "stroke.end",
    ]);
    expect(
      socket()
        .of("stroke.extend")
        .map((message) => message.n),
    ).toEqual([0, 1, 2]);
  });

  it("resends no faster than the server takes, and new changes stay behind the old ones", () => {
    connect(); // messages_per_second is 200
    const stroke = connection.beginStroke(strokeOptions)!;
    extendPainted(stroke, 250);
    socket().lose();
    vi.advanceTimersByTime(300);
    connect();
    stroke.extend([[999, 999]]);
    expect(socket().of("stroke.extend").length).toBe(99);
    vi.advanceTimersByTime(1000);
    expect(socket().of("stroke.extend").length).toBe(199);
    vi.advanceTimersByTime(1000);
    expect(
      socket()
        .of("stroke.extend")
        .map((message) => message.n),
    ).toEqual(Array.from({ length: 251 }, (_, n) => n));
  });

  it.each([
    ["changes wait", () => connection.beginStroke(strokeOptions)!.extend([[1, 1]])],
    ["a picture is due", () => (connection.setCamera(camera, false), draw())],
  ])(
    "a server that stays silent while %s is asked for a sign of life, and counts as lost without one",
    (_, act) => {
      connect();
      const first = socket();
      act();
      vi.advanceTimersByTime(9900);
      expect(first.of("pick")).toEqual([]);
      vi.advanceTimersByTime(200);
      expect(first.of("pick").length).toBe(1);
      vi.advanceTimersByTime(9500);
      expect(connection.state).toBe("open");
      vi.advanceTimersByTime(500);
      expect(first.closed).toBe(true);
      expect(connection.state).not.toBe("open");
    },
  );

  it("a sign of life is enough, and nobody hears of it", () => {
    connect();
    connection.setCamera(camera, false);
    draw();
    vi.advanceTimersByTime(10_100);
    socket().receive({ op: "picked", id: socket().of("pick")[0]!.id!, hit: false });
    connection.check();
    socket().receive({
      op: "problem",
      ref: socket().of("pick")[1]!.id!,
      status: 409,
      title: "No camera",
      detail: "",
    });
    vi.advanceTimersByTime(600_000);
    expect(connection.state).toBe("open");
    expect(socket().of("pick").length).toBe(2); // an idle connection sends no requests
    expect(callbacks.picked).not.toHaveBeenCalled();
    expect(callbacks.problem).not.toHaveBeenCalled();
  });

  it("a connection that looks open is doubted when the network changed", () => {
    connect();
    const first = socket();
    connection.check();
    vi.advanceTimersByTime(10_100);
    expect(first.closed).toBe(true);
    expect(connection.state).toBe("lost");
  });

  it.each([
    ["no handshake", () => {}],
    ["no welcome", () => socket().open()],
  ])("%s within 30 s counts as lost", (_, act) => {
    act();
    const first = socket();
    vi.advanceTimersByTime(29_900);
    expect(first.closed).toBe(false);
    vi.advanceTimersByTime(200);
    expect(first.closed).toBe(true);
    expect(connection.state).toBe("lost");
  });

  it("what an old socket still says is not heard", () => {
    connect();
    const old = socket();
    old.lose();
    vi.advanceTimersByTime(300);
    old.receive({ op: "presence", users: [] });
    expect(callbacks.presence).not.toHaveBeenCalled();
  });
});

describe("refusals", () => {
  it("changes that could not be saved are sent again, and the page is told", () => {
    connect();
    const stroke = connection.beginStroke(strokeOptions)!;
    stroke.extend([[1, 1]]);
    stroke.end();
    const sent = socket().sent.slice(1);
    const extend = socket().of("stroke.extend")[0]!;
    socket().sent = [];
    socket().receive({ op: "unsaved", ids: [extend.id] });
    expect(saving()).toEqual({ waiting: 1, failing: true });
    vi.advanceTimersByTime(300);
    expect(socket().sent).toEqual(sent);
    socket().receive({ op: "saved", stroke: stroke.stroke, n: 0, sequence: 9 });
    expect(saving()).toEqual({ waiting: 0, failing: false });
  });

  it("a passing refusal is tried again with growing pauses and told once", () => {
    connect();
    const id = connection.sendChange({
      op: "undo",
      id: "11111111-1111-4111-8111-111111111111",
      layer: 7,
    })!;
    for (const pauseMs of [250, 500, 1000]) {
      socket().sent = [];
      socket().receive({
        op: "problem",
        ref: id,
        status: 503,
        title: "Database gone",
        detail: "Wait.",
      });
      vi.advanceTimersByTime(pauseMs - 10);
      expect(socket().sent).toEqual([]);
      vi.advanceTimersByTime(20);
      expect(socket().sentOps()).toEqual(["undo"]);
    }
    expect(callbacks.problem).toHaveBeenCalledTimes(1);
    expect(saving()).toEqual({ waiting: 1, failing: true });
  });

  it("a batch that came out of order because the one before was refused for the moment goes again with it", () => {
    connect();
    const stroke = connection.beginStroke(strokeOptions)!;
    stroke.extend([[1, 1]]);
    stroke.extend([[2, 2]]);
    const [first, second] = socket().of("stroke.extend");
    socket().sent = [];
    socket().receive({
      op: "problem",
      ref: first!.id,
      status: 429,
      title: "Too many messages",
      detail: "Later.",
    });
    socket().receive({
      op: "problem",
      ref: second!.id,
      status: 409,
      title: "Batch out of order",
      detail: "0 is next.",
    });
    vi.advanceTimersByTime(300);
    expect(socket().of("stroke.extend")).toEqual([first, second]);
    expect(saving()).toEqual({ waiting: 2, failing: true });
  });

  it("a refused stroke is given up as a whole and told once", () => {
    connect();
    const stroke = connection.beginStroke(strokeOptions)!;
    stroke.extend([[1, 1]]);
    const begin = socket().of("stroke.begin")[0]!;
    const extend = socket().of("stroke.extend")[0]!;
    socket().receive({
      op: "problem",
      ref: begin.id,
      status: 404,
      title: "No layer",
      detail: "It was deleted.",
    });
    socket().receive({
      op: "problem",
      ref: extend.id,
      status: 404,
      title: "No stroke",
      detail: "Unknown.",
    });
    stroke.extend([[2, 2]]);
    stroke.end();
    expect(socket().of("stroke.extend").length).toBe(1);
    expect(callbacks.problem.mock.calls).toEqual([
      [{ ref: begin.id, status: 404, title: "No layer", detail: "It was deleted." }],
    ]);
    expect(saving()).toEqual({ waiting: 0, failing: false });
  });

  it("a problem of something that changed nothing is only told", () => {
    connect();
    socket().receive({
      op: "problem",
      status: 422,
      title: "Bad camera",
      detail: "Singular.",
      field: "view",
    });
    expect(callbacks.problem).toHaveBeenCalledTimes(1);
    expect(connection.state).toBe("open");
  });
});

describe("messages", () => {
  it("frames are decoded, and acks name view and frame", () => {
    connect();
    const { hex } = golden.valid.find((vector) => vector.name === "keyframe")!;
    socket().receiveRaw(new Uint8Array(hex.match(/../g)!.map((byte) => parseInt(byte, 16))).buffer);
    expect(callbacks.frame.mock.lastCall?.[0].header).toMatchObject({ frame: 1, full_width: 1280 });
    connection.ack(0, 1);
    expect(socket().of("ack")).toEqual([{ op: "ack", view_id: 0, frame: 1 }]);
  });

  it("a broken frame or an unknown message is told, and the connection lives on", () => {
    connect();
    socket().receiveRaw(new ArrayBuffer(3));
    socket().receiveRaw('{"op":"later"}');
    socket().receiveRaw("{");
    expect(callbacks.problem).toHaveBeenCalledTimes(3);
    expect(connection.state).toBe("open");
  });

  it("says all that a view shows at once, and again after it came back", () => {
    connect();
    connection.setAppearance(null, { mode: "museum" });
    expect(socket().of("layers")).toHaveLength(0);
    connection.setLayerOverrides([{ layer: 3, visible: false }]);
    connection.setAppearance([{ look: 4, opacity: 0.5 }], {
      mode: "raking",
      direction: [1, 0, 1],
    });
    const said = socket().of("layers").at(-1)!;
    expect(said).toMatchObject({
      layers: [{ layer: 3 }],
      looks: [{ look: 4 }],
      light: { mode: "raking" },
    });
    connection.setAppearance(null, { mode: "museum" });
    expect(socket().of("layers").at(-1)).toEqual({
      op: "layers",
      layers: [{ layer: 3, visible: false }],
    });
  });
});
