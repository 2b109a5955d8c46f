import { describe, expect, it } from "vitest";
import contract from "../../../protocol/generated/openapi.json";
import { contractTypes } from "../../contract";
import { Api, kAsItIs } from "../../src/net/api";
import type { Call } from "../../src/net/calls";

describe("The types of the HTTP interface", () => {
  it("are those of the contract; `npm run contract` writes them anew", async () => {
    await expect(await contractTypes()).toMatchFileSnapshot("../../src/net/contract.gen.ts");
  });

  it("refuse a change that names no version of what has one", async () => {
    const sent: (string | undefined)[] = [];
    const api = new Api(async (_, init) => {
      sent.push((init!.headers as Record<string, string>)["If-Match"]);
      return new Response("{}");
    });
    const path = { table: 1 };
    // @ts-expect-error the header is missing
    await api.json("PATCH /tables/{table}", { path, body: {} });
    // @ts-expect-error the header is missing here too
    await api.send("DELETE /tables/{table}", { path });
    await api.json("PATCH /tables/{table}", { path, body: {}, header: kAsItIs });
    expect(sent).toEqual([undefined, undefined, "*"]);
  });
});

describe("A key for repeated calls", () => {
  const base = "/api/v1";
  const posts = Object.entries(contract.paths).flatMap(([path, item]) =>
    "post" in item && path.startsWith(`${base}/`)
      ? [{ path: path.slice(base.length), operation: item.post }]
      : [],
  );

  it("is sent with every POST that takes one by the contract", async () => {
    const keyed = posts.filter(({ operation }) =>
      JSON.stringify(operation).includes("#/components/parameters/idempotency_key"),
    );
    expect(keyed.length).toBeGreaterThan(30);
    const keys = new Set<string | undefined>();
    const api = new Api(async (_, init) => {
      keys.add((init!.headers as Record<string, string>)["Idempotency-Key"]);
      return new Response("{}");
    });
    for (const { path } of keyed) await api.send(`POST ${path}` as Call, { path: {} } as never);
    expect(keys).not.toContain(undefined);
    expect(keys.size).toBe(keyed.length);
  });
});
