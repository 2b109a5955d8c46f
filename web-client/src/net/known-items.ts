// A list of versioned items of one kind. All items are read first, and the server then sends events
// about them. Events during the read take precedence over its result.

import { ApiError } from "./api-error";

export interface Item {
  readonly id: number;
  readonly version: number;
}

export class KnownItems<T extends Item> {
  /** Whether the last read failed. */
  failed = false;
  loaded = false;

  private _known = new Map<number, T>();
  // The events during the read.
  private _reading: { gone: Set<number>; come: Set<number> } | null = null;

  get all(): T[] {
    return [...this._known.values()];
  }
  find(id: number): T | null {
    return this._known.get(id) ?? null;
  }

  /** Reads all items. Returns false if a later read has started, which replaces this one. */
  async load(read: () => Promise<readonly T[]>): Promise<boolean> {
    const reading = (this._reading = { gone: new Set<number>(), come: new Set<number>() });
    let items: readonly T[];
    try {
      items = await read();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (reading !== this._reading) return false;
      this.failed = true;
      return true;
    }
    if (reading !== this._reading) return false;
    this._reading = null;
    this.failed = false;
    this.loaded = true;
    const come = this.all.filter(({ id }) => reading.come.has(id));
    this._known = new Map(
      items.filter(({ id }) => !reading.gone.has(id)).map((item) => [item.id, item]),
    );
    for (const item of come) this.put(item);
    return true;
  }

  /** Stores an item. Returns false if the known item is newer or was deleted. */
  put(item: T): boolean {
    const known = this._known.get(item.id);
    if ((known && known.version > item.version) || this._reading?.gone.has(item.id)) return false;
    this._known.set(item.id, item);
    this._reading?.come.add(item.id);
    return true;
  }

  drop(id: number): void {
    this._reading?.gone.add(id);
    this._known.delete(id);
  }
}
