import { beforeEach, describe, expect, it } from "vitest";
import { Api } from "../../src/net/api";
import type { OrbitCamera } from "../../src/math/camera";
import { LitArea } from "../../src/session/lit-area";

interface Sent {
  body: { where?: string; picture: { camera: unknown; width: number; height: number } };
  signal: AbortSignal;
  answer(status: number, body: object): void;
}

let sent: Sent[];
let turn: number;
let changes: number;
let lit: LitArea;

const flush = (): Promise<void> => new Promise((done) => setTimeout(done));

beforeEach(() => {
  sent = [];
  turn = 0;
  changes = 0;
  const api = new Api(
    (_, init) =>
      new Promise((done, fail) => {
        const signal = init!.signal!;
        signal.addEventListener("abort", () => fail(new Error("aborted")));
        sent.push({
          body: JSON.parse(String(init!.body)),
          signal,
          answer: (status, body) => done(new Response(JSON.stringify(body), { status })),
        });
      }),
  );
  const camera = (): OrbitCamera =>
    ({ width: 1280, height: 800, message: () => ({ view: [turn] }) }) as unknown as OrbitCamera;
  lit = new LitArea(api, "1", { camera, changed: () => void (changes += 1) });
});

describe("the lit area", () => {
  it("is drawn by the server for the camera, in a picture of limited size", async () => {
    const shown = lit.show({ where: "wet > 1" });
    expect(sent[0]!.body).toMatchObject({
      where: "wet > 1",
      picture: { camera: { view: [0] }, width: 640, height: 400 },
    });
    sent[0]!.answer(200, { area_m2: 3, picture: "AAAA" });
    expect((await shown).area_m2).toBe(3);
    expect(lit.picture).toBe("data:image/png;base64,AAAA");
    expect(changes).toBe(1);
  });

  it("goes out when the camera moves, and is requested again when it rests", async () => {
    void lit.show({ where: "a" });
    sent[0]!.answer(200, { picture: "AAAA" });
    await flush();
    turn = 1;
    lit.cameraMoved();
    expect(lit.picture).toBe(null);
    lit.cameToRest();
    expect(sent[1]!.body.picture.camera).toEqual({ view: [1] });
    sent[1]!.answer(200, { picture: "BBBB" });
    await flush();
    expect(lit.picture).toContain("BBBB");
    lit.cameToRest();
    expect(sent.length).toBe(2);
  });

  it("is not drawn over the picture of another camera", async () => {
    void lit.show({ where: "a" });
    turn = 1;
    sent[0]!.answer(200, { picture: "AAAA" });
    await flush();
    expect(lit.picture).toBe(null);
  });

  it("is the newest one: a later request cancels the one before", async () => {
    const first = lit.show({ where: "a" }).catch((error: unknown) => error);
    const second = lit.show({ where: "b" }).catch((error: unknown) => error);
    expect(sent[0]!.signal.aborted).toBe(true);
    expect(await first).toMatchObject({ status: 499 });
    lit.clear();
    expect(sent[1]!.signal.aborted).toBe(true);
    expect(await second).toMatchObject({ status: 499 });
  });

  it("returns to the lasting area when another one is cleared or refused", async () => {
    void lit.showLasting({ where: "selection" });
    sent[0]!.answer(200, { picture: "AAAA" });
    await flush();
    const refused = lit.show({ where: "wte" }).catch((error: unknown) => error);
    sent[1]!.answer(422, { title: "Invalid expression" });
    expect(await refused).toMatchObject({ status: 422 });
    expect(sent[2]!.body.where).toBe("selection");
    sent[2]!.answer(200, { picture: "CCCC" });
    await flush();
    expect(lit.picture).toContain("CCCC");
    await lit.showLasting(null);
    expect(lit.picture).toBe(null);
    lit.cameToRest();
    expect(sent.length).toBe(3);
  });
});
