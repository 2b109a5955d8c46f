// Completion of names in an expression (docs/reference/conditions.md): the candidates for the word
// before the caret.

export interface Suggestion {
  text: string; // replaces the word
  hint: string; // a description for people
}

export interface Completion {
  from: number; // start of the word
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
 * Returns suggestions that start with the word before the caret, then those of which a part does;
 * none without a word, or within a quoted text.
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
 * Splits the text into three parts around the wrong character (a Unicode code point); at the end of
 * the text the middle part is a space.
 */
export function markedAt(text: string, offset: number): [string, string, string] {
  const characters = [...text];
  return [
    characters.slice(0, offset).join(""),
    characters[offset] ?? " ",
    characters.slice(offset + 1).join(""),
  ];
}
