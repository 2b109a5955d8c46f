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
 * Splits the text into three parts around the wrong characters (Unicode code points); at the end of
 * the text the middle part is a space.
 */
export function markedAt(text: string, offset: number, length = 1): [string, string, string] {
  const characters = [...text];
  return [
    characters.slice(0, offset).join(""),
    characters.slice(offset, offset + Math.max(1, length)).join("") || " ",
    characters.slice(offset + Math.max(1, length)).join(""),
  ];
}

/** The place of a mistake in a text, in code points, and what would correct it. */
export interface Mistake {
  offset: number;
  length?: number | undefined;
  suggestions?: readonly string[] | undefined;
}

/** The text with a suggestion in place of the wrong characters. */
export function corrected(text: string, { offset, length = 0 }: Mistake, by: string): string {
  const characters = [...text];
  return [...characters.slice(0, offset), by, ...characters.slice(offset + length)].join("");
}

/** A class that a condition can name only by its number. */
export interface NamedClass {
  layer: string; // as the text names it
  value: number;
  label: string;
}

/**
 * For a class's name that is compared with its layer, as in damage = 'Flaking': the numbers of the
 * classes with that name, or else with a name that begins alike.
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
