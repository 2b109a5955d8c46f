// All texts of the page, in the user's language. Texts of the server (problems, steps of jobs) are
// always English.
//
// English is the reference: `Texts` (`shape.ts`) is derived from it, so a translation that misses a
// text, has an extra one or takes other arguments does not compile.

import { setLocale, type PageLanguage } from "../core/locale";
import { sayOwnProblemsIn } from "../core/problems";
import type { FirstTexts, HelpTexts, LaterTexts, Texts } from "./shape";

/**
 * The number of arguments of each text. TypeScript allows a function to omit arguments, but a
 * translation without one of them would lack information.
 */
type Arity<T> = T extends (...args: infer Arguments) => unknown
  ? Arguments["length"]
  : T extends string | number
    ? 0
    : { readonly [Key in keyof T]: Arity<T[Key]> };

type Translation<Translated, English> =
  Arity<Translated> extends Arity<English> ? () => Promise<Translated> : never;

interface First {
  texts: FirstTexts;
}
const loadDe: Translation<typeof import("./de"), First> = () => import("./de");
const loadEs: Translation<typeof import("./es"), First> = () => import("./es");
const loads: Record<PageLanguage, () => Promise<First>> = {
  en: () => import("./en"),
  de: loadDe,
  es: loadEs,
};

interface Later {
  laterTexts: LaterTexts;
}
const loadLaterDe: Translation<typeof import("./later-de"), Later> = () => import("./later-de");
const loadLaterEs: Translation<typeof import("./later-es"), Later> = () => import("./later-es");
const laterLoads: Record<PageLanguage, () => Promise<Later>> = {
  en: () => import("./later-en"),
  de: loadLaterDe,
  es: loadLaterEs,
};

const helpLoads: Record<PageLanguage, () => Promise<{ help: HelpTexts }>> = {
  en: () => import("./help-en"),
  de: () => import("./help-de"),
  es: () => import("./help-es"),
};
let loadedLanguage: PageLanguage = "en";

/** The rows of the help, which are not loaded with the page. */
export const loadHelp = async (): Promise<HelpTexts> => (await helpLoads[loadedLanguage]()).help;

/**
 * loadTexts() sets the texts, before the page imports the modules that show them. Members of
 * `LaterTexts` are missing until loadLaterTexts() has added them, before the page imports the parts
 * that it loads later. `later-texts.test.ts` checks that no other module reads these members.
 */
export let texts: Texts;

/** Loads the texts of one language. `chosen` is whether the user, not the browser, selected it. */
export async function loadTexts(
  language: PageLanguage,
  chosen: boolean,
  browser: readonly string[],
): Promise<void> {
  setLocale(language, chosen, browser);
  loadedLanguage = language;
  texts = (await loads[language]()).texts as Texts;
  sayOwnProblemsIn(texts.calls);
}

export async function loadLaterTexts(): Promise<void> {
  const { laterTexts } = await laterLoads[loadedLanguage]();
  if (!("measure" in texts)) texts = { ...(texts as FirstTexts), ...laterTexts };
}
