import { describe, expect, it, vi } from "vitest";

import { Sending } from "../../src/ui/sending";
import { ApiError } from "../../src/net/api-error";
import type { Upload } from "../../src/net/upload";

const host = () => ({
  addController: vi.fn(),
  removeController: vi.fn(),
  requestUpdate: vi.fn(),
  updateComplete: Promise.resolve(true),
});

describe("what a dialog sends", () => {
  it("tells how far it is, and gives the answer", async () => {
    const sending = new Sending(host());
    let progress: (share: number) => void = () => {};
    let answer: (text: string) => void = () => {};
    const running = sending.run((tell): Upload<string> => {
      progress = tell;
      return { done: new Promise((resolve) => (answer = resolve)), cancel: () => {} };
    });
    expect(sending.busy).toBe(true);
    progress(0.25);
    expect(sending.share).toBe(0.25);
    answer("done");
    expect(await running).toBe("done");
    expect(sending.busy).toBe(false);
  });

  it("keeps why it was refused, until the next", async () => {
    const sending = new Sending(host());
    const refused = new ApiError({ status: 422, title: "No", detail: "It is cut off." });
    expect(
      await sending.run(() => ({ done: Promise.reject(refused), cancel: () => {} })),
    ).toBeNull();
    expect(sending.problem).toBe("It is cut off.");
    await sending.run(() => ({ done: Promise.resolve(1), cancel: () => {} }));
    expect(sending.problem).toBe("");
  });

  it("gives up for the next one, and when the dialog goes, unless that must not be", () => {
    const sending = new Sending(host());
    const cancel = vi.fn();
    const begin = (): Upload<number> => ({ done: new Promise(() => {}), cancel });
    void sending.run(begin);
    void sending.run(begin);
    expect(cancel).toHaveBeenCalledTimes(1);
    sending.givesUp = false;
    sending.hostDisconnected();
    expect(cancel).toHaveBeenCalledTimes(1);
    sending.givesUp = true;
    sending.hostDisconnected();
    expect(cancel).toHaveBeenCalledTimes(2);
    expect(sending.busy).toBe(false);
  });

  it("a request that was cancelled is no problem to tell", async () => {
    const sending = new Sending(host());
    const cancelled = new ApiError({ status: 499, title: "Cancelled" });
    expect(
      await sending.run(() => ({ done: Promise.reject(cancelled), cancel: () => {} })),
    ).toBeNull();
    expect(sending.problem).toBe("");
  });
});
