// Moves an item of a list to another position, for all users.

interface Ordered {
  id: number;
  order: number;
}

export interface ReorderHost<T> {
  /** Shows the new order before the server confirms it. */
  show(all: T[]): void;
  /** Saves the item's new order on the server. */
  save(each: T): Promise<void>;
  /** Returns the server's list. After a failure, some items may already have moved. */
  reload(): Promise<T[]>;
}

/** Moves `one` to the position `index` of the list, which is ordered from bottom to top. */
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
