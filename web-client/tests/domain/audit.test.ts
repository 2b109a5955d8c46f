import { describe, expect, it } from "vitest";

import { changeIn, isFiltered, kAuditActions, kNoFilter, queryOf } from "../../src/domain/audit";
import type { AuditEntry } from "../../src/core/protocol.gen";
import { texts } from "../../src/texts";
import { Api } from "../../src/net/api";

const entry = (details: AuditEntry["details"]): AuditEntry => ({
  id: 1,
  time: "2026-05-04T12:00:00.000Z",
  actor_kind: "person",
  action: "role_changed",
  count: 1,
  details,
});

describe("the filter of the audit log", () => {
  it("asks for nothing without a filter", () => {
    expect(queryOf(kNoFilter)).toEqual({});
    expect(isFiltered(kNoFilter)).toBe(false);
  });

  it("includes the whole last day", () => {
    const filter = { ...kNoFilter, actor: " ada ", from: "2026-02-27", to: "2026-02-28" };
    expect(isFiltered(filter)).toBe(true);
    expect(queryOf(filter)).toEqual({
      actor: "ada",
      from: new Date(2026, 1, 27).toISOString(),
      to: new Date(2026, 2, 1).toISOString(),
    });
  });

  it("ignores a day that is not complete", () => {
    expect(queryOf({ ...kNoFilter, from: "2026-02" })).toEqual({});
  });

  it("has a name for each action", () => {
    expect(Object.keys(texts.audit.actions).sort()).toEqual([...kAuditActions].sort());
  });
});

describe("an entry of the audit log", () => {
  it("shows both values of a change, or the only one", () => {
    const name = (value: string): string => value.toUpperCase();
    expect(changeIn(entry({ before: "viewer", after: "curator" }), name)).toBe("VIEWER → CURATOR");
    expect(changeIn(entry({ after: "curator" }), name)).toBe("CURATOR");
    expect(changeIn(entry({ before: false, after: true }), name)).toBe("FALSE → TRUE");
    expect(changeIn(entry({}), name)).toBe("");
  });
});

describe("a page of the audit log", () => {
  it("continues at the address that the server names", async () => {
    const asked: string[] = [];
    const api = new Api(async (path) => {
      asked.push(path);
      const link = '</api/v1/audit?limit=100&after=abc>; rel="next"';
      return new Response(JSON.stringify({ entries: [], days: 730 }), {
        headers: asked.length === 1 ? { Link: link } : {},
      });
    });
    const first = await api.page("GET /audit", { query: { action: "export", limit: 100 } });
    expect(first.next).toBe("/audit?limit=100&after=abc");
    expect((await api.page("GET /audit", {}, first.next)).next).toBeNull();
    expect(asked).toEqual([
      "/api/v1/audit?action=export&limit=100",
      "/api/v1/audit?limit=100&after=abc",
    ]);
  });
});
