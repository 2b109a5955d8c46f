// The terms of a list in the user's language. They are loaded at the first use, and again when the
// list changes. Of very large lists, only the first terms are loaded. The server can search the
// other terms.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { personLanguages } from "../../core/locale";
import type { ListedTerm, TermTree as FoundTerms } from "../../core/protocol.gen";

const kAtOnce = 1000;
export const kMostTerms = 2000;
const kMostFound = 300;

export class TermTree {
  terms: readonly ListedTerm[] = []; // each term precedes its children
  total = 0; // number of terms, including those that are not loaded
  problem = "";
  /** A number that increases when the terms change. */
  generation = 0;
  private _state: "unasked" | "loading" | "loaded" = "unasked";
  private _again = false;
  private _places: ReadonlyMap<number, number> = new Map();
  private _placed = 0; // generation of `_places`

  constructor(
    private readonly _api: Api,
    private readonly _table: number,
    private readonly _changed: () => void,
    private readonly _language = personLanguages()[0]!,
  ) {}

  /** The position of each term in the tree, by key. Loads the terms if necessary. */
  get places(): ReadonlyMap<number, number> {
    this.want();
    if (this._placed !== this.generation) {
      this._placed = this.generation;
      this._places = new Map(this.terms.map(({ key }, place) => [key, place]));
    }
    return this._places;
  }

  /** Loads the terms if necessary. Call this before the terms are shown. */
  want(): void {
    if (this._state === "unasked") void this.load();
  }
  get loaded(): boolean {
    return this.generation > 0;
  }

  /** Returns the terms with all of the words, and the ancestors of these terms. */
  async search(words: string): Promise<FoundTerms> {
    return this.ask({ limit: kMostFound, offset: 0, ...(words === "" ? {} : { q: words }) });
  }

  /** Returns a page of the tree in depth-first order. */
  private ask(page: { limit: number; offset: number; q?: string }): Promise<FoundTerms> {
    return this._api.json("GET /tables/{table}/terms", {
      path: { table: this._table },
      query: { lang: this._language, ...page },
    });
  }

  refresh(): void {
    if (this._state === "loading") this._again = true;
    else if (this._state === "loaded") void this.load();
  }

  private async load(): Promise<void> {
    this._state = "loading";
    try {
      do {
        this._again = false;
        const terms: ListedTerm[] = [];
        let total = 1;
        while (terms.length < Math.min(total, kMostTerms)) {
          const page = await this.ask({ limit: kAtOnce, offset: terms.length });
          total = page.total;
          if (page.terms.length === 0) break; // some terms were deleted in the meantime
          terms.push(...page.terms);
        }
        this.terms = terms;
        this.total = total;
      } while (this._again);
      this.problem = "";
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.problem = error.message;
    }
    this._state = "loaded";
    this.generation += 1;
    this._changed();
  }
}
