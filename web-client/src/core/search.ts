// Searches names for the words of a text, in any order.

/** Removes accents and converts to lower case. */
export const plainText = (text: string): string =>
  text.normalize("NFD").replace(/\p{M}/gu, "").toLowerCase();

export const wordsOf = (text: string): string[] => plainText(text).split(/\s+/).filter(Boolean);

/**
 * Returns a rank of the match between `title` and the words. 0 is the best rank. `also` is further
 * text to search. Returns null if a word occurs in neither text.
 */
export function misfit(words: readonly string[], title: string, also = ""): number | null {
  const [name, rest] = [plainText(title), plainText(also)];
  let sum = 0;
  for (const word of words) {
    if (name.startsWith(word)) continue;
    if (new RegExp(`[^\\p{L}\\p{N}]${escaped(word)}`, "u").test(name)) sum += 1;
    else if (name.includes(word)) sum += 2;
    else if (rest.includes(word)) sum += 3;
    else return null;
  }
  return sum;
}

/** Returns the matching entries, the best first. Entries with the same rank keep their order. */
export function searched<T>(
  text: string,
  all: readonly T[],
  textOf: (each: T) => { title: string; also?: string },
): T[] {
  const words = wordsOf(text);
  if (words.length === 0) return [...all];
  const found: { each: T; rank: number }[] = [];
  for (const each of all) {
    const { title, also } = textOf(each);
    const rank = misfit(words, title, also);
    if (rank !== null) found.push({ each, rank });
  }
  return found.sort((a, b) => a.rank - b.rank).map(({ each }) => each);
}

const escaped = (text: string): string => text.replace(/[.*+?^${}()|[\]\\/]/g, "\\$&");
