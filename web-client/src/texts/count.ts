// Numbers of items, with the language's plural forms.

import { formatCount, pageLocale } from "../core/locale";

/** `many`: the form for millions in some languages ("1.000.000 de capas"). */
export function plural(n: number, one: string, other: string, many = other): string {
  const rule = new Intl.PluralRules(pageLocale()).select(n);
  return rule === "one" ? one : rule === "many" ? many : other;
}

/** "1 layer", "1,200 layers". */
export const count = (n: number, one: string, other: string, many = other): string =>
  `${formatCount(n)} ${plural(n, one, other, many)}`;

/** Whole millions take "de": "1.000.000 de capas". */
export const countInSpanish = (n: number, one: string, other: string): string =>
  count(n, one, other, `de ${other}`);
