// Stores changes in the browser's database until they are durable on the server. When the same user
// opens the model in this browser again, the stored changes are sent with the same ids. If two
// pages of a user send the same change, it is still painted only once.

import type { ChangeMessage } from "./outbox";

const kDatabase = "strata";
const kStore = "unsaved"; // keys: [user, model, creation time in µs, id]
const kChanges: readonly string[] = [
  "stroke.begin",
  "stroke.extend",
  "stroke.end",
  "edit",
  "undo",
  "redo",
] satisfies ChangeMessage["op"][];

type Key = [user: string, model: number, made: number, id: string];

const resultOf = <T>(request: IDBRequest<T>): Promise<T> =>
  new Promise((done, failed) => {
    request.onsuccess = () => done(request.result);
    request.onerror = () => failed(request.error ?? new Error("IndexedDB"));
  });

let database: Promise<IDBDatabase> | null = null;

function open(): Promise<IDBDatabase> {
  if (database) return database;
  const request = indexedDB.open(kDatabase, 1);
  request.onupgradeneeded = () => void request.result.createObjectStore(kStore);
  database = resultOf(request).then((opened) => {
    // The browser closed the database, because its data were deleted or the disk failed.
    opened.onclose = () => (database = null);
    return opened;
  });
  database.catch(() => (database = null));
  return database;
}

const isChange = (row: unknown): row is ChangeMessage =>
  typeof row === "object" &&
  row !== null &&
  "id" in row &&
  typeof row.id === "string" &&
  "op" in row &&
  kChanges.includes(row.op as string);

/**
 * The changes of one user on one model. `failed` is called if the browser cannot store the changes.
 * In this case, they are lost when the page is closed.
 */
export class OfflineQueue {
  private readonly _keys = new Map<string, Key>();
  private _made = 0;

  constructor(
    private readonly _user: string,
    private readonly _model: number,
    private readonly _failed: (why: unknown) => void,
  ) {}

  /** Returns the stored changes in the order of creation. */
  async read(): Promise<ChangeMessage[]> {
    try {
      const store = (await open()).transaction(kStore).objectStore(kStore);
      const mine = IDBKeyRange.bound([this._user, this._model], [this._user, this._model, []]);
      const [keys, rows] = await Promise.all([
        resultOf(store.getAllKeys(mine)),
        resultOf<unknown[]>(store.getAll(mine)),
      ]);
      for (const key of keys as Key[]) this._keys.set(key[3], key);
      return rows.filter(isChange);
    } catch {
      return []; // the next put() reports the failure
    }
  }

  put(message: ChangeMessage): void {
    this._made = Math.max(this._made + 1, Date.now() * 1000);
    const key: Key = [this._user, this._model, this._made, message.id];
    this._keys.set(message.id, key);
    this.change((store) => store.put(message, key));
  }

  remove(ids: readonly string[]): void {
    const keys = ids.map((id) => this._keys.get(id)).filter((key) => key !== undefined);
    for (const id of ids) this._keys.delete(id);
    this.change(...keys.map((key) => (store: IDBObjectStore) => store.delete(key)));
  }

  private change(...changes: ((store: IDBObjectStore) => IDBRequest)[]): void {
    if (changes.length === 0) return;
    const all = async (): Promise<void> => {
      // With relaxed durability, the data persist after the page is closed, but not after a system
      // crash. This avoids a flash write for each batch of a stroke.
      const store = (await open())
        .transaction(kStore, "readwrite", { durability: "relaxed" })
        .objectStore(kStore);
      await Promise.all(changes.map((each) => resultOf(each(store))));
    };
    all().catch(this._failed);
  }
}
