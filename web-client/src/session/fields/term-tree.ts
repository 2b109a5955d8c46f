// The terms of a list in the person's language. Loaded at the first use, and again when the list
// changes; for very large lists only the first ones, since the server can search the others.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { personLanguages } from "../../core/locale";
import type { ListedTerm, TermTree as FoundTerms } from "../../core/protocol.gen";

const kAtOnce = 1000;
export const kMostTerms = 2000;
const kMostFound = 300;

export class TermTree {
  terms: readonly ListedTerm[] = []; // each before its children
  total = 0; // including terms that are not loaded
  problem = "";
  /** Increases when the terms change. */
  generation = 0;
  private _state: "unasked" | "loading" | "loaded" = "unasked";
  private _again = false;
  private _places: ReadonlyMap<number, number> = new Map();
  private _placed = 0; // the generation of `_places`

  constructor(
    private readonly _api: Api,
    private readonly _table: number,
    private readonly _changed: () => void,
    private readonly _language = personLanguages()[0]!,
  ) {}

  /** Position of each term in the tree, by key; loads the terms. */
  get places(): ReadonlyMap<number, number> {
    this.want();
    if (this._placed !== this.generation) {
      this._placed = this.generation;
      this._places = new Map(this.terms.map(({ key }, place) => [key, place]));
    }
    return this._places;
  }

  /** Call this before showing the terms. */
  want(): void {
    if (this._state === "unasked") void this.load();
  }
  get loaded(): boolean {
    return this.generation > 0;
  }

  /** The terms with all of the words, together with their ancestors. */
  async search(words: string): Promise<FoundTerms> {
    return this.ask({ limit: kMostFound, offset: 0, ...(words === "" ? {} : { q: words }) });
  }

  /** A page of the tree in depth-first order. */
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
          if (page.terms.length === 0) break; // some were deleted in the meantime
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
