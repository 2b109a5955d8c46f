// Moves an item of a list to another place, for everyone.

interface Ordered {
  id: number;
  order: number;
}

export interface ReorderHost<T> {
  /** Shown before the server confirms. */
  show(all: T[]): void;
  /** Saves the item's new order on the server. */
  save(each: T): Promise<void>;
  /** The server's list; after a failure some items may have moved already. */
  reload(): Promise<T[]>;
}

/** Moves `one` to the place `index` of the list, which is bottom to top. */
export async function reorder<T extends Ordered>(
  all: readonly T[],
  one: T,
  index: number,
  host: ReorderHost<T>,
): Promise<void> {
  const wanted = all.filter((other) => other.id !== one.id);
  wanted.splice(Math.max(0, Math.min(index, wanted.length)), 0, one);
  const moved = wanted.map((each, order) => ({ ...each, order }));
  host.show(moved);
  try {
    for (const each of moved) {
      if (all.find((old) => old.id === each.id)?.order !== each.order) await host.save(each);
    }
  } catch (error) {
    host.show(await host.reload().catch(() => [...all]));
    throw error;
  }
}
