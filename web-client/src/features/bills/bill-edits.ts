// The open bill: its draft with undo and redo, its saved version, and its quantities.

import type { Bill, BillItem, BillPosition, BillQuantities } from "../../core/protocol.gen";
import {
  bodyOf,
  draftOf,
  inserted,
  removed,
  replaced,
  type BillDraft,
  type ItemKind,
} from "../../domain/bills";
import type { Api } from "../../net/api";
import { ApiError } from "../../net/api-error";

const kMostSteps = 200;

export interface BillProblem {
  /** The field of the contract, such as "items[3].rules[0].where", or "". */
  field: string;
  /** Empty for a number that is not valid. */
  text: string;
}

interface Step {
  draft: BillDraft;
  chosen: number | null;
}

export class BillEdits {
  draft: BillDraft | null = null;
  /** The index of the selected item. */
  chosen: number | null = null;
  problem: BillProblem | null = null;
  /** Whether another user has saved the bill since this user loaded it. */
  isOutdated = false;
  isBusy = false;
  quantities: BillQuantities | null = null;
  measuringProblem = "";
  private _running: Promise<unknown> = Promise.resolve(); // the last saving
  private _saved: BillDraft | null = null;
  private _etag = "";
  private _past: Step[] = [];
  private _future: Step[] = [];
  private _key = ""; // consecutive changes with the same key are one step
  private _measured: readonly BillItem[] | null = null; // the saved items of the quantities
  private _measuring: AbortController | null = null;

  constructor(
    private readonly _api: Api,
    private readonly _project: string,
    private readonly _bill: number,
    private readonly _changed: () => void,
  ) {}

  get path(): { project: string; bill: number } {
    return { project: this._project, bill: this._bill };
  }
  get isChanged(): boolean {
    return this.draft !== this._saved;
  }
  get canUndo(): boolean {
    return this._past.length > 0;
  }
  get canRedo(): boolean {
    return this._future.length > 0;
  }
  get isMeasuring(): boolean {
    return this._measuring !== null;
  }
  /** Whether the items differ from those that were measured. */
  get isStale(): boolean {
    return this.quantities !== null && this.draft?.items !== this._measured;
  }
  get item(): BillItem | null {
    return this.chosen === null ? null : (this.draft?.items[this.chosen] ?? null);
  }

  /** Returns the measured position with this number. */
  measured(number: string): BillPosition | null {
    return this.quantities?.positions.find((position) => position.number === number) ?? null;
  }

  // ── the draft ──────────────────────────────────────────────────────────────────────────────────

  async load(): Promise<void> {
    await this.attempt(async () => {
      const call = "GET /projects/{project}/bills/{bill}";
      const { value, etag } = await this._api.versioned(call, { path: this.path });
      this.take(value, etag);
    });
  }

  private take(bill: Bill, etag: string): void {
    const chosen = this.item?.number;
    this.draft = this._saved = draftOf(bill);
    this._etag = etag;
    this._past = [];
    this._future = [];
    this.isOutdated = false;
    const index = this.draft.items.findIndex(({ number }) => number === chosen);
    this.chosen = index >= 0 ? index : null;
    this._changed();
  }

  choose(index: number | null): void {
    this.chosen = index;
    this._key = "";
    this._changed();
  }

  rename(name: string): void {
    this.put({ ...this.draft!, name }, this.chosen, "name");
  }

  insert(kind: ItemKind): void {
    const { items, index } = inserted(this.draft!.items, this.chosen, kind);
    this.put({ ...this.draft!, items }, index);
  }

  /** Removes the selected item with its descendants. */
  remove(): void {
    if (this.chosen === null || !this.draft) return;
    const items = removed(this.draft.items, this.chosen);
    const chosen = items.length === 0 ? null : Math.min(this.chosen, items.length - 1);
    this.put({ ...this.draft, items }, chosen);
  }

  /** Replaces the selected item. `key` names the field that changes. */
  change(item: BillItem, key = ""): void {
    const { items, index } = replaced(this.draft!.items, this.chosen!, item);
    this.put({ ...this.draft!, items }, index, key && `${index}.${key}`);
  }

  private put(draft: BillDraft, chosen: number | null, key = ""): void {
    if (key === "" || key !== this._key || this._past.length === 0) {
      this._past = [
        ...this._past.slice(1 - kMostSteps),
        { draft: this.draft!, chosen: this.chosen },
      ];
    }
    this._key = key;
    this._future = [];
    this.draft = draft;
    this.chosen = chosen;
    this.problem = null;
    this._changed();
  }

  undo(): void {
    this.step(this._past, this._future);
  }

  redo(): void {
    this.step(this._future, this._past);
  }

  private step(from: Step[], to: Step[]): void {
    const step = from.pop();
    if (!step) return;
    to.push({ draft: this.draft!, chosen: this.chosen });
    this.draft = step.draft;
    this.chosen = step.chosen;
    this._key = "";
    this.problem = null;
    this._changed();
  }

  // ── the server ─────────────────────────────────────────────────────────────────────────────────

  /** Resolves to whether the bill is saved. */
  /** Waits for a saving that is under way. */
  async settled(): Promise<void> {
    await this._running;
  }

  async save(): Promise<boolean> {
    const { draft } = this;
    if (!draft || this.isBusy) return false;
    if (!this.isChanged) return true;
    const made = bodyOf(draft);
    if ("wrong" in made) {
      this.refuse({ field: made.wrong, text: "" });
      return false;
    }
    return this.attempt(async () => {
      const { value, etag } = await this._api.versioned("PUT /projects/{project}/bills/{bill}", {
        path: this.path,
        body: made.body,
        header: { "If-Match": this._etag },
      });
      this._etag = etag;
      this._saved = draftOf(value); // with the users of hand measurements
      // The user may have typed more in the meantime, or undone a step.
      if (this.draft === draft) this.draft = this._saved;
    });
  }

  /** Saves the draft, and measures the saved bill. */
  async measure(lang: string): Promise<void> {
    if (this.isMeasuring || !(await this.save())) return;
    const items = this.draft!.items;
    const measuring = new AbortController();
    this._measuring = measuring;
    this.measuringProblem = "";
    this._changed();
    try {
      this.quantities = await this._api.json("GET /projects/{project}/bills/{bill}/quantities", {
        path: this.path,
        query: { lang },
        signal: measuring.signal,
      });
      this._measured = items;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (!measuring.signal.aborted) {
        this.measuringProblem = error.message;
        if (error.problem.field) this.refuse({ field: error.problem.field, text: error.message });
      }
    } finally {
      this._measuring = null;
      this._changed();
    }
  }

  cancelMeasuring(): void {
    this._measuring?.abort();
  }

  refuse(problem: BillProblem): void {
    this.problem = problem;
    const index = /^items\[(\d+)\]/.exec(problem.field)?.[1];
    if (index !== undefined && this.draft?.items[Number(index)]) this.chosen = Number(index);
    this._changed();
  }

  private async attempt(work: () => Promise<void>): Promise<boolean> {
    this.isBusy = true;
    this.problem = null;
    this._changed();
    try {
      const running = work();
      this._running = running.catch(() => {});
      await running;
      return true;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 412) this.isOutdated = true;
      else this.refuse({ field: error.problem.field ?? "", text: error.message });
      return false;
    } finally {
      this.isBusy = false;
      this._changed();
    }
  }
}
