import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { tellTrashed, toldRestored } from "../../src/ui/trash";
import { fakeApi } from "../fake-api";
import { notices, type Notice } from "../../src/ui/notices";
import { ApiError } from "../../src/net/api-error";
import type { BinRestored } from "../../src/core/protocol.gen";

const cracks: BinRestored = {
  kind: "layer",
  restored: 3,
  name: "Cracks",
  slug: "cracks",
  model: 1,
};

describe("what was deleted", () => {
  let shown: readonly Notice[] = [];
  let forget: () => void;
  const asked: string[] = [];
  let answer: () => Promise<BinRestored>;
  const api = fakeApi({
    "POST /projects/{project}/bin/{entry}/restore": ({ path: { project, entry } }) => {
      asked.push(`${project}/${entry}`);
      return answer();
    },
  });
  const undo = async (): Promise<void> => {
    const link = shown[shown.length - 1]?.link;
    if (!link || !("act" in link)) throw new Error("there is no way back");
    link.act();
    for (let i = 0; i < 10; ++i) await Promise.resolve();
  };

  beforeEach(() => {
    vi.useFakeTimers();
    asked.length = 0;
    answer = () => Promise.resolve(cracks);
    forget = notices.subscribe((all) => (shown = all));
  });
  afterEach(() => {
    vi.runAllTimers();
    vi.useRealTimers();
    forget();
  });

  it("comes back by the notice's button, and that is said", async () => {
    const back: BinRestored[] = [];
    tellTrashed(
      api,
      { kind: "layer", entry: "layer-3", name: "Cracks", project: "villa" },
      (restored) => back.push(restored),
    );
    expect(shown[0]!.title).toContain("Cracks");
    await undo();
    expect(asked).toEqual(["villa/layer-3"]);
    expect(back).toEqual([cracks]);
    expect(shown[shown.length - 1]!.kind).toBe("success");
  });

  it("says why it does not", async () => {
    answer = () =>
      Promise.reject(
        new ApiError({ status: 409, title: "Cannot be restored", detail: "SU 1 is taken." }),
      );
    tellTrashed(api, { kind: "record", entry: "record-5-1", name: "SU 1", project: "villa" }, () =>
      expect.unreachable(),
    );
    await undo();
    expect(shown[shown.length - 1]).toMatchObject({ kind: "problem", title: "Cannot be restored" });
  });

  it("is told with its new short name where that changed", () => {
    expect(toldRestored(cracks)).not.toContain("cracks-2");
    expect(toldRestored({ ...cracks, slug: "cracks-2", former_slug: "cracks" })).toContain(
      "cracks-2",
    );
  });
});
