// Numbers of things, in the plural that the language has for them.

import { formatCount, pageLocale } from "../core/locale";

/** `many`: what some languages take for millions ("1.000.000 de capas"). */
export function plural(n: number, one: string, other: string, many = other): string {
  const rule = new Intl.PluralRules(pageLocale()).select(n);
  return rule === "one" ? one : rule === "many" ? many : other;
}

/** "1 layer", "1,200 layers". */
export const count = (n: number, one: string, other: string, many = other): string =>
  `${formatCount(n)} ${plural(n, one, other, many)}`;
