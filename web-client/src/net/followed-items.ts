// The items of one kind that the server keeps for the open model. After the first read, the server's
// events keep them current.

import { ApiError } from "./api-error";
import { KnownItems, type Item } from "./known-items";

/** How the items are read. */
export interface ItemSource<T> {
  all(): Promise<readonly T[]>;
  one(id: number): Promise<T>;
  /** Runs after each change to the list. */
  changed(): void;
}

export class FollowedItems<T extends Item> {
  private readonly _known = new KnownItems<T>();

  constructor(private readonly _source: ItemSource<T>) {}

  get loaded(): boolean {
    return this._known.loaded;
  }
  /** Whether the last request for all items failed. */
  get failed(): boolean {
    return this._known.failed;
  }
  /** The items in order of creation. */
  get all(): T[] {
    return this._known.all.sort((a, b) => a.id - b.id);
  }
  find(id: number): T | null {
    return this._known.find(id);
  }

  async load(): Promise<void> {
    if (await this._known.load(() => this._source.all())) this._source.changed();
  }

  onEvent(event: "created" | "changed" | "deleted", id: number): void {
    if (event === "deleted") this.drop(id);
    else void this.read(id);
  }

  async read(id: number): Promise<void> {
    try {
      this.put(await this._source.one(id));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      // other errors keep the item until all items are loaded again
      if (error.status === 404) this.drop(id);
    }
  }

  put(item: T): void {
    if (this._known.put(item)) this._source.changed();
  }

  drop(id: number): void {
    this._known.drop(id);
    this._source.changed();
  }
}
