// Files that a person drops, those in folders too, with the folders they lie in; and elements that
// take them.

import type { ReactiveController, ReactiveControllerHost } from "lit";

export interface DroppedFile {
  file: File;
  path: string; // with folders: files of one scan call each other by them
}

const kMostFiles = 2000;

export const without_folders = (files: readonly File[]): DroppedFile[] =>
  files.map((file) => ({ file, path: file.webkitRelativePath || file.name }));

export const has_files = (event: DragEvent): boolean =>
  event.dataTransfer?.types.includes("Files") ?? false;

/** Must be called while the event is handled: what it carries is gone afterwards. */
export function dropped_files(data: DataTransfer): Promise<DroppedFile[]> {
  const entries = [...data.items].map((item) => item.webkitGetAsEntry?.() ?? null);
  if (!entries.some((entry) => entry?.isDirectory))
    return Promise.resolve(without_folders([...data.files]));
  return all_files(entries.filter((entry) => entry !== null));
}

async function all_files(entries: FileSystemEntry[]): Promise<DroppedFile[]> {
  const found: DroppedFile[] = [];
  const waiting = [...entries];
  for (let entry = waiting.shift(); entry && found.length < kMostFiles; entry = waiting.shift()) {
    if (entry.name.startsWith(".")) continue; // what systems hide among a person's files
    if (entry.isDirectory) waiting.push(...(await entries_in(entry as FileSystemDirectoryEntry)));
    else
      found.push({
        file: await file_of(entry as FileSystemFileEntry),
        path: entry.fullPath.replace(/^\//, ""),
      });
  }
  return found;
}

const file_of = (entry: FileSystemFileEntry): Promise<File> =>
  new Promise((resolve, reject) => entry.file(resolve, reject));

/** A reader gives a part at a time, and nothing at the end. */
async function entries_in(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
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

/** Makes an element a place for files. Of places within each other the innermost takes them. */
export class FileDrop implements ReactiveController {
  private over_ = false;

  /** `may`: whether it takes any now; files that it does not take are for what is around it. */
  constructor(
    private readonly host_: ReactiveControllerHost & EventTarget,
    private readonly take_: (files: File[]) => void,
    private readonly may_: () => boolean = () => true,
  ) {
    host_.addController(this);
    host_.addEventListener("dragover", (event) => this.on_over(event as DragEvent));
    host_.addEventListener("dragleave", () => this.set_over(false));
    host_.addEventListener("drop", (event) => this.on_drop(event as DragEvent));
  }

  /** Files are held over it. */
  get over(): boolean {
    return this.over_;
  }

  hostDisconnected(): void {
    this.over_ = false;
  }

  private set_over(over: boolean): void {
    if (over === this.over_) return;
    this.over_ = over;
    this.host_.requestUpdate();
  }

  private is_for_it(event: DragEvent): boolean {
    return has_files(event) && !event.defaultPrevented && this.may_();
  }

  private on_over(event: DragEvent): void {
    const takes = this.is_for_it(event);
    if (takes) event.preventDefault();
    this.set_over(takes);
  }

  private on_drop(event: DragEvent): void {
    this.set_over(false);
    if (!this.is_for_it(event)) return;
    event.preventDefault();
    void dropped_files(event.dataTransfer!).then((dropped) =>
      this.take_(dropped.map(({ file }) => file)),
    );
  }
}
