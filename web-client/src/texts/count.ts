// Numbers of items, with the language's plural forms.

import { formatCount, pageLocale } from "../core/locale";

/** Returns the form for `n`. `many` is for millions in some languages ("1.000.000 de capas"). */
export function plural(n: number, one: string, other: string, many = other): string {
  const rule = new Intl.PluralRules(pageLocale()).select(n);
  return rule === "one" ? one : rule === "many" ? many : other;
}

/** Returns a number with its noun, such as "1 layer" or "1,200 layers". */
export const count = (n: number, one: string, other: string, many = other): string =>
  `${formatCount(n)} ${plural(n, one, other, many)}`;

/** Works like count(). Adds "de" after whole millions, as in "1.000.000 de capas". */
export const countInSpanish = (n: number, one: string, other: string): string =>
  count(n, one, other, `de ${other}`);
