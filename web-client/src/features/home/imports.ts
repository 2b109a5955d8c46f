// Running imports: the upload, then the server's job. They are separate from the page's elements,
// so a change of page does not stop them.

import { ApiError } from "../../net/api-error";
import { nameOfFile } from "../../domain/file-names";
import type { Api } from "../../net/api";
import type { Upload } from "../../net/upload";
import type { Job, ProblemBody } from "../../core/types";
import type { DroppedFile } from "../../ui/drop";
import { followJob } from "../../net/follow-job";
import { notices } from "../../ui/notices";
import { texts } from "../../texts";

export type ImportState = "uploading" | Job["state"];

export interface ImportEntry {
  key: number;
  name: string;
  state: ImportState;
  progress: number; // 0 to 1, in the current step
  message: string;
  problem: ProblemBody | null;
  model: number | null;
  /** Whether the import failed for a reason other than the file, so the user can send it again. */
  mayRepeat: boolean;
}

const kScans = /\.(ply|obj|stl|gltf|glb|las|zip)$/i;
// materials, buffers and images that a mesh may refer to
const kCompanions = /\.(mtl|bin|png|jpe?g|tiff?|webp|bmp|tga)$/i;

/**
 * The result of an import. Both members are null if the import was canceled, or refused before it
 * began.
 */
export interface ImportResult {
  model: number | null;
  problem: ProblemBody | null;
}

/**
 * A mesh with the files that it may need. The mesh is the first file. The name of the scan is the
 * file name of the mesh, with folders if other meshes have the same file name.
 */
export type ScanFiles = readonly [DroppedFile, ...DroppedFile[]];
export interface Scan {
  files: ScanFiles;
  name: string;
  /** The files contain several scans, which become the parts of one model. */
  parts?: true;
}

const folderOf = (path: string): string => path.slice(0, path.lastIndexOf("/") + 1);
const stemOf = (path: string): string => path.replace(/\.[^./]*$/, "");

/**
 * Returns the name of each mesh, from its file name. If several meshes have the same file name,
 * their names include as many folders as necessary to be unique.
 */
function namesOf(meshes: readonly DroppedFile[]): Map<DroppedFile, string> {
  const nameOf = ({ path }: DroppedFile, folders: number): string => {
    const parts = path.split("/").slice(-1 - folders);
    return [...parts.slice(0, -1), nameOfFile(parts.at(-1)!)].join("/");
  };
  return new Map(
    meshes.map((mesh) => {
      let folders = 0;
      const depth = mesh.path.split("/").length - 1;
      const isShared = (): boolean =>
        meshes.some((other) => other !== mesh && nameOf(other, folders) === nameOf(mesh, folders));
      while (folders < depth && isShared()) folders += 1;
      return [mesh, nameOf(mesh, folders)];
    }),
  );
}

/**
 * Selects the scans from the dropped files. A single mesh gets all companion files. If there are
 * several meshes, each mesh gets the companion files whose paths start with the path of the mesh
 * without its extension.
 */
export function chooseScans(files: readonly DroppedFile[]): Scan[] {
  const meshes = files.filter(({ path }) => kScans.test(path));
  // without a mesh, each file becomes a scan, so each file gets an error message
  if (meshes.length === 0)
    return files.map((file): Scan => ({ files: [file], name: nameOfFile(file.file.name) }));
  const companions = files.filter(({ path }) => kCompanions.test(path));
  const names = namesOf(meshes);
  return meshes.map((mesh): Scan => {
    const own = companions.filter(
      ({ path }) => meshes.length === 1 || path.startsWith(stemOf(mesh.path)),
    );
    const folder = folderOf(mesh.path);
    const beside = own.map(({ file, path }) => ({
      file,
      path: path.startsWith(folder) ? path.slice(folder.length) : path,
    }));
    return {
      files: [{ file: mesh.file, path: mesh.path.slice(folder.length) }, ...beside],
      name: names.get(mesh)!,
    };
  });
}

/** Reports the files that belong to none of the scans. */
export function tellLeftOut(files: readonly DroppedFile[], scans: readonly Scan[]): void {
  const taken = new Set(scans.flatMap((scan) => scan.files.map(({ file }) => file)));
  const left = files.filter(({ file }) => !taken.has(file));
  if (left.length > 0) notices.show("info", texts.import.left_out(left.length, left[0]!.path));
}

/**
 * Returns one scan of all files, for a model with parts. It has the name of the innermost folder
 * that contains all meshes, or of the first mesh.
 */
export function scanOfParts(scans: readonly Scan[], files: readonly DroppedFile[]): Scan {
  const meshes = files.filter(({ path }) => kScans.test(path));
  const [first, ...others] = meshes.map(({ path }) => folderOf(path).split("/").slice(0, -1));
  let common = first?.length ?? 0;
  for (const folders of others) {
    const end = folders.findIndex((name, place) => name !== first![place]);
    common = Math.min(common, end < 0 ? folders.length : end);
  }
  const rest = files.filter(({ path }) => kCompanions.test(path));
  return {
    files: [...meshes, ...rest] as unknown as ScanFiles,
    name: first?.[common - 1] ?? scans[0]!.name,
    parts: true,
  };
}

/** Returns whether the server restarted or was unreachable, so the file is not the cause. */
const mayRepeat = (status: number): boolean => status === 0 || status >= 500 || status === 429;

/** Whether the import was refused because a zip file contains several scans. */
export const hasSeveralScans = ({ problem }: ImportEntry): boolean => problem?.field === "parts";

export class Imports {
  entries: readonly ImportEntry[] = [];
  private _nextKey = 1;
  private readonly _uploads = new Map<number, Upload<Job>>();
  private readonly _sent = new Map<number, { scan: Scan; project: string }>();
  private readonly _jobs = new Map<number, Job["id"]>();
  private readonly _listeners = new Set<() => void>();

  constructor(private readonly _api: Api) {}

  subscribe(listener: () => void): () => void {
    this._listeners.add(listener);
    return () => this._listeners.delete(listener);
  }

  /** Imports the scan into a project, given by its slug. */
  async start(scan: Scan, project: string): Promise<ImportResult> {
    const [{ file }] = scan.files;
    const refusal = !kScans.test(file.name)
      ? texts.import.wrong_kind(file.name)
      : file.size === 0
        ? texts.import.empty_file(file.name)
        : null;
    if (refusal) {
      notices.show("problem", refusal);
      return { model: null, problem: null };
    }
    const key = this._nextKey++;
    const entry: ImportEntry = {
      key,
      name: scan.name,
      state: "uploading",
      progress: 0,
      message: "",
      problem: null,
      model: null,
      mayRepeat: false,
    };
    this.entries = [...this.entries, entry];
    this._sent.set(key, { scan, project });
    this.tell();
    try {
      const upload = this._api.upload(
        "POST /models",
        {
          query: {
            name: scan.name,
            filename: scan.files[0].file.name,
            project,
            unit: "proposed",
            up: "proposed",
            ...(scan.parts ? { parts: true } : {}),
          },
        },
        scan.files,
        (progress) => this.change(key, { progress }),
      );
      this._uploads.set(key, upload);
      const job = await upload.done;
      this._uploads.delete(key);
      this._jobs.set(key, job.id);
      return await this.follow(key, job);
    } catch (error) {
      return this.fail(key, error);
    }
  }

  async cancel(key: number): Promise<void> {
    this._uploads.get(key)?.cancel();
    const job = this._jobs.get(key);
    if (job !== undefined) await this._api.send("DELETE /jobs/{job}", { path: { job } });
  }

  /**
   * Repeats a failed import from the start. An archive with several scans that was refused now
   * becomes a model with parts.
   */
  async repeat(key: number): Promise<ImportResult> {
    const sent = this._sent.get(key);
    const entry = this.entries.find((each) => each.key === key);
    this.dismiss(key);
    if (!sent) return { model: null, problem: null };
    const scan: Scan = entry && hasSeveralScans(entry) ? { ...sent.scan, parts: true } : sent.scan;
    return this.start(scan, sent.project);
  }

  dismiss(key: number): void {
    this._sent.delete(key);
    this.entries = this.entries.filter((entry) => entry.key !== key);
    this.tell();
  }

  private async follow(key: number, first: Job): Promise<ImportResult> {
    const job = await followJob(this._api, first, ({ state, progress, message, problem }) =>
      this.change(key, { state, progress, message, problem: problem ?? null }),
    );
    if (job.state === "failed")
      this.change(key, { mayRepeat: mayRepeat(job.problem?.status ?? 500) });
    if (job.state === "failed")
      return { model: null, problem: job.problem ?? { status: 500, title: texts.import.failed } };
    this.dismiss(key);
    return { model: job.model ?? null, problem: null };
  }

  private fail(key: number, error: unknown): ImportResult {
    if (!(error instanceof ApiError)) throw error;
    this._uploads.delete(key);
    if (error.status === 499) {
      this.dismiss(key);
      return { model: null, problem: null };
    }
    this.change(key, {
      state: "failed",
      problem: error.problem,
      mayRepeat: mayRepeat(error.status),
    });
    return { model: null, problem: error.problem };
  }

  private change(key: number, change: Partial<ImportEntry>): void {
    this.entries = this.entries.map((entry) =>
      entry.key === key ? { ...entry, ...change } : entry,
    );
    this.tell();
  }

  private tell(): void {
    for (const listener of this._listeners) listener();
  }
}
