import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { fakeApi } from "../../fake-api";
import { FakeSocket, welcome } from "../../fake-socket";
import type { Survey, SurveyedObject, Welcome } from "../../../src/core/protocol.gen";
import type { Model } from "../../../src/core/types";
import { takeHandover } from "../../../src/features/surveys/handover";
import { surveyPatch } from "../../../src/features/surveys/survey-patch";
import { Surveys, type SurveysHost } from "../../../src/features/surveys/surveys";
import type { LayersSeen } from "../../../src/domain/surveys";
import { OrbitCamera, placeOf, type Place } from "../../../src/math/camera";
import { ApiError } from "../../../src/net/api-error";

const survey = (model: number, date: string): Survey => ({
  model,
  slug: `bust-${date}`,
  name: `Bust ${date}`,
  date,
});
const object: SurveyedObject = {
  id: 7,
  name: "Bust",
  surveys: [survey(3, "2019"), survey(1, "2022-06"), survey(5, "2025")],
};
const model = (id: number, more: Partial<Model> = {}): Model =>
  ({
    id,
    project: "villa",
    unit: "mm",
    up: "z",
    bounds: { min: [0, 0, 0], max: [100, 100, 100] },
    object: 7,
    survey_date: "2022-06",
    ...more,
  }) as Model;
const light = { mode: "raking", exposure: 0 } as const;

let sockets: FakeSocket[];
let shown: LayersSeen[];
let begun: Place[];
let reads: number;
let answer: () => SurveyedObject;

function make(open: Model | null = model(1)): {
  surveys: Surveys;
  camera: OrbitCamera;
  be: (model: Model) => void;
} {
  const camera = new OrbitCamera();
  let current = open;
  if (open) camera.setModel(open.bounds, open.up);
  camera.resize(800, 600);
  camera.firstView();
  const host: SurveysHost = {
    model: () => current,
    camera: () => camera,
    place: () => placeOf(camera),
    beginAt: (place) => begun.push(place),
    seen: () => new Map([["Cracks", { visible: false, opacity: 0.5 }]]),
    show: (seen) => shown.push(seen),
    light: () => light,
    setLight: () => {},
    changed: () => {},
  };
  const api = fakeApi({
    "GET /projects/{project}/objects/{object}": () => {
      reads += 1;
      return answer();
    },
  });
  const surveys = new Surveys(api, host, (url, protocol) => {
    sockets.push(new FakeSocket(url, protocol));
    return sockets[sockets.length - 1]!;
  });
  return { surveys, camera, be: (next) => (current = next) };
}
async function loaded(open?: Model): Promise<ReturnType<typeof make>> {
  const made = make(open);
  made.surveys.modelChanged();
  await vi.waitFor(() => expect(made.surveys.object).not.toBeNull());
  return made;
}

beforeEach(() => {
  vi.stubGlobal("window", { location: { protocol: "http:", host: "here" }, devicePixelRatio: 1 });
  vi.stubGlobal("location", { pathname: "/", search: "", hash: "" });
  vi.stubGlobal("history", { pushState: () => {}, state: null });
  vi.stubGlobal("requestAnimationFrame", (callback: () => void) => callback());
  [sockets, shown, begun, reads] = [[], [], [], 0];
  answer = () => object;
});
afterEach(() => {
  takeHandover(0);
  vi.unstubAllGlobals();
});

describe("the surveys of the open model", () => {
  it("are those of its object, read once for each change of the object or the date", async () => {
    const { surveys, be } = await loaded();
    expect(surveys.current?.date).toBe("2022-06");
    expect(surveys.others.map(({ date }) => date)).toEqual(["2019", "2025"]);
    surveys.modelChanged();
    expect(reads).toBe(1);
    be(model(1, { survey_date: "2023" }));
    surveys.modelChanged();
    expect(reads).toBe(2);
  });

  it("are none for a model without an object, or if the object cannot be read", async () => {
    const { surveys, be } = await loaded();
    const { object: _, survey_date: __, ...rest } = model(1);
    be(rest);
    surveys.modelChanged();
    await vi.waitFor(() => expect(surveys.object).toBeNull());
    expect(surveys.current).toBeNull();

    answer = () => {
      throw new ApiError({ title: "Not found", status: 404 });
    };
    be(model(1));
    surveys.modelChanged();
    await vi.waitFor(() => expect(reads).toBe(2));
    expect(surveys.object).toBeNull();
  });
});

describe("the known surveys", () => {
  it("are read again after a reconnection", async () => {
    const { surveys } = await loaded();
    surveys.welcome();
    expect(reads).toBe(1);
    answer = () => ({ ...object, surveys: object.surveys.slice(1) });
    surveys.welcome();
    await vi.waitFor(() => expect(surveys.others.map(({ date }) => date)).toEqual(["2025"]));
    expect(reads).toBe(2);
  });

  it("remain while the server cannot be reached, but not if the object was deleted", async () => {
    const { surveys } = await loaded();
    const fail = (status: number): void => {
      answer = () => {
        throw new ApiError({ title: "No", status });
      };
    };
    fail(0);
    await surveys.load();
    expect(surveys.others).toHaveLength(2);
    fail(404);
    await surveys.load();
    expect(surveys.object).toBeNull();
  });
});

describe("another survey", () => {
  it("opens with the camera, in its own unit, and with the layers", async () => {
    const { surveys, camera } = await loaded();
    camera.azimuth = 1.25;
    surveys.open(surveys.others[1]!, true);
    const next = make(model(5, { unit: "m", survey_date: "2025" }));
    next.surveys.begin(model(5, { unit: "m" }));
    expect(next.surveys.takesFocus).toBe(true);
    expect(begun).toHaveLength(1);
    expect(begun[0]!.azimuth).toBe(1.25);
    expect(begun[0]!.distance).toBeCloseTo(camera.distance / 1000);
    expect(shown).toEqual([]);
    next.surveys.welcome();
    next.surveys.welcome(); // after a reconnection, the user's later changes remain
    expect(shown).toEqual([new Map([["Cracks", { visible: false, opacity: 0.5 }]])]);
  });

  it("begins as usual if the user opened another model in between", async () => {
    const { surveys } = await loaded();
    surveys.open(surveys.others[0]!, false);
    make(model(9)).surveys.begin(model(9));
    make(model(3)).surveys.begin(model(3));
    expect(begun).toEqual([]);
  });

  it("has its first view if its up direction differs", async () => {
    const { surveys } = await loaded();
    surveys.open(surveys.others[0]!, false);
    make(model(3, { up: "y" })).surveys.begin(model(3, { up: "y" }));
    expect(begun).toEqual([]);
  });
});

describe("a swipe", () => {
  const own = { id: 11, name: "Cracks", visible: true } as Welcome["layers"][number];

  async function swipe(index: number): Promise<ReturnType<typeof make> & { socket: FakeSocket }> {
    const made = await loaded();
    made.surveys.compareWith(made.surveys.others[index]!);
    const socket = sockets[0]!;
    socket.open();
    socket.receive({ ...welcome(), model: model(3, { unit: "m" }), layers: [own] });
    return { ...made, socket };
  }

  it("connects to the other model, with the same camera, layers and light", async () => {
    const { surveys, camera, socket } = await swipe(0);
    expect(socket.url).toBe("ws://here/api/v1/models/3/live");
    const settings = socket.of("layers").at(-1)!;
    expect(settings.layers).toEqual([{ layer: 11, visible: false, opacity: 0.5 }]);
    expect(settings.light?.mode).toBe("raking");
    const before = socket.of("camera").at(-1)!;
    expect([before.width, before.height]).toEqual([800, 600]);
    expect(before.view[14]).toBeCloseTo(camera.message().view[14]! / 1000);
    camera.azimuth += 1;
    surveys.other!.cameraMoved(true);
    expect(socket.of("camera").at(-1)!.view).not.toEqual(before.view);
  });

  it("has the earlier survey at the left", async () => {
    expect((await swipe(0)).surveys.otherIsEarlier).toBe(true);
    sockets = [];
    expect((await swipe(1)).surveys.otherIsEarlier).toBe(false);
  });

  it("keeps the divider reachable", async () => {
    const { surveys } = await swipe(0);
    surveys.setDivider(-1);
    expect(surveys.divider).toBe(0.02);
    surveys.setDivider(2);
    expect(surveys.divider).toBe(0.98);
  });

  it("ends with the page, with another choice, and with the other model", async () => {
    const { surveys, socket } = await swipe(0);
    surveys.compareWith(surveys.others[1]!);
    expect(socket.closed).toBe(true);
    sockets[1]!.open();
    sockets[1]!.receive({ ...welcome(), model: model(5), layers: [] });
    answer = () => ({ ...object, surveys: object.surveys.slice(0, 2) });
    sockets[1]!.receive({ op: "model", event: "deleted", id: 5 } as never);
    expect(surveys.other).toBeNull();
    await vi.waitFor(() => expect(surveys.others.map(({ date }) => date)).toEqual(["2019"]));
    surveys.compareWith(surveys.others[0]!);
    surveys.close();
    expect(surveys.other).toBeNull();
    expect(sockets.every(({ closed }) => closed)).toBe(true);
  });
});

describe("the change that makes a model a survey", () => {
  const made: string[] = [];
  const api = fakeApi({
    "POST /projects/{project}/objects": ({ body }) => {
      made.push((body as { name: string }).name);
      return { id: 9, name: "Torso", surveys: [] };
    },
  });

  it("names a known object in any case, or makes one", async () => {
    const patch = (name: string, date: string): Promise<unknown> =>
      surveyPatch(api, "villa", [object], { name, date });
    expect(await patch("BUST", "2019-05")).toEqual({ object: 7, survey_date: "2019-05" });
    expect(made).toEqual([]);
    expect(await patch("Torso", "2019")).toEqual({ object: 9, survey_date: "2019" });
    expect(made).toEqual(["Torso"]);
    expect(await patch("", "2019")).toEqual({ object: 0 });
  });
});
