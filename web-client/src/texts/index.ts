// All texts of the page, in this person's language. Texts of the server (problems, steps of jobs)
// are English in every language.
//
// English is the reference: `Texts` (`shape.ts`) is derived from it, so a translation that misses a
// text, has an extra one or takes other arguments does not compile.

import { setLocale, type PageLanguage } from "../core/locale";
import { sayOwnProblemsIn } from "../core/problems";
import type { HelpTexts, Texts } from "./shape";

/**
 * The number of arguments of each text. TypeScript allows a function to omit arguments; a
 * translation that omits one has lost information.
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

const helpLoads: Record<PageLanguage, () => Promise<{ help: HelpTexts }>> = {
  en: () => import("./help-en"),
  de: () => import("./help-de"),
  es: () => import("./help-es"),
};
let loadedLanguage: PageLanguage = "en";

/** The rows of the help, which are not loaded with the page. */
export const loadHelp = async (): Promise<HelpTexts> => (await helpLoads[loadedLanguage]()).help;

/** Set by loadTexts(), which runs before the import of all modules that show texts. */
export let texts: Texts;

/** Loads the texts of one language. `chosen`: by the user, not by the browser's languages. */
export async function loadTexts(
  language: PageLanguage,
  chosen: boolean,
  browser: readonly string[],
): Promise<void> {
  setLocale(language, chosen, browser);
  loadedLanguage = language;
  texts = (await loads[language]()).texts;
  sayOwnProblemsIn(texts.calls);
}
