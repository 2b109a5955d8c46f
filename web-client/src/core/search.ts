// Search of names by the words of a text, in any order.

/** Without accents and in small letters. */
export const plainText = (text: string): string =>
  text.normalize("NFD").replace(/\p{M}/gu, "").toLowerCase();

export const wordsOf = (text: string): string[] => plainText(text).split(/\s+/).filter(Boolean);

/**
 * How well `title` fits the words: 0 is best. `also`: further text in which a word may occur. Null:
 * a word occurs in neither.
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

/** The entries that fit, best first; equal ones keep their order. */
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
