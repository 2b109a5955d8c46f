// What this person chose for the page at this browser: its language and its theme, and that they
// have seen the tour. Nothing of it is told to the server.

import { kPageLanguages, type PageLanguage } from "../core/locale";
import type { Background } from "../core/protocol.gen";
import { Kept } from "../core/kept";

const kLanguageKey = "strata.language";
const kThemeKey = "strata.theme";
const kTourKey = "strata.tour_over";

export const kThemes = ["system", "light", "dark", "contrast"] as const;
export type Theme = (typeof kThemes)[number];

/** Null: as the browser. */
export function chosenLanguage(): PageLanguage | null {
  const kept = localStorage.getItem(kLanguageKey);
  return kPageLanguages.find((language) => language === kept) ?? null;
}

/** Counts from the next time the page is loaded. */
export function keepLanguage(language: PageLanguage | null): void {
  if (language === null) localStorage.removeItem(kLanguageKey);
  else localStorage.setItem(kLanguageKey, language);
}

export function chosenTheme(): Theme {
  const kept = localStorage.getItem(kThemeKey);
  return kThemes.find((theme) => theme === kept) ?? "system";
}

/** Is seen at once. */
export function keepTheme(theme: Theme): void {
  if (theme === "system") localStorage.removeItem(kThemeKey);
  else localStorage.setItem(kThemeKey, theme);
  showTheme();
}

/** The one that holds: who asks their system for more contrast gets it, also from a dark one. */
export const themeOf = (
  chosen: Theme,
  system: { dark: boolean; contrast: boolean },
): Exclude<Theme, "system"> =>
  chosen !== "system" ? chosen : system.contrast ? "contrast" : system.dark ? "dark" : "light";

const dark = "(prefers-color-scheme: dark)";
const contrast = "(prefers-contrast: more)";

function showTheme(): void {
  const system = { dark: matchMedia(dark).matches, contrast: matchMedia(contrast).matches };
  document.documentElement.dataset["theme"] = themeOf(chosenTheme(), system);
  for (const listener of listeners) listener();
}

const listeners = new Set<() => void>();

/** Calls it whenever another theme is shown; returns what ends that. */
export function onTheme(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** What the theme has behind the model; null: as the server has it. */
export function stageBackground(): Background | null {
  const style = getComputedStyle(document.documentElement);
  const [top, bottom] = [
    style.getPropertyValue("--stage-top").trim(),
    style.getPropertyValue("--stage-bottom").trim(),
  ];
  return top && bottom ? { top, bottom } : null;
}

/** Shows the theme, and follows the system from then on. */
export function followTheme(): void {
  for (const query of [dark, contrast]) matchMedia(query).addEventListener("change", showTheme);
  showTheme();
}

const keptTour = (): Kept<boolean> => new Kept(() => localStorage, kTourKey, false);
const tourOfPage = keptTour();

/** Skipped or seen to its end, here or in another window. */
export const tourIsOver = (): boolean => tourOfPage.value || keptTour().value;
export function keepTourOver(): void {
  tourOfPage.value = true;
}
