// What this person chose for the page at this browser: its language. Nothing of it is told to the server.

import { kPageLanguages, type PageLanguage } from "../core/locale";

const kLanguageKey = "strata.language";

/** Null: as the browser. */
export function chosen_language(): PageLanguage | null {
  const kept = localStorage.getItem(kLanguageKey);
  return kPageLanguages.find((language) => language === kept) ?? null;
}

/** Counts from the next time the page is loaded. */
export function keep_language(language: PageLanguage | null): void {
  if (language === null) localStorage.removeItem(kLanguageKey);
  else localStorage.setItem(kLanguageKey, language);
}
