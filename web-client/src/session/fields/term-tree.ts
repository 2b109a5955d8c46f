// The terms of a list in the person's language. Asked for once somebody needs them, and again when
// the list changes; of very large lists the first ones, since the server finds the others.

import { ApiError, type Api } from "../../net/api";
import { person_languages } from "../../core/locale";
import type { ListedTerm, TermTree as FoundTerms } from "../../core/protocol.gen";

const kAtOnce = 1000;
export const kMostTerms = 2000;
const kMostFound = 300;

export class TermTree {
  terms: readonly ListedTerm[] = []; // each before those below it
  total = 0; // with those that are not here
  problem = "";
  /** Grows when the terms change. */
  generation = 0;
  private state_: "unasked" | "loading" | "loaded" = "unasked";
  private again_ = false;
  private places_: ReadonlyMap<number, number> = new Map();
  private placed_ = 0; // generation of `places_`

  constructor(
    private readonly api_: Api,
    private readonly table_: number,
    private readonly changed_: () => void,
    private readonly language_ = person_languages()[0]!,
  ) {}

  /** Where each stands in the tree, by key; asks for the terms. */
  get places(): ReadonlyMap<number, number> {
    this.want();
    if (this.placed_ !== this.generation) {
      this.placed_ = this.generation;
      this.places_ = new Map(this.terms.map(({ key }, place) => [key, place]));
    }
    return this.places_;
  }

  /** To be called by who shows them. */
  want(): void {
    if (this.state_ === "unasked") void this.load();
  }
  get loaded(): boolean {
    return this.generation > 0;
  }

  /** Those that have all of the words, with those above them. */
  async search(words: string): Promise<FoundTerms> {
    return this.api_.terms(this.table_, {
      q: words,
      lang: this.language_,
      limit: kMostFound,
      offset: 0,
    });
  }

  refresh(): void {
    if (this.state_ === "loading") this.again_ = true;
    else if (this.state_ === "loaded") void this.load();
  }

  private async load(): Promise<void> {
    this.state_ = "loading";
    try {
      do {
        this.again_ = false;
        const terms: ListedTerm[] = [];
        let total = 1;
        while (terms.length < Math.min(total, kMostTerms)) {
          const page = await this.api_.terms(this.table_, {
            lang: this.language_,
            limit: kAtOnce,
            offset: terms.length,
          });
          total = page.total;
          if (page.terms.length === 0) break; // some were deleted meanwhile
          terms.push(...page.terms);
        }
        this.terms = terms;
        this.total = total;
      } while (this.again_);
      this.problem = "";
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.problem = error.message;
    }
    this.state_ = "loaded";
    this.generation += 1;
    this.changed_();
  }
}
