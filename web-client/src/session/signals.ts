// Who is told of which change. Every part of an open model has a signal of its own, so that a
// change redraws what shows it, and nothing else.

type Listener = () => void;

/**
 * `Part`: names of what may change. `common` concerns everybody: it is told to all listeners,
 * whatever they follow.
 */
export class Signals<Part extends string> {
  private readonly _listeners = new Map<Listener, ReadonlySet<Part> | null>();

  constructor(private readonly _common: Part) {}

  /** Without parts: told of every change. Returns what ends it. */
  subscribe(listener: Listener, parts: readonly Part[] = []): () => void {
    this._listeners.set(listener, parts.length > 0 ? new Set([...parts, this._common]) : null);
    return () => this._listeners.delete(listener);
  }

  clear(): void {
    this._listeners.clear();
  }

  tell(part: Part): void {
    for (const [listener, parts] of this._listeners)
      if (part === this._common || parts === null || parts.has(part)) listener();
  }
}
