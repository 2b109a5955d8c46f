// Change signals: each part of an open model has a separate signal, so that a change redraws only
// the elements that show it.

type Listener = () => void;

/** `Part`: the names of the parts. `common` concerns all: it is sent to every listener. */
export class Signals<Part extends string> {
  private readonly _listeners = new Map<Listener, ReadonlySet<Part> | null>();

  constructor(private readonly _common: Part) {}

  /** Without parts: listens to every change. Returns a function that unsubscribes. */
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
