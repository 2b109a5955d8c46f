// The person's own steps: reads them from the server, and goes to one of them by undos or redos,
// one after the other.

import type { Api } from "../../net/api";
import { ApiError } from "../../net/api-error";
import { newId } from "../../core/ids";
import type { UndoStep, UndoSteps } from "../../core/protocol.gen";
import { currentOf, listOf, onLayers, turnsTo, type ListedStep } from "../../domain/undo-steps";

const kSteps = 100; // of each kind
const kWaitMs = 300; // another edit follows

export interface StepsHost {
  /** Whether the person can change the layer. */
  mayChange(layer: number): boolean;
  changed(): void;
}

/** How the way to a step ended, and after how many undos or redos. */
export type Outcome =
  | { ended: "there" | "stopped" | "elsewhere"; done: number }
  | { ended: "refused"; done: number; of: number; why: ApiError };

export class Steps {
  /** Newest first; null: not read. */
  list: ListedStep[] | null = null;
  failed = false;
  /** There are earlier steps that the list leaves out. */
  more = false;
  /** Of the undos or redos that lead to a step. */
  progress: { done: number; of: number } | null = null;
  /** On the way to a step, including the reads before and after it. */
  isGoing = false;
  private _known: UndoSteps | null = null;
  private _asked = 0;
  private _stops = false;
  private _timer: ReturnType<typeof setTimeout> | null = null;

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _host: StepsHost,
  ) {}

  /** The newest step in force; null: none of the list. */
  get current(): ListedStep | null {
    return this.list && currentOf(this.list);
  }

  /** Reads the steps, unless they are read on the way to a step anyway. */
  async load(): Promise<void> {
    if (!this.isGoing) await this.read();
  }

  /** Reads them once after several edits. */
  loadSoon(): void {
    this._timer ??= setTimeout(() => {
      this._timer = null;
      void this.load();
    }, kWaitMs);
  }

  private async read(): Promise<void> {
    const question = ++this._asked;
    try {
      const steps = await this._api.json("GET /models/{model}/undo", {
        path: { model: this._modelId },
        query: { limit: kSteps },
      });
      if (question !== this._asked) return;
      this._known = onLayers(steps, (layer) => this._host.mayChange(layer));
      this.list = listOf(this._known);
      this.more = steps.more;
      this.failed = false;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (question !== this._asked) return;
      this.failed = true;
    }
    this._host.changed();
  }

  /**
   * Makes `target` the newest step in force; null: none of the list. Undefined: the way to another
   * step has not ended.
   */
  async goTo(target: UndoStep | null): Promise<Outcome | undefined> {
    if (this.isGoing) return undefined;
    this.isGoing = true;
    this._stops = false;
    this._host.changed();
    try {
      return await this.go(target);
    } finally {
      this.isGoing = false;
      this._host.changed();
    }
  }

  private async go(target: UndoStep | null): Promise<Outcome> {
    await this.read(); // others may have undone or rejected some since
    const turns = this._known && !this.failed ? turnsTo(this._known, target) : [];
    let done = 0;
    try {
      for (const { op, step } of turns) {
        if (this._stops) return { ended: "stopped", done };
        this.progress = { done, of: turns.length };
        this._host.changed();
        await this._api.json(`POST /models/{model}/layers/{layer}/${op}`, {
          path: { model: this._modelId, layer: step.layer },
          header: { "Idempotency-Key": newId() },
        });
        done += 1;
      }
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      return { ended: "refused", done, of: turns.length, why: error };
    } finally {
      this.progress = null;
      await this.read();
    }
    const there = (this.current?.last ?? 0) === (target?.last ?? 0);
    return { ended: there ? "there" : "elsewhere", done };
  }

  /** Ends the way to a step after the current undo or redo, and waiting reads. */
  stop(): void {
    this._stops = true;
    if (this._timer) clearTimeout(this._timer);
    this._timer = null;
  }
}
