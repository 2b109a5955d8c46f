// Files that a person drops, those in folders too, with the folders they lie in.

export interface DroppedFile {
  file: File;
  path: string; // with folders: files of one scan call each other by them
}

const kMostFiles = 2000;

export const without_folders = (files: readonly File[]): DroppedFile[] =>
  files.map((file) => ({ file, path: file.webkitRelativePath || file.name }));

/** Must be called while the event is handled: what it carries is gone afterwards. */
export function dropped_files(data: DataTransfer): Promise<DroppedFile[]> {
  const entries = [...data.items].map((item) => item.webkitGetAsEntry?.() ?? null);
  if (!entries.some((entry) => entry?.isDirectory)) return Promise.resolve(without_folders([...data.files]));
  return all_files(entries.filter((entry) => entry !== null));
}

async function all_files(entries: FileSystemEntry[]): Promise<DroppedFile[]> {
  const found: DroppedFile[] = [];
  const waiting = [...entries];
  for (let entry = waiting.shift(); entry && found.length < kMostFiles; entry = waiting.shift()) {
    if (entry.name.startsWith(".")) continue; // what systems hide among a person's files
    if (entry.isDirectory) waiting.push(...(await entries_in(entry as FileSystemDirectoryEntry)));
    else found.push({ file: await file_of(entry as FileSystemFileEntry), path: entry.fullPath.replace(/^\//, "") });
  }
  return found;
}

const file_of = (entry: FileSystemFileEntry): Promise<File> => new Promise((resolve, reject) => entry.file(resolve, reject));

/** A reader gives a part at a time, and nothing at the end. */
async function entries_in(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const all: FileSystemEntry[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0 || all.length >= kMostFiles) return all;
    all.push(...some);
  }
}
