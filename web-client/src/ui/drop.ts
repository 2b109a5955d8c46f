// Reads dropped files, including those in folders with their paths, and makes elements accept
// drops.

import type { ReactiveController, ReactiveControllerHost } from "lit";

export interface DroppedFile {
  file: File;
  path: string; // includes folders; files of a scan refer to each other by path
}

const kMostFiles = 2000;

export const withoutFolders = (files: readonly File[]): DroppedFile[] =>
  files.map((file) => ({ file, path: file.webkitRelativePath || file.name }));

export const hasFiles = (event: DragEvent): boolean =>
  event.dataTransfer?.types.includes("Files") ?? false;

/**
 * Returns the dropped files. Call this while the event is handled, because its data are invalid
 * afterwards.
 */
export function droppedFiles(data: DataTransfer): Promise<DroppedFile[]> {
  const entries = [...data.items].map((item) => item.webkitGetAsEntry?.() ?? null);
  if (!entries.some((entry) => entry?.isDirectory))
    return Promise.resolve(withoutFolders([...data.files]));
  return allFiles(entries.filter((entry) => entry !== null));
}

async function allFiles(entries: FileSystemEntry[]): Promise<DroppedFile[]> {
  const found: DroppedFile[] = [];
  const waiting = [...entries];
  for (let entry = waiting.shift(); entry && found.length < kMostFiles; entry = waiting.shift()) {
    if (entry.name.startsWith(".")) continue; // skips hidden system files
    if (entry.isDirectory) waiting.push(...(await entriesIn(entry as FileSystemDirectoryEntry)));
    else
      found.push({
        file: await fileOf(entry as FileSystemFileEntry),
        path: entry.fullPath.replace(/^\//, ""),
      });
  }
  return found;
}

const fileOf = (entry: FileSystemFileEntry): Promise<File> =>
  new Promise((resolve, reject) => entry.file(resolve, reject));

/**
 * Returns the entries in a folder. A reader returns one part at a time, and an empty part at the
 * end.
 */
async function entriesIn(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const all: FileSystemEntry[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) =>
      reader.readEntries(resolve, reject),
    );
    if (some.length === 0 || all.length >= kMostFiles) return all;
    all.push(...some);
  }
}

/**
 * Makes an element a drop target for files. Among nested targets, the innermost one receives the
 * files.
 */
export class FileDrop implements ReactiveController {
  private _over = false;

  /**
   * `may` returns whether the element accepts files now. Otherwise an outer target receives them.
   */
  constructor(
    private readonly _host: ReactiveControllerHost & EventTarget,
    private readonly _take: (files: File[]) => void,
    private readonly _may: () => boolean = () => true,
  ) {
    _host.addController(this);
    _host.addEventListener("dragover", (event) => this.onOver(event as DragEvent));
    _host.addEventListener("dragleave", () => this.setOver(false));
    _host.addEventListener("drop", (event) => this.onDrop(event as DragEvent));
  }

  /** Whether files are dragged over the element. */
  get over(): boolean {
    return this._over;
  }

  hostDisconnected(): void {
    this._over = false;
  }

  private setOver(over: boolean): void {
    if (over === this._over) return;
    this._over = over;
    this._host.requestUpdate();
  }

  private isForIt(event: DragEvent): boolean {
    return hasFiles(event) && !event.defaultPrevented && this._may();
  }

  private onOver(event: DragEvent): void {
    const takes = this.isForIt(event);
    if (takes) event.preventDefault();
    this.setOver(takes);
  }

  private onDrop(event: DragEvent): void {
    this.setOver(false);
    if (!this.isForIt(event)) return;
    event.preventDefault();
    void droppedFiles(event.dataTransfer!).then((dropped) =>
      this._take(dropped.map(({ file }) => file)),
    );
  }
}
