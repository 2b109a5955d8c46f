import { describe, expect, it } from "vitest";

import { fakeApi } from "../../fake-api";
import { splitUp } from "../../../src/features/home/object-actions";
import { ApiError } from "../../../src/net/api-error";

const survey = (model: number): object => ({ model, slug: "s", name: "S", date: "2019" });
const object = { id: 7, name: "Bust", surveys: [] };

function site(refused = 0): { calls: unknown[]; api: ReturnType<typeof fakeApi> } {
  const calls: unknown[] = [];
  const api = fakeApi({
    "GET /projects/{project}/objects/{object}": () => ({
      ...object,
      surveys: [survey(1), survey(4)],
    }),
    "GET /models/{model}": ({ path }) => ({ value: {}, etag: `v${path.model}` }),
    "PATCH /models/{model}": ({ path, body, header }) => {
      if (path.model === refused) throw new ApiError({ title: "Stale", status: 412 });
      calls.push([path.model, body, header]);
    },
    "DELETE /projects/{project}/objects/{object}": ({ path }) => calls.push(path),
  });
  return { calls, api };
}

describe("the deletion of an object", () => {
  it("takes its current models out first", async () => {
    const { calls, api } = site();
    await splitUp(api, "villa", object);
    expect(calls).toEqual([
      [1, { object: 0 }, { "If-Match": "v1" }],
      [4, { object: 0 }, { "If-Match": "v4" }],
      { project: "villa", object: 7 },
    ]);
  });

  it("stops at a model that another user has changed", async () => {
    const { calls, api } = site(4);
    await expect(splitUp(api, "villa", object)).rejects.toThrow(ApiError);
    expect(calls).toHaveLength(1);
  });
});
