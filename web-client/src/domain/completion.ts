// Completes names in an expression (docs/reference/conditions.md). It suggests candidates for the
// word before the caret.

export interface Suggestion {
  text: string; // the text that replaces the word
  hint: string; // a description for the user
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

/** Returns the slug of a layer or column as it is written in an expression. */
export const nameInText = (slug: string): string =>
  /^[a-z_]/.test(slug) && !kWords.has(slug) ? slug : `"${slug}"`;

/**
 * Returns the suggestions that start with the word before the caret, then those with a part that
 * starts with it. Returns no suggestions without a word, or inside a quoted text.
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
 * Splits the text into the parts before, at and after the wrong characters (Unicode code points).
 * At the end of the text, the middle part is a space.
 */
export function markedAt(text: string, offset: number, length = 1): [string, string, string] {
  const characters = [...text];
  return [
    characters.slice(0, offset).join(""),
    characters.slice(offset, offset + Math.max(1, length)).join("") || " ",
    characters.slice(offset + Math.max(1, length)).join(""),
  ];
}

/** The position of a mistake in a text, in code points, and suggested corrections. */
export interface Mistake {
  offset: number;
  length?: number | undefined;
  suggestions?: readonly string[] | undefined;
}

/** Replaces the wrong characters by a suggestion. */
export function corrected(text: string, { offset, length = 0 }: Mistake, by: string): string {
  const characters = [...text];
  return [...characters.slice(0, offset), by, ...characters.slice(offset + length)].join("");
}

/** A class of a layer. A condition can refer to a class only by its number. */
export interface NamedClass {
  layer: string; // as written in the text
  value: number;
  label: string;
}

/**
 * Finds the classes for a quoted name that a condition compares with a layer, as in damage =
 * 'Flaking'. Returns the classes with that name, or otherwise those with a similar beginning.
 */
export function classNumbers(
  text: string,
  { offset, length = 0 }: Mistake,
  classes: readonly NamedClass[],
): NamedClass[] {
  const characters = [...text];
  const quoted = /^'(.*)'$/s.exec(characters.slice(offset, offset + length).join(""))?.[1];
  if (!quoted) return [];
  const before = characters.slice(0, offset).join("");
  const layer = /("[^"]+"|[a-z_][\w-]*)\s*(?:=|==|<>|!=|(?:not\s+)?in\s*\([^()]*)\s*$/i.exec(
    before,
  )?.[1];
  if (!layer) return [];
  const fold = (label: string): string => label.trim().toLocaleLowerCase();
  const wanted = fold(quoted.replaceAll("''", "'"));
  const own = classes.filter((each) => each.layer === layer.toLowerCase());
  const same = own.filter(({ label }) => fold(label) === wanted);
  if (same.length > 0) return same;
  const start = wanted.slice(0, 3);
  return own.filter(({ label }) => start.length === 3 && fold(label).startsWith(start)).slice(0, 3);
}
