import { afterEach, expect, test, vi } from "vitest";
import { countedFetch } from "../../src/net/counted-fetch";

const dataset: Record<string, string> = {};
vi.stubGlobal("document", { documentElement: { dataset } });

afterEach(() => vi.unstubAllGlobals());

test("a request counts until its answer begins or fails", async () => {
  const waiting: PromiseWithResolvers[] = [];
  vi.stubGlobal(
    "fetch",
    () => new Promise<Response>((resolve, reject) => waiting.push({ resolve, reject })),
  );
  const good = countedFetch("/api/v1/me");
  const bad = countedFetch("/api/v1/models");
  expect(dataset["requests"]).toBe("2");
  waiting[0]?.resolve(new Response("{}"));
  await good;
  expect(dataset["requests"]).toBe("1");
  waiting[1]?.reject(new TypeError("no network"));
  await expect(bad).rejects.toThrow("no network");
  expect(dataset["requests"]).toBe("0");
});

interface PromiseWithResolvers {
  resolve: (answer: Response) => void;
  reject: (why: Error) => void;
}
