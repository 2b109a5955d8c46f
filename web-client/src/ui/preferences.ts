// The user's settings for the page in this browser: the language, the theme, and whether the tour
// is completed. They are not sent to the server.

import { kPageLanguages, type PageLanguage } from "../core/locale";
import type { Background } from "../core/protocol.gen";
import { Kept } from "../core/kept";

const kLanguageKey = "strata.language";
const kThemeKey = "strata.theme";
const kTourKey = "strata.tour_over";

export const kThemes = ["system", "light", "dark", "contrast"] as const;
export type Theme = (typeof kThemes)[number];

/** Returns the chosen language. Null means the browser's language. */
export function chosenLanguage(): PageLanguage | null {
  const kept = localStorage.getItem(kLanguageKey);
  return kPageLanguages.find((language) => language === kept) ?? null;
}

/** Stores the language. It applies after the next load of the page. */
export function keepLanguage(language: PageLanguage | null): void {
  if (language === null) localStorage.removeItem(kLanguageKey);
  else localStorage.setItem(kLanguageKey, language);
}

export function chosenTheme(): Theme {
  const kept = localStorage.getItem(kThemeKey);
  return kThemes.find((theme) => theme === kept) ?? "system";
}

/** Stores the theme. It applies immediately. */
export function keepTheme(theme: Theme): void {
  if (theme === "system") localStorage.removeItem(kThemeKey);
  else localStorage.setItem(kThemeKey, theme);
  showTheme();
}

/**
 * Returns the effective theme. If the system requests both more contrast and a dark theme, the
 * theme has more contrast.
 */
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

/** Calls `listener` after each change of the theme. Returns a function that unsubscribes. */
export function onTheme(listener: () => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Returns the background that the theme defines for the model. Null means the server's default. */
export function stageBackground(): Background | null {
  const style = getComputedStyle(document.documentElement);
  const [top, bottom] = [
    style.getPropertyValue("--stage-top").trim(),
    style.getPropertyValue("--stage-bottom").trim(),
  ];
  return top && bottom ? { top, bottom } : null;
}

/** Applies the theme, and applies it again whenever the system setting changes. */
export function followTheme(): void {
  for (const query of [dark, contrast]) matchMedia(query).addEventListener("change", showTheme);
  showTheme();
}

const keptTour = (): Kept<boolean> => new Kept(() => localStorage, kTourKey, false);
const tourOfPage = keptTour();

/** Whether the tour was skipped or completed, in this or another window. */
export const tourIsOver = (): boolean => tourOfPage.value || keptTour().value;
export function keepTourOver(): void {
  tourOfPage.value = true;
}
