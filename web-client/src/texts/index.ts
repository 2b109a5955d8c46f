// Every word the page shows, in the language of this person. What the server says (problems, steps
// of work) is English, whatever the page's language.
//
// English is the measure: `Texts` (`shape.ts`) is made from it, so a translation that lacks a text, has one too
// many or takes other arguments does not compile.

import { setLocale, type PageLanguage } from "../core/locale";
import { sayOwnProblemsIn } from "../core/problems";
import type { Texts } from "./shape";

/**
 * How many arguments each text takes. TypeScript lets a function leave out arguments; a translation
 * that does has lost something.
 */
type Arity<T> = T extends (...args: infer Arguments) => unknown
  ? Arguments["length"]
  : T extends string | number
    ? 0
    : { readonly [Key in keyof T]: Arity<T[Key]> };

type Translation<Module extends { texts: Texts }> =
  Arity<Module["texts"]> extends Arity<Texts> ? () => Promise<Module> : never;

const loadDe: Translation<typeof import("./de")> = () => import("./de");
const loadEs: Translation<typeof import("./es")> = () => import("./es");
const loads: Record<PageLanguage, () => Promise<{ texts: Texts }>> = {
  en: () => import("./en"),
  de: loadDe,
  es: loadEs,
};

/** Set by loadTexts(), which comes before the import of everything that shows words. */
export let texts: Texts;

/**
 * Loads the words of that language, and of no other. `chosen`: by the person, not by the languages
 * of their browser.
 */
export async function loadTexts(
  language: PageLanguage,
  chosen: boolean,
  browser: readonly string[],
): Promise<void> {
  setLocale(language, chosen, browser);
  texts = (await loads[language]()).texts;
  sayOwnProblemsIn(texts.calls);
}
