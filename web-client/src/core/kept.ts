// A value that this browser keeps for the page. Where it keeps nothing (it is full, or told not
// to), the value lives as long as the page.

export class Kept<T> {
  private value_: T;

  constructor(
    private readonly storage_: () => Storage | undefined,
    private readonly name_: string,
    first: T,
  ) {
    this.value_ = first;
    try {
      const text = storage_()?.getItem(name_);
      if (text) this.value_ = JSON.parse(text) as T;
    } catch {
      // What stands there is not ours, or must not be read: as if there were nothing.
    }
  }

  get value(): T {
    return this.value_;
  }

  set value(value: T) {
    this.value_ = value;
    try {
      this.storage_()?.setItem(this.name_, JSON.stringify(value));
    } catch {
      // It is kept here.
    }
  }
}
