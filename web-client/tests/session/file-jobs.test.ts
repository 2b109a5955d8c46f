import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";

import { ApiError } from "../../src/net/api-error";
import type { Job } from "../../src/core/types";
import { FileJobs } from "../../src/session/file-jobs";
import { LayerJobs } from "../../src/session/layer-jobs";
import { notices, type Notice } from "../../src/ui/notices";
import { fakeApi } from "../fake-api";

const file = { name: "pot-report.pdf", media_type: "application/pdf", bytes: 8 };
const job = (state: string, more: object = {}): Job =>
  ({ id: 5, kind: "report", state, progress: 0.5, message: "", ...more }) as Job;

let now: Job;
let cancelled: number;
let fetchFile: () => Promise<Blob>;
let shown: string[];
let told: readonly Notice[];
let unsubscribe: () => void;
let jobs: LayerJobs;
let files: FileJobs;

beforeEach(() => {
  vi.useFakeTimers();
  [now, cancelled, shown] = [job("running"), 0, []];
  fetchFile = async () => new Blob(["%PDF-1.7"]);
  const api = fakeApi({
    "GET /jobs/{job}": () => now,
    "GET /jobs/{job}/file": () => fetchFile(),
    "DELETE /jobs/{job}": () => void ++cancelled,
  });
  jobs = new LayerJobs(api, "9", () => {});
  files = new FileJobs(api, jobs);
  unsubscribe = notices.subscribe((all) => (told = all));
});
afterEach(() => {
  vi.advanceTimersByTime(120_000); // time after which the notices close
  unsubscribe();
  vi.useRealTimers();
});

const preview = (): Promise<number> =>
  files.preview(
    "Preview: Pot",
    async () => job("queued"),
    (_, name) => shown.push(name),
  );
async function end(last: Job): Promise<void> {
  now = last;
  await vi.advanceTimersByTimeAsync(1000);
}

describe("A preview", () => {
  it("is shown to the dialog that waits for it, and is no longer listed", async () => {
    await preview();
    expect(files.awaitsPreview).toBe(true);
    await vi.advanceTimersByTimeAsync(1000);
    expect(jobs.entries).toMatchObject([{ name: "Preview: Pot", job: { state: "running" } }]);
    await end(job("done", { file }));
    expect([shown, jobs.entries, files.saved, told]).toEqual([["pot-report.pdf"], [], null, []]);
  });

  it("is canceled when its dialog closes", async () => {
    await preview();
    await files.leave();
    expect([cancelled, files.awaited, files.awaitsPreview]).toEqual([1, null, false]);
    await end(job("cancelled"));
    expect([shown, jobs.entries, told]).toEqual([[], [], []]);
  });

  it("that ends after its dialog has closed is neither shown nor offered", async () => {
    await preview();
    vi.spyOn(jobs, "cancel").mockRejectedValue(new ApiError({ status: 503, title: "Away" }));
    await files.leave();
    await end(job("done", { file }));
    expect([shown, jobs.entries, told]).toEqual([[], [], []]);
  });

  it("whose file arrives after its dialog has closed is not shown", async () => {
    let arrive = (_: Blob): void => {};
    fetchFile = () => new Promise((resolve) => (arrive = resolve));
    await preview();
    await end(job("done", { file }));
    await files.leave();
    arrive(new Blob(["%PDF-1.7"]));
    await vi.advanceTimersByTimeAsync(0);
    expect([shown, jobs.entries, cancelled]).toEqual([[], [], 0]);
  });

  it("whose file the server no longer has is not shown, and a notice says so", async () => {
    fetchFile = async () => {
      throw new ApiError({ status: 404, title: "This file is gone" });
    };
    await preview();
    await end(job("done", { file }));
    expect([shown, jobs.entries, told.map(({ title }) => title)]).toEqual([
      [],
      [],
      ["This file is gone"],
    ]);
  });
});

describe("A report", () => {
  it("goes on when its dialog closes, and a notice offers the file", async () => {
    await preview();
    await end(job("done", { file }));
    await files.start("Report: Pot", "Ready", async () => job("queued"));
    expect(files.awaitsPreview).toBe(false);
    await files.leave();
    await end(job("done", { file }));
    expect([cancelled, told.map(({ title }) => title)]).toEqual([0, ["Ready"]]);
  });
});
