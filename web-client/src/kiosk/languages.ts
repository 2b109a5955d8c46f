// The languages of a tour: in which of them something is said, and how they are written.

import type { TourWords } from "../core/protocol.gen";

/** In that language, or else in the first of the tour that has it. */
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
