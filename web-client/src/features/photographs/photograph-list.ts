// All photographs of the open model, or those whose names contain a text, page by page.

import type { Photograph } from "../../core/protocol.gen";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";

const kPageSize = 60;

export class PhotographList {
  /** The photographs that are loaded. */
  photographs: readonly Photograph[] = [];
  /** How many photographs were asked for; null until they are known. */
  total: number | null = null;
  text = "";
  /** Whether only photographs without an image are listed. */
  missing = false;
  problem = "";
  private _asked: AbortController | null = null;

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _changed: () => void,
  ) {}

  get hasMore(): boolean {
    return this.total !== null && this.photographs.length < this.total;
  }
  get isLoading(): boolean {
    return this._asked !== null;
  }

  choose(text: string, missing: boolean): Promise<void> {
    [this.text, this.missing] = [text, missing];
    return this.load(0);
  }

  readMore(): Promise<void> {
    return this.load(this.photographs.length);
  }

  stop(): void {
    this._asked?.abort();
    this._asked = null;
  }

  private async load(offset: number): Promise<void> {
    this.stop();
    const asked = (this._asked = new AbortController());
    this.problem = "";
    this._changed();
    try {
      const { photographs, total } = await this._api.json("GET /models/{model}/photographs", {
        path: { model: this._modelId },
        query: {
          limit: kPageSize,
          offset,
          ...(this.text ? { q: this.text } : {}),
          ...(this.missing ? { has_picture: false } : {}),
        },
        signal: asked.signal,
      });
      if (asked !== this._asked) return;
      this.photographs = [...this.photographs.slice(0, offset), ...photographs];
      this.total = total;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked !== this._asked) return; // a newer request has been sent
      this.problem = error.message;
    }
    this._asked = null;
    this._changed();
  }
}
