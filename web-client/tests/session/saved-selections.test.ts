import { beforeEach, describe, expect, it } from "vitest";
import type { SavedSelection } from "../../src/core/protocol.gen";
import { SavedSelections } from "../../src/session/saved-selections";
import { ApiError } from "../../src/net/api-error";
import { fakeApi } from "../fake-api";

const made = (id: number, more: Partial<SavedSelection> = {}): SavedSelection => ({
  id,
  slug: `s${id}`,
  name: `S${id}`,
  text: "",
  audience: "personal",
  within: { where: "true" },
  user: "ada",
  time: "2026-05-04T12:00:00Z",
  version: 1,
  ...more,
});
const flush = (): Promise<void> => new Promise((done) => setTimeout(done));

let stored: Map<number, SavedSelection>;
let sent: unknown[];
let curates: boolean;
let saved: SavedSelections;

beforeEach(async () => {
  stored = new Map([2, 1].map((id) => [id, made(id)] as const));
  sent = [];
  curates = false;
  const gone = new ApiError({ title: "Gone", status: 404 });
  const of = ({ selection }: { selection: number | string }): SavedSelection => {
    const found = stored.get(Number(selection));
    if (!found) throw gone;
    return found;
  };
  const newest = (options: {
    path: { selection: number | string };
    header?: object;
  }): SavedSelection => {
    const found = of(options.path);
    sent.push(options.header);
    if (JSON.stringify(options.header).includes(`${found.version}`)) return found;
    throw new ApiError({ title: "Changed", status: 412 });
  };
  const api = fakeApi({
    "GET /models/{model}/selections": () => ({ selections: [...stored.values()] }),
    "GET /models/{model}/selections/{selection}": ({ path }) => of(path),
    "POST /models/{model}/selections": ({ body, header }) => {
      sent.push(body, header);
      return made(3, body as Partial<SavedSelection>);
    },
    "PATCH /models/{model}/selections/{selection}": (options) => {
      const { version, ...rest } = newest(options);
      sent.push(options.body);
      return { ...rest, ...options.body, version: version + 1 };
    },
    "DELETE /models/{model}/selections/{selection}": (options) => void newest(options),
  });
  saved = new SavedSelections(api, "m", {
    user: () => "ada",
    canCurate: () => curates,
    changed: () => {},
  });
  await saved.load();
});

const names = (): string[] => saved.all.map(({ name }) => name);

describe("saved selections", () => {
  it("are listed in order of creation", () => {
    expect(names()).toEqual(["S1", "S2"]);
  });

  it("are created in the contract's format", async () => {
    const body = {
      name: "Damp",
      text: "",
      audience: "everyone",
      within: { where: "wet > 1", grow_mm: 5 },
    } as const;
    await saved.create(body, "key");
    expect(sent).toEqual([body, { "Idempotency-Key": "key" }]);
    expect(names()).toEqual(["S1", "S2", "Damp"]);
  });

  it("are changed and deleted in the version that this page has", async () => {
    const changed = await saved.change(saved.find(1)!, { audience: "everyone" });
    expect([changed.audience, changed.version, sent.at(-1)]).toEqual([
      "everyone",
      2,
      { audience: "everyone" },
    ]);
    await saved.remove(saved.find(2)!);
    expect(names()).toEqual(["S1"]);
  });

  it("are read again if somebody else has changed or deleted them", async () => {
    stored.set(1, made(1, { name: "Other", version: 5 }));
    await expect(saved.change(saved.find(1)!, { name: "Mine" })).rejects.toMatchObject({
      status: 412,
    });
    stored.delete(2);
    await expect(saved.remove(saved.find(2)!)).rejects.toMatchObject({ status: 404 });
    expect(names()).toEqual(["Other"]);
  });

  it("follow the server's events", async () => {
    stored.set(4, made(4));
    saved.onEvent({ op: "selection", event: "created", selection: 4 });
    saved.onEvent({ op: "selection", event: "deleted", selection: 1 });
    await flush();
    expect(names()).toEqual(["S2", "S4"]);
  });

  it("can be changed by their creators and by curators", () => {
    const others = made(9, { user: "bea" });
    expect([saved.mayChange(made(8)), saved.mayChange(others)]).toEqual([true, false]);
    curates = true;
    expect(saved.mayChange(others)).toBe(true);
  });
});
