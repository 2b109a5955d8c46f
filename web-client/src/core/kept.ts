// A value that the browser stores for the page. If the browser cannot store it, because its storage
// is full or disabled, the value lasts until the page is closed.

export class Kept<T> {
  private _value: T;

  constructor(
    private readonly _storage: () => Storage | undefined,
    private readonly _name: string,
    first: T,
  ) {
    this._value = first;
    try {
      const text = _storage()?.getItem(_name);
      if (text) this._value = JSON.parse(text) as T;
    } catch {
      // The stored text is not from this page or cannot be read, so the default applies.
    }
  }

  get value(): T {
    return this._value;
  }

  set value(value: T) {
    this._value = value;
    try {
      this._storage()?.setItem(this._name, JSON.stringify(value));
    } catch {
      this.forget(); // the value remains in memory only
    }
  }

  /** Removes the stored value, so it does not return in place of one that could not be stored. */
  private forget(): void {
    try {
      this._storage()?.removeItem(this._name);
    } catch {
      // The storage is disabled and contains no value.
    }
  }
}
