// The page's own problem texts, for failed calls without a problem from the server. The files of
// each language provide these texts. core/ contains no texts.

/** A title, and advice for the user. */
type Told = readonly [title: string, detail: string];

export interface OwnProblems {
  unreachable: Told;
  /** Texts for the statuses of responses without a problem body, such as responses of a proxy. */
  statuses: Readonly<Record<string, Told>>;
  other_status(status: number): string;
  other_status_detail: string;
  unreadable: string;
  unreadable_detail(what: string): string;
}

let words: OwnProblems;

export const sayOwnProblemsIn = (language: OwnProblems): void => void (words = language);
export const ownProblems = (): OwnProblems => words;
