// What the page itself says of a call that failed, where no server said it. The words come with the
// language; core/ has none of its own.

/** What happened, and what to do. */
type Told = readonly [title: string, detail: string];

export interface OwnProblems {
  unreachable: Told;
  /** Of statuses that came without a problem, as from a proxy. */
  statuses: Readonly<Record<string, Told>>;
  other_status(status: number): string;
  other_status_detail: string;
  unreadable: string;
  unreadable_detail(what: string): string;
}

let words: OwnProblems;

export const sayOwnProblemsIn = (language: OwnProblems): void => void (words = language);
export const ownProblems = (): OwnProblems => words;
