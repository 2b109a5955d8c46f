// Drags a row of a list by its grip to another position. Only the mouse can drag rows. For
// keyboards and touch, menus or buttons move the rows.

import type { ReactiveController, ReactiveControllerHost } from "lit";

export class DragOrder<Id extends number | string> implements ReactiveController {
  dragged: Id | null = null;
  /** The index of the row after the drop position. */
  before: number | null = null;
  /** The index of the row under the pointer. */
  over: number | null = null;

  /**
   * `move` moves a row to an index of the list without this row. `over` is the index of the row
   * under the pointer, in the list with the moved row, or null.
   */
  constructor(
    private readonly _host: ReactiveControllerHost,
    private readonly _shown: () => readonly Id[],
    private readonly _move: (id: Id, to: number, over: number | null) => void,
  ) {
    _host.addController(this);
  }

  hostDisconnected(): void {
    this.dragged = this.before = null;
  }

  /** Returns the classes of a row, including the mark of the drop position. */
  classes(id: Id, index: number): string {
    return `${this.dragged === id ? "dragged" : ""} ${this.before === index ? "drop-before" : ""}`;
  }

  start(event: DragEvent, id: Id, name: string): void {
    this.put(id, null);
    event.dataTransfer?.setData("text/plain", name);
    const row = (event.target as HTMLElement).closest("li");
    if (row) event.dataTransfer?.setDragImage(row, 12, 18);
  }

  overRow(event: DragEvent, index: number): void {
    if (this.dragged === null) return;
    event.preventDefault();
    this.over = index;
    const box = (event.currentTarget as HTMLElement).getBoundingClientRect();
    this.put(this.dragged, event.clientY < box.top + box.height / 2 ? index : index + 1);
  }

  readonly overList = (event: DragEvent): void => {
    if (this.dragged === null) return;
    event.preventDefault();
    if (event.target === event.currentTarget) this.over = null; // the pointer is between rows
  };

  readonly drop = (event: DragEvent): void => {
    const { dragged, before, over } = this;
    this.end();
    const from = dragged === null ? -1 : this._shown().indexOf(dragged);
    if (dragged === null || before === null || from < 0) return;
    event.preventDefault();
    const to = before > from ? before - 1 : before;
    if (to !== from || over !== from) this._move(dragged, to, over);
  };

  readonly end = (): void => this.put(null, null);

  private put(dragged: Id | null, before: number | null): void {
    if (dragged === this.dragged && before === this.before) return;
    [this.dragged, this.before] = [dragged, before];
    this._host.requestUpdate();
  }
}
