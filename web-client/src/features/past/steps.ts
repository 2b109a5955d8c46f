// The person's own steps: reads them from the server, and goes to one of them by undos or redos,
// one after the other.

import type { Api } from "../../net/api";
import { ApiError } from "../../net/api-error";
import { newId } from "../../core/ids";
import type { UndoStep, UndoSteps } from "../../core/protocol.gen";
import { currentOf, listOf, onLayers, turnsTo, type ListedStep } from "../../domain/undo-steps";

const kSteps = 100; // of each kind

export interface StepsHost {
  /** Whether the person can change the layer. */
  mayChange(layer: number): boolean;
  changed(): void;
}

/** How a walk to a step ended. */
export type Walked =
  | { ended: "there" | "stopped" | "elsewhere"; turns: number }
  | { ended: "refused"; turns: number; of: number; why: ApiError };

export class Steps {
  /** Newest first; null: not read. */
  list: ListedStep[] | null = null;
  failed = false;
  /** There are earlier steps that the list leaves out. */
  more = false;
  /** While a walk goes on. */
  progress: { done: number; of: number } | null = null;
  private _known: UndoSteps | null = null;
  private _asked = 0;
  private _stops = false;

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _host: StepsHost,
  ) {}

  /** The newest step in force; null: none of the list. */
  get current(): ListedStep | null {
    return this.list && currentOf(this.list);
  }

  async load(): Promise<void> {
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

  /** Makes `target` the newest step in force; null: none of the list. */
  async goTo(target: UndoStep | null): Promise<Walked> {
    await this.load(); // others may have undone or rejected some since
    const turns = this._known && !this.failed ? turnsTo(this._known, target) : [];
    this._stops = false;
    let done = 0;
    try {
      for (const { op, step } of turns) {
        if (this._stops) return { ended: "stopped", turns: done };
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
      return { ended: "refused", turns: done, of: turns.length, why: error };
    } finally {
      this.progress = null;
      await this.load();
    }
    const there = (this.current?.last ?? 0) === (target?.last ?? 0);
    return { ended: there ? "there" : "elsewhere", turns: done };
  }

  /** Ends the walk after the current turn. */
  stop(): void {
    this._stops = true;
  }
}
