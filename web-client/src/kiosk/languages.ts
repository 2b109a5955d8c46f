// The languages of a tour: the choice of a text's language, and the direction of writing.

import type { TourWords } from "../core/protocol.gen";

/** The text in that language, or else in the first of the tour's languages that has it. */
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
