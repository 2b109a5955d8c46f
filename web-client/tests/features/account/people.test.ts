import { describe, expect, it } from "vitest";

import {
  invitationOf,
  isUselessLink,
  loginPathOf,
  passwordWords,
  signInProblem,
} from "../../../src/features/account/entry";
import { Appearance } from "../../../src/features/appearance/appearance";
import { routeOf } from "../../../src/ui/routes";
import { texts } from "../../../src/texts";
import { toldDate, toldTime } from "../../../src/domain/times";
import { Api, nextPage, kAsItIs } from "../../../src/net/api";
import { ApiError } from "../../../src/net/api-error";
import { changeRecord } from "../../../src/net/records";
import { changeLayer, createLayer } from "../../../src/net/layers";
import {
  browserOf,
  called,
  findPeople,
  initials,
  isUserName,
  mayChange,
  passwordMistake,
  roleByGroups,
  rolesOfTokens,
  rolesOfTokensIn,
  rolesToGive,
} from "../../../src/domain/people";
import type { Look, Person } from "../../../src/core/protocol.gen";
import { mayAdminister } from "../../../src/core/types";

const person = (user: string, fullName = "", more: Partial<Person> = {}): Person => ({
  id: 2,
  user,
  full_name: fullName,
  role: "annotator",
  state: "active",
  created: "2026-05-04T12:00:00.000Z",
  groups: [],
  color: "#aa3333",
  ...more,
});
const refusal = (status: number, more: { field?: string; detail?: string } = {}): ApiError =>
  new ApiError({ status, title: "Refused", ...more });

/**
 * Returns an Api whose server returns these responses in turn, and the requests that the server
 * received.
 */
function apiOf(...answers: [status: number, body: unknown, headers?: Record<string, string>][]): {
  api: Api;
  asked: { what: string; body: unknown; headers: Record<string, string> }[];
} {
  const asked: { what: string; body: unknown; headers: Record<string, string> }[] = [];
  const api = new Api(async (path, init) => {
    const [status, body, told = {}] = answers[asked.length] ?? [500, {}];
    const sent = typeof init!.body === "string" ? (JSON.parse(init!.body) as unknown) : null;
    asked.push({
      what: `${init!.method} ${path}`,
      body: sent,
      headers: init!.headers as Record<string, string>,
    });
    return new Response(status === 204 ? null : JSON.stringify(body), { status, headers: told });
  });
  return { api, asked };
}

const appearanceOf = (api: Api): Appearance =>
  new Appearance(api, "1", {
    send: () => {},
    sendSection: () => {},
    bounds: () => null,
    changed: () => {},
  });

describe("roles by groups", () => {
  const given = [
    { id: 1, name: "Diggers", people: 3, role: "annotator" },
    { id: 2, name: "Guests", people: 9, role: "viewer" },
    { id: 3, name: "Students", people: 12, role: "annotator" },
    { id: 4, name: "Heads", people: 1, role: "curator" },
  ] as const;

  it("the highest of those that a person is in counts, and all that give it are told", () => {
    expect(roleByGroups(given, ["Guests", "Students", "Diggers"])).toEqual({
      role: "annotator",
      groups: ["Diggers", "Students"],
    });
    expect(roleByGroups(given, ["Guests"])).toEqual({ role: "viewer", groups: ["Guests"] });
    expect(roleByGroups(given, ["Heads", "Guests"])).toEqual({
      role: "curator",
      groups: ["Heads"],
    });
  });

  it("groups that have no role there, and none at all, give nothing", () => {
    expect(roleByGroups(given, ["Others"])).toBeNull();
    expect(roleByGroups(given, [])).toBeNull();
    expect(roleByGroups([], ["Diggers"])).toBeNull();
  });
});

describe("what people are called", () => {
  it("one or two letters stand for a person", () => {
    const of = (user: string, fullName = ""): string => initials({ user, full_name: fullName });
    expect(of("ada", "Ada Lovelace")).toBe("AL");
    expect(of("x", "  maría de los Ángeles  Ochoa ")).toBe("MO");
    expect(of("x", "Lena Hoff (recorded)")).toBe("LH");
    expect(of("ada")).toBe("A");
    expect(of("ada.lovelace@museum")).toBe("AM");
    expect(of("x", "李小龙")).toBe("李");
    expect(of("...")).toBe("?");
  });
  it("the full name where there is one", () => {
    expect(called(person("ada", "Ada Lovelace"))).toBe("Ada Lovelace");
    expect(called(person("ada", "  "))).toBe("ada");
  });
  it("names for signing in are the server's", () => {
    expect(
      ["a", "Ada", "ada.l@x-y_z", "4da", "a".repeat(64)].filter((name) => !isUserName(name)),
    ).toEqual([]);
    expect(["", ".ada", "-a", "ada l", "ädä", "a/b", "a".repeat(65)].filter(isUserName)).toEqual(
      [],
    );
  });
});

describe("passwords", () => {
  it("are told what is wrong with them before they are sent", () => {
    expect(passwordMistake("ada", "123456789", "123456789")).toEqual({
      field: "password",
      kind: "too_short",
    });
    expect(passwordMistake("Ada.Lovelace", "ada.lovelace", "ada.lovelace")).toEqual({
      field: "password",
      kind: "is_the_name",
    });
    expect(passwordMistake("ada", "1234567890", "123456789O")).toEqual({
      field: "repeat",
      kind: "differs",
    });
    expect(passwordMistake("ada", "1234567890", "1234567890")).toBeNull();
  });
  it("a character is one, however many bytes it takes", () => {
    expect(passwordMistake("ada", "𓂀".repeat(9), "𓂀".repeat(9))?.kind).toBe("too_short");
    expect(passwordMistake("ada", "𓂀".repeat(10), "𓂀".repeat(10))).toBeNull();
  });
  it("each mistake has its words", () => {
    expect(passwordWords({ field: "password", kind: "too_short" })).toContain("10");
    expect(passwordWords({ field: "repeat", kind: "differs" })).toBe(texts.password.differs);
  });
});

describe("roles", () => {
  it("nobody makes another owner, nor gives more than they have", () => {
    expect(rolesToGive("owner")).toEqual([
      "guest",
      "viewer",
      "annotator",
      "curator",
      "administrator",
    ]);
    expect(rolesToGive("administrator")).toEqual([
      "guest",
      "viewer",
      "annotator",
      "curator",
      "administrator",
    ]);
    expect(rolesToGive("curator")).toEqual(["guest", "viewer", "annotator", "curator"]);
  });
  it("a token may have what its person has", () => {
    expect(rolesOfTokens("viewer")).toEqual(["viewer"]);
    expect(rolesOfTokens("owner").at(-1)).toBe("owner");
    expect(rolesOfTokensIn("owner")).toEqual(["viewer", "annotator", "curator"]);
    expect(rolesOfTokensIn("annotator")).toEqual(["viewer", "annotator"]);
  });
  it("administrators and the owner look after people", () => {
    expect(
      (["viewer", "annotator", "curator", "administrator", "owner"] as const).filter(mayAdminister),
    ).toEqual(["administrator", "owner"]);
  });
  it("nobody changes themselves, the owner, or whoever may do as much", () => {
    const administrator = { user: "bea", role: "administrator" } as const;
    expect(mayChange(administrator, person("ada"))).toBe(true);
    expect(mayChange(administrator, person("bea", "", { role: "administrator" }))).toBe(false);
    expect(mayChange(administrator, person("carl", "", { role: "administrator" }))).toBe(false);
    expect(
      mayChange({ user: "owner", role: "owner" }, person("carl", "", { role: "administrator" })),
    ).toBe(true);
    expect(mayChange(administrator, person("owner", "", { role: "owner" }))).toBe(false);
    expect(mayChange({ user: "carl", role: "curator" }, administrator)).toBe(false);
  });
});

describe("finding people", () => {
  const people = [
    person("ada", "Ada Lovelace"),
    person("grace.h", "Grace Hopper", { role: "curator" }),
    person("o.a@dig", "Olga Adler", { state: "disabled" }),
  ];
  const found = (text: string): string[] =>
    findPeople(people, text, ({ role, state }) => `${role} ${state}`).map(({ user }) => user);
  it("by the beginnings of their names, in any case, and by what they may do", () => {
    expect(found("")).toEqual(["ada", "grace.h", "o.a@dig"]);
    expect(found("AD")).toEqual(["ada", "o.a@dig"]);
    expect(found("love ada")).toEqual(["ada"]);
    expect(found("cur")).toEqual(["grace.h"]);
    expect(found("disabled")).toEqual(["o.a@dig"]);
    expect(found("grace.h")).toEqual(["grace.h"]);
    expect(found("race")).toEqual([]);
  });
});

describe("browsers", () => {
  const told = (agent: string): string => {
    const { browser, system } = browserOf(agent);
    return texts.account.browser(browser, system);
  };
  it.each([
    ["Mozilla/5.0 (X11; Linux x86_64; rv:128.0) Gecko/20100101 Firefox/128.0", "Firefox on Linux"],
    [
      "Mozilla/5.0 (Windows NT 10.0; Win64; x64) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/126.0.0.0 Safari/537.36",
      "Chrome on Windows",
    ],
    [
      "Mozilla/5.0 (Windows NT 10.0; Win64; x64) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/126.0.0.0 Safari/537.36 Edg/126.0.0.0",
      "Edge on Windows",
    ],
    [
      "Mozilla/5.0 (Windows NT 10.0) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/126.0.0.0 Safari/537.36 OPR/112.0.0.0",
      "Opera on Windows",
    ],
    [
      "Mozilla/5.0 (Macintosh; Intel Mac OS X 10_15_7) AppleWebKit/605.1.15 (KHTML, like Gecko) Version/17.5 Safari/605.1.15",
      "Safari on macOS",
    ],
    [
      "Mozilla/5.0 (iPhone; CPU iPhone OS 17_5 like Mac OS X) AppleWebKit/605.1.15 (KHTML, like Gecko) Version/17.5 Mobile/15E148 Safari/604.1",
      "Safari on iPhone",
    ],
    [
      "Mozilla/5.0 (iPad; CPU OS 17_5 like Mac OS X) AppleWebKit/605.1.15 (KHTML, like Gecko) CriOS/126.0 Mobile/15E148 Safari/604.1",
      "Chrome on iPad",
    ],
    [
      "Mozilla/5.0 (Linux; Android 14; SM-S921B) AppleWebKit/537.36 (KHTML, like Gecko) SamsungBrowser/25.0 Chrome/121.0.0.0 Mobile Safari/537.36",
      "Samsung Internet on Android",
    ],
    [
      "Mozilla/5.0 (X11; CrOS x86_64 14541.0.0) AppleWebKit/537.36 (KHTML, like Gecko) Chrome/126.0.0.0 Safari/537.36",
      "Chrome on ChromeOS",
    ],
    ["curl/7.88.1", "curl"],
    ["Mozilla/5.0", texts.account.browser("", "")],
    ["", texts.account.browser("", "")],
  ])("%s", (agent, name) => expect(told(agent)).toBe(name));
});

describe("moments", () => {
  const now = new Date(2026, 4, 4, 12, 0);
  const at = (...parts: [number, number, number, number, number]): string =>
    toldTime(new Date(...parts).toISOString(), now);
  it("are told by their day, those of late by its name", () => {
    expect(at(2026, 4, 4, 9, 5)).toBe("today, 09:05");
    expect(at(2026, 4, 3, 23, 59)).toBe("yesterday, 23:59");
    expect(at(2026, 4, 2, 9, 5)).toBe("2 May 2026, 09:05");
    expect(toldDate(new Date(2027, 0, 31, 5).toISOString())).toBe("31 Jan 2027");
  });
});

describe("coming in", () => {
  it("an invitation has an address of its own, and its secret is in the fragment", () => {
    expect(routeOf("/join")).toEqual({ page: "join" });
    expect(routeOf("/join/")).toEqual({ page: "join" });
    expect(routeOf("/joiner")).toEqual({ page: "home", project: null });
    expect(invitationOf("#3q2-7wAAqrs_")).toBe("3q2-7wAAqrs_");
    expect(["", "#", "#a b", "#<x>"].map(invitationOf)).toEqual(["", "", "", ""]);
  });
  it("a pasted link of the server is opened, whatever stands around it", () => {
    expect(loginPathOf("see http://127.0.0.1:8080/login?link=3q2-7wAA, please")).toBe(
      "/login?link=3q2-7wAA",
    );
    expect(loginPathOf("3q2-7wAAqrs")).toBeNull();
  });
  it("a refused sign-in says what does not fit, and when to go on", () => {
    expect(signInProblem(refusal(401), "password")).toBe(texts.sign_in.wrong);
    expect(signInProblem(refusal(401), "token")).toBe(texts.sign_in.token_wrong);
    expect(signInProblem(refusal(403, { detail: "For scripts." }), "token")).toBe("For scripts.");
    expect(signInProblem(refusal(429, { detail: "Wait ten seconds." }), "password")).toBe(
      "Wait ten seconds.",
    );
    expect(signInProblem(refusal(429, { detail: "Wait ten seconds." }), "token")).toBe(
      "Wait ten seconds.",
    );
    expect(signInProblem(refusal(0, { detail: "Away." }), "password")).toBe("Away.");
    expect(signInProblem(refusal(503, { detail: "It starts." }), "token")).toBe("It starts.");
  });
  it("a link is useless when the server does not know it, but not when the password is bad", () => {
    expect(
      [refusal(401), refusal(404), refusal(422, { field: "invitation" })].every(isUselessLink),
    ).toBe(true);
    expect(
      [refusal(422, { field: "password" }), refusal(429), refusal(0), refusal(503)].some(
        isUselessLink,
      ),
    ).toBe(false);
  });
});

describe("the interface", () => {
  it("has the server keep no answer with a secret for a repeated call", async () => {
    const { api, asked } = apiOf(...Array.from({ length: 7 }, (): [number, unknown] => [200, {}]));
    await api.json("POST /login", { body: { user: "ada", password: "x" } });
    await api.json("POST /invitations/accept", { body: { invitation: "i", password: "x" } });
    await api.send("POST /me/password", { body: { password: "x" } });
    await api.json("POST /me/tokens", { body: { name: "n" } });
    await api.json("POST /users", { body: { user: "ada" } });
    await api.json("POST /users/{user}/invite", { path: { user: "a@b" } });
    await createLayer(api, 1, { name: "L" }).catch(() => {});
    expect(asked.map(({ what, headers }) => [what, "Idempotency-Key" in headers])).toEqual([
      ["POST /api/v1/login", false],
      ["POST /api/v1/invitations/accept", false],
      ["POST /api/v1/me/password", false],
      ["POST /api/v1/me/tokens", false],
      ["POST /api/v1/users", false],
      ["POST /api/v1/users/a%40b/invite", false],
      ["POST /api/v1/models/1/layers", true],
    ]);
  });
  it("brings all people, page by page", async () => {
    const page = (from: number, to: number): Person[] =>
      Array.from({ length: to - from }, (_, n) => person(`p${from + n}`));
    const next = { Link: '</api/v1/users?limit=1000&after=WyJh>; rel="next"' };
    const { api, asked } = apiOf(
      [200, { users: page(0, 1000), total: 1200 }, next],
      [200, { users: page(1000, 1200), total: 1200 }],
    );
    expect((await api.all("GET /users", "users")).length).toBe(1200);
    expect(asked.map(({ what }) => what)).toEqual([
      "GET /api/v1/users?limit=1000",
      "GET /api/v1/users?limit=1000&after=WyJh",
    ]);
  });
  it("ends although people went away between two pages", async () => {
    const { api } = apiOf(
      [
        200,
        { users: [person("a")], total: 3 },
        { Link: '</api/v1/users?after=x>; rel="next", </api/v1/users?offset=0>; rel="prev"' },
      ],
      [200, { users: [], total: 1 }],
    );
    expect((await api.all("GET /users", "users")).map(({ user }) => user)).toEqual(["a"]);
  });
  it("follows no link that leads elsewhere", () => {
    for (const link of [
      null,
      "",
      '<https://else.example/api/v1/users>; rel="next"',
      '</users>; rel="next"',
      '</api/v1/users>; rel="prev"',
    ])
      expect(nextPage(link)).toBeNull();
  });
  it("names the version in every change of what has one", async () => {
    const seen: [number, unknown, Record<string, string>] = [
      200,
      { palette: {} },
      { ETag: '"v7"' },
    ];
    const ofWhateverIsThere: ((api: Api) => Promise<unknown>)[] = [
      (api) =>
        api.json("PATCH /tables/{table}", {
          path: { table: "units" },
          body: { title_column: "3" },
          header: kAsItIs,
        }),
      (api) =>
        api.json("PATCH /tables/{table}/columns/{column}", {
          path: { table: "units", column: "depth" },
          body: { name: "Depth" },
          header: kAsItIs,
        }),
      (api) =>
        api.send("DELETE /tables/{table}/columns/{column}", {
          path: { table: "units", column: "depth" },
          header: kAsItIs,
        }),
      (api) => changeRecord(api, "units", 1, { values: {} }),
      (api) =>
        api.send("DELETE /tables/{table}/records/{key}", {
          path: { table: "units", key: 1 },
          query: { texels: "clear" },
          header: kAsItIs,
        }),
      (api) =>
        api.send("DELETE /models/{model}/looks/{look}", {
          path: { model: 1, look: 2 },
          header: kAsItIs,
        }),
    ];
    for (const change of ofWhateverIsThere) {
      const { api, asked } = apiOf([200, {}]);
      await change(api);
      expect(asked.map(({ headers }) => headers["If-Match"])).toEqual(["*"]);
    }
    const changes: ((api: Api) => Promise<unknown>)[] = [
      (api) => appearanceOf(api).rename({ id: 2 } as Look, "x"),
      (api) => changeLayer(api, 1, 2, { name: "x" }),
      (api) =>
        api.deleteAsRead("DELETE /models/{model}/layers/{layer}", { path: { model: 1, layer: 2 } }),
      (api) => api.deleteAsRead("DELETE /models/{model}", { path: { model: 1 } }),
      (api) => api.deleteAsRead("DELETE /tables/{table}", { path: { table: "units" } }),
      (api) => api.deleteAsRead("DELETE /projects/{project}", { path: { project: "villa" } }),
    ];
    for (const change of changes) {
      const { api, asked } = apiOf(seen, [200, { palette: {} }]);
      await change(api);
      expect(asked.map(({ headers }) => headers["If-Match"])).toEqual([undefined, '"v7"']);
    }
    const { api, asked } = apiOf([200, {}]);
    await changeRecord(api, "units", 1, { values: {}, version: 4 });
    expect(asked[0]!.headers["If-Match"]).toBe('"v4"');
  });
});
