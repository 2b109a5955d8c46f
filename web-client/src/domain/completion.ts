// Completion of names in an expression (docs/reference/conditions.md): what the word before the caret may
// become.

export interface Suggestion {
  text: string; // that replaces the word
  hint: string; // what it is, for people
}

export interface Completion {
  from: number; // where the word begins
  suggestions: Suggestion[];
}

const kWords = new Set([
  "and",
  "or",
  "not",
  "true",
  "false",
  "case",
  "when",
  "then",
  "else",
  "end",
  "is",
  "between",
  "in",
  "null",
  "like",
  "div",
]);
const kMostSuggestions = 8;

/** A layer's or column's slug as an expression names it. */
export const nameInText = (slug: string): string =>
  /^[a-z_]/.test(slug) && !kWords.has(slug) ? slug : `"${slug}"`;

/**
 * Those that begin with the word before the caret, then those with a part that does; none where no
 * word stands there, or within a text.
 */
export function complete(text: string, caret: number, all: readonly Suggestion[]): Completion {
  const before = text.slice(0, caret);
  const word = /[a-z_"][\w."-]*$/i.exec(before)?.[0] ?? "";
  const from = caret - word.length;
  const inText = (before.slice(0, from).split("'").length - 1) % 2 === 1;
  if (word === "" || inText) return { from, suggestions: [] };
  const wanted = word.toLowerCase();
  const begins = (suggestion: Suggestion): boolean => suggestion.text.startsWith(wanted);
  const within = ({ text }: Suggestion): boolean =>
    text.split(/[."-]/).some((part) => part.startsWith(wanted));
  const found = [...all.filter(begins), ...all.filter((each) => !begins(each) && within(each))];
  const suggestions = found.filter(({ text }) => text !== word).slice(0, kMostSuggestions);
  return { from, suggestions };
}

/**
 * The text in three parts around the character (a Unicode code point) that is wrong; the middle one
 * is a space at its end.
 */
export function markedAt(text: string, offset: number): [string, string, string] {
  const characters = [...text];
  return [
    characters.slice(0, offset).join(""),
    characters[offset] ?? " ",
    characters.slice(offset + 1).join(""),
  ];
}
