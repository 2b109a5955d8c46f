// The user's own steps. This file loads the steps from the server, and moves to a step by one undo
// or redo at a time.

import type { Api } from "../../net/api";
import { ApiError } from "../../net/api-error";
import { newId } from "../../core/ids";
import type { UndoStep, UndoSteps } from "../../core/protocol.gen";
import { currentOf, listOf, onLayers, turnsTo, type ListedStep } from "../../domain/undo-steps";

const kSteps = 100; // limit for each kind of step
const kWaitMs = 300; // delay for further edits

export interface StepsHost {
  /** Returns whether the user can change the layer. */
  mayChange(layer: number): boolean;
  changed(): void;
}

/** The result of moving to a step, and the number of undos or redos. */
export type Outcome =
  | { ended: "there" | "stopped" | "elsewhere"; done: number }
  | { ended: "refused"; done: number; of: number; why: ApiError };

export class Steps {
  /** The steps, newest first; null before they are loaded. */
  list: ListedStep[] | null = null;
  failed = false;
  /** Whether the list omits earlier steps. */
  more = false;
  /** The progress of the undos or redos that lead to a step. */
  progress: { done: number; of: number } | null = null;
  /** Whether a move to a step is in progress, including the requests before and after it. */
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

  /** The newest step that is not undone; null if the list has none. */
  get current(): ListedStep | null {
    return this.list && currentOf(this.list);
  }

  /** Loads the steps, except during a move to a step, which loads them itself. */
  async load(): Promise<void> {
    if (!this.isGoing) await this.read();
  }

  /** Loads the steps once after several edits. */
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
   * Makes `target` the newest step that is not undone. A null `target` undoes all steps of the
   * list. Returns undefined if a move to another step is in progress.
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
    await this.read(); // other users may have undone or rejected some steps in the meantime
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

  /** Ends the move to a step after the current undo or redo, and cancels pending requests. */
  stop(): void {
    this._stops = true;
    if (this._timer) clearTimeout(this._timer);
    this._timer = null;
  }
}
