// A value that this browser keeps for the page. Where it keeps nothing (it is full, or told not
// to), the value lives as long as the page.

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
      // What stands there is not ours, or must not be read: as if there were nothing.
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
      // It is kept here.
    }
  }
}
