// The page's own problem texts for failed calls without a problem from the server. Each language
// provides the texts; core/ contains none.

/** A title and the advice on what to do. */
type Told = readonly [title: string, detail: string];

export interface OwnProblems {
  unreachable: Told;
  /** For statuses of responses without a problem body, such as a proxy's. */
  statuses: Readonly<Record<string, Told>>;
  other_status(status: number): string;
  other_status_detail: string;
  unreadable: string;
  unreadable_detail(what: string): string;
}

let words: OwnProblems;

export const sayOwnProblemsIn = (language: OwnProblems): void => void (words = language);
export const ownProblems = (): OwnProblems => words;
