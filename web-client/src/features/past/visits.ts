// The changes that others made to the open model since this user's last visit in this browser.

import type { Api } from "../../net/api";
import { ApiError } from "../../net/api-error";
import { authorsOf, type Authors } from "../../domain/timeline";

const kKey = "strata.visits";
const kMostModels = 200; // the latest models
const kStepsRead = 200;
const kWriteMs = 10_000;

interface Visit {
  sequence: number;
  time: string;
}
export interface News extends Authors {
  since: Visit;
  /** Whether more edits exist than were counted. */
  more: boolean;
}

export class Visits {
  /** Null if nothing has changed, or if the user has dismissed the message. */
  news: News | null = null;
  private _newest = 0;
  private _user = "";
  private _timer: ReturnType<typeof setTimeout> | null = null;

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _changed: () => void,
  ) {}

  /** Runs when the server has identified this user. */
  async welcome(user: string, newest: number): Promise<void> {
    const isFirst = this._user === "";
    this._user = user;
    const last = isFirst ? this.read()[this.key] : undefined;
    this.saw(newest);
    if (isFirst) this.write();
    if (!last || last.sequence >= newest) return;
    try {
      const { steps, more } = await this._api.json("GET /models/{model}/timeline/steps", {
        path: { model: this._modelId },
        query: { after: last.sequence, limit: kStepsRead },
      });
      const ofOthers = steps.filter((step) => step.user !== user);
      if (ofOthers.length === 0) return;
      this.news = { ...authorsOf(ofOthers), since: last, more };
      this._changed();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      // if the changes cannot be loaded, the page shows no error
    }
  }

  /** Call this after the page has shown this edit. */
  saw(sequence: number): void {
    if (sequence <= this._newest) return;
    this._newest = sequence;
    this._timer ??= setTimeout(this.write, kWriteMs);
  }

  dismiss(): void {
    this.news = null;
    this._changed();
  }

  close(): void {
    this.write();
  }

  private get key(): string {
    return `${this._user}@${this._modelId}`;
  }

  private read(): Record<string, Visit> {
    try {
      const stored: unknown = JSON.parse(localStorage.getItem(kKey) ?? "{}");
      return typeof stored === "object" && stored !== null ? (stored as Record<string, Visit>) : {};
    } catch {
      return {}; // the storage is not available, or its value is not JSON
    }
  }

  private readonly write = (): void => {
    if (this._timer) clearTimeout(this._timer);
    this._timer = null;
    if (this._user === "") return;
    const { [this.key]: _, ...others } = this.read();
    const kept = Object.entries(others).slice(1 - kMostModels);
    const visit: Visit = { sequence: this._newest, time: new Date().toISOString() };
    try {
      localStorage.setItem(kKey, JSON.stringify(Object.fromEntries([...kept, [this.key, visit]])));
    } catch {
      // without storage, the next visit shows no changes by others
    }
  };
}
