// Change signals. Each part of an open model has a separate signal, so a change redraws only the
// elements that show this part.

type Listener = () => void;

/** `Part` contains the names of the parts. The signal `common` is sent to every listener. */
export class Signals<Part extends string> {
  private readonly _listeners = new Map<Listener, ReadonlySet<Part> | null>();

  constructor(private readonly _common: Part) {}

  /**
   * Subscribes to the changes of these parts, or to all changes if `parts` is empty. Returns a
   * function that unsubscribes.
   */
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
