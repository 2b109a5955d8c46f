// Languages by their tags (BCP 47), and names of items in several languages.

import { pageLocale } from "./locale";
import type { Labels } from "./protocol.gen";

/** The languages that the page offers. A user can enter any other tag. */
export const kCommonLanguages: readonly string[] = [
  "ar",
  "bg",
  "ca",
  "cs",
  "da",
  "de",
  "el",
  "en",
  "es",
  "et",
  "eu",
  "fa",
  "fi",
  "fr",
  "gl",
  "he",
  "hi",
  "hr",
  "hu",
  "it",
  "ja",
  "ka",
  "ko",
  "la",
  "lt",
  "lv",
  "mk",
  "mt",
  "nb",
  "nl",
  "pl",
  "pt",
  "pt-BR",
  "ro",
  "ru",
  "sk",
  "sl",
  "sq",
  "sr",
  "sv",
  "sw",
  "tr",
  "uk",
  "ur",
  "vi",
  "zh-Hans",
  "zh-Hant",
];

/** Returns the tag in its usual form, such as "pt-BR", or null if the tag is invalid. */
export function wellWrittenTag(tag: string): string | null {
  try {
    return Intl.getCanonicalLocales(tag)[0] ?? null;
  } catch {
    return null; // RangeError: the tag is invalid
  }
}

/** Returns the name of a language in that language, such as "español", or "" if it is unknown. */
export function nameOfLanguage(tag: string): string {
  const locale = wellWrittenTag(tag);
  if (!locale) return "";
  return new Intl.DisplayNames([locale], { type: "language", fallback: "none" }).of(locale) ?? "";
}

/**
 * Returns the name of a language in the page's language, such as "Spanish". Returns the tag itself
 * if the name is unknown.
 */
export const languageInWords = (tag: string): string => {
  const locale = wellWrittenTag(tag);
  return locale
    ? (new Intl.DisplayNames([pageLocale()], { type: "language" }).of(locale) ?? tag)
    : tag;
};

export interface LabelRow {
  language: string; // as the user entered it
  label: string;
  description?: string; // only in fields with descriptions
}

export type ReadLabels = { labels: Labels } | { row: number; wrong: "no_language" | "twice" };

/** Returns one row for each language, sorted by tag. */
export const rowsOf = (labels: Labels, descriptions: Labels = {}): LabelRow[] =>
  [...new Set([...Object.keys(labels), ...Object.keys(descriptions)])].sort().map((language) => ({
    language,
    label: labels[language] ?? "",
    ...(language in descriptions ? { description: descriptions[language]! } : {}),
  }));

/**
 * Returns the labels in the rows. Rows with neither a label nor a description are skipped. The
 * server validates the tags.
 */
export function labelsOf(rows: readonly LabelRow[]): ReadLabels {
  const labels = new Map<string, string>();
  const taken = new Set<string>();
  for (const [row, { language, label, description = "" }] of rows.entries()) {
    const [tag, text] = [language.trim(), label.trim()];
    if (text === "" && description.trim() === "") continue;
    if (tag === "") return { row, wrong: "no_language" };
    if (taken.has(tag.toLowerCase())) return { row, wrong: "twice" };
    taken.add(tag.toLowerCase());
    if (text !== "") labels.set(tag, text);
  }
  return { labels: Object.fromEntries(labels) };
}

/** Returns the descriptions in the rows that labelsOf() accepted. */
export const descriptionsOf = (rows: readonly LabelRow[]): Labels =>
  Object.fromEntries(
    rows
      .map(({ language, description = "" }) => [language.trim(), description.trim()])
      .filter(([, text]) => text !== ""),
  );
