// Chooses the language of a tour's text, and its writing direction.

import type { TourWords } from "../core/protocol.gen";

/**
 * Returns the text in the language. Without one, returns the text in the first of the tour's
 * languages that has a text.
 */
export function wordsIn(
  words: TourWords | undefined,
  language: string,
  languages: readonly string[],
): string {
  for (const tag of [language, ...languages]) {
    const found = words?.[tag];
    if (found) return found;
  }
  return "";
}

const kRightToLeft = ["ar", "dv", "fa", "he", "ku", "ps", "sd", "ug", "ur", "yi"];

export const directionOfLanguage = (tag: string): "ltr" | "rtl" =>
  kRightToLeft.includes(tag.toLowerCase().split("-")[0]!) ? "rtl" : "ltr";
