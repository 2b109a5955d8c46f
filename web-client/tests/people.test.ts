import { describe, expect, it } from "vitest";

import { login_path_of, sign_in_problem } from "../src/app/entry";
import { texts } from "../src/app/texts";
import { Api, ApiError } from "../src/core/api";

const refusal = (status: number, more: { field?: string; detail?: string } = {}): ApiError => new ApiError({ status, title: "Refused", ...more });

/** An interface whose server gives these answers in turn, and what it was asked. */
function api_of(...answers: [status: number, body: unknown][]): { api: Api; asked: { what: string; body: unknown; headers: Record<string, string> }[] } {
  const asked: { what: string; body: unknown; headers: Record<string, string> }[] = [];
  const api = new Api(async (path, init) => {
    const [status, body] = answers[asked.length] ?? [500, {}];
    const sent = typeof init!.body === "string" ? (JSON.parse(init!.body) as unknown) : null;
    asked.push({ what: `${init!.method} ${path}`, body: sent, headers: init!.headers as Record<string, string> });
    return new Response(JSON.stringify(body), { status });
  });
  return { api, asked };
}

describe("coming in", () => {
  it("a pasted link of the server is opened, whatever stands around it", () => {
    expect(login_path_of("see http://127.0.0.1:8080/login?link=3q2-7wAA, please")).toBe("/login?link=3q2-7wAA");
    expect(login_path_of("3q2-7wAAqrs")).toBeNull();
  });
  it("a refused sign-in says what does not fit, and when to go on", () => {
    expect(sign_in_problem(refusal(401), "password")).toBe(texts.sign_in.wrong);
    expect(sign_in_problem(refusal(401), "token")).toBe(texts.sign_in.token_wrong);
    expect(sign_in_problem(refusal(403, { detail: "For scripts." }), "token")).toBe("For scripts.");
    expect(sign_in_problem(refusal(429, { detail: "Wait ten seconds." }), "password")).toBe("Wait ten seconds.");
    expect(sign_in_problem(refusal(429, { detail: "Wait ten seconds." }), "token")).toBe("Wait ten seconds.");
    expect(sign_in_problem(refusal(0, { detail: "Away." }), "password")).toBe("Away.");
    expect(sign_in_problem(refusal(503, { detail: "It starts." }), "token")).toBe("It starts.");
  });
});

describe("the interface", () => {
  it("has the server keep no answer with a secret for a repeated call", async () => {
    const { api, asked } = api_of(...Array.from({ length: 2 }, (): [number, unknown] => [200, {}]));
    await api.login({ user: "ada", password: "x" });
    await api.create_layer(1, { name: "L" } as never).catch(() => {});
    expect(asked.map(({ what, headers }) => [what, "Idempotency-Key" in headers])).toEqual([
      ["POST /api/v1/login", false],
      ["POST /api/v1/models/1/layers", true],
    ]);
  });
});
