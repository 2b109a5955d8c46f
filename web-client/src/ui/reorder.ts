// Moving one of a list to another place, for everyone.

interface Ordered {
  id: number;
  order: number;
}

export interface ReorderHost<T> {
  /** Shown at once, before the server knows. */
  show(all: T[]): void;
  /** Tells the server where this one stands now. */
  save(each: T): Promise<void>;
  /** What the server has; some may have moved already when one could not. */
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
