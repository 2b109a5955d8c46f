import { describe, expect, it, vi } from "vitest";
import { fakeApi } from "../../fake-api";
import { ApiError } from "../../../src/net/api-error";
import type { Job } from "../../../src/core/types";
import { chooseScans, Imports, scanOfParts, type Scan } from "../../../src/features/home/imports";

const scan: Scan = {
  files: [{ file: new File(["ply"], "mesh.ply"), path: "mesh.ply" }],
  name: "a/mesh",
};
const job = (state: Job["state"], more: Partial<Job> = {}): Job => ({
  id: 7,
  state,
  progress: 0,
  message: "",
  ...more,
});
const problem = (status: number): NonNullable<Job["problem"]> => ({
  status,
  title: "Server was restarted",
  detail: "Start it again.",
});

/** Takes the responses to GET /jobs/7 in order: a job, or the status of a refusal. */
function importing(...answers: (Job | number)[]): { imports: Imports; sent: string[] } {
  const sent: string[] = [];
  const api = fakeApi({
    "POST /models": ({ query }) => {
      sent.push(query?.name ?? "");
      return job("queued");
    },
    "GET /jobs/{job}": async () => {
      const next = answers.shift()!;
      if (typeof next === "number") throw new ApiError(problem(next));
      return next;
    },
  });
  return { imports: new Imports(api), sent };
}

describe("an import", () => {
  it("waits for a server that is away, and offers to begin again what a restart ended", async () => {
    vi.useFakeTimers();
    try {
      const { imports, sent } = importing(
        job("running"),
        0,
        503,
        0,
        job("failed", { problem: problem(503) }),
        job("done", { model: 3 }),
      );
      const first = imports.start(scan, "default");
      await vi.runAllTimersAsync();
      expect(await first).toEqual({ model: null, problem: problem(503) });
      expect(imports.entries).toMatchObject([{ name: "a/mesh", state: "failed", mayRepeat: true }]);
      const second = imports.repeat(imports.entries[0]!.key);
      await vi.runAllTimersAsync();
      expect(await second).toEqual({ model: 3, problem: null });
      expect(imports.entries).toEqual([]);
      expect(sent).toEqual(["a/mesh", "a/mesh"]);
    } finally {
      vi.useRealTimers();
    }
  });
  it("that the file itself spoils is not offered again", async () => {
    vi.useFakeTimers();
    try {
      const { imports } = importing(job("failed", { problem: problem(422) }));
      const ending = imports.start(scan, "default");
      await vi.runAllTimersAsync();
      expect((await ending).problem?.status).toBe(422);
      expect(imports.entries).toMatchObject([{ state: "failed", mayRepeat: false }]);
    } finally {
      vi.useRealTimers();
    }
  });
});

describe("several scans as the parts of one model", () => {
  const dropped = (...paths: string[]): { file: File; path: string }[] =>
    paths.map((path) => ({ file: new File(["x"], path.split("/").at(-1)!), path }));

  it("keep their folders and the files that they use", () => {
    const files = dropped(
      "Church/Tower/a.obj",
      "Church/wood.jpg",
      "Church/Nave/a.ply",
      "notes.txt",
    );
    const scan = scanOfParts(chooseScans(files), files);
    expect(scan.name).toBe("Church");
    expect(scan.parts).toBe(true);
    expect(scan.files.map(({ path }) => path)).toEqual([
      "Church/Tower/a.obj",
      "Church/Nave/a.ply",
      "Church/wood.jpg",
    ]);
  });
  it("have the name of the first scan without a common folder", () => {
    const files = dropped("north.ply", "south.ply");
    expect(scanOfParts(chooseScans(files), files).name).toBe("north");
  });
  it("follow an archive that was refused", async () => {
    const queries: unknown[] = [];
    const refused = { ...problem(422), field: "parts" };
    const states: Job[] = [job("failed", { problem: refused }), job("done", { model: 4 })];
    const imports = new Imports(
      fakeApi({
        "POST /models": ({ query }) => {
          queries.push(query?.parts);
          return states.shift()!;
        },
      }),
    );
    const zip: Scan = { files: [{ file: new File(["x"], "a.zip"), path: "a.zip" }], name: "a" };
    expect(await imports.start(zip, "default")).toEqual({ model: null, problem: refused });
    expect(await imports.repeat(imports.entries[0]!.key)).toEqual({ model: 4, problem: null });
    expect(queries).toEqual([undefined, true]);
  });
});
