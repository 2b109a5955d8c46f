// The language of the page, and its formats of numbers, times and lists. It is set once, before the
// page shows any content.

export const kPageLanguages = ["en", "de", "es"] as const;
export type PageLanguage = (typeof kPageLanguages)[number];

let locale = "en-GB";
let languages: readonly string[] = [locale];
let decimal = ".";

const languageOf = (tag: string): string => tag.toLowerCase().split("-")[0]!;
const isPageLanguage = (language: string): language is PageLanguage =>
  (kPageLanguages as readonly string[]).includes(language);

/**
 * Returns the chosen language. Without one, returns the first of the browser's languages that the
 * page supports, or English.
 */
export function pageLanguage(chosen: string | null, browser: readonly string[]): PageLanguage {
  return (
    [...(chosen === null ? [] : [chosen]), ...browser].map(languageOf).find(isPageLanguage) ?? "en"
  );
}

/**
 * Sets the language of numbers and times to `language`. If the browser names a regional variety of
 * it, such as "de-CH", that variety applies. Data with names in several languages use the chosen
 * language, or otherwise the browser's languages.
 */
export function setLocale(
  language: PageLanguage,
  chosen: boolean,
  browser: readonly string[],
): void {
  const usual = language === "en" ? "en-GB" : language;
  const known = browser.filter(
    (tag) => Intl.NumberFormat.supportedLocalesOf(tag, { localeMatcher: "lookup" }).length > 0,
  );
  locale = known.find((tag) => tag.includes("-") && languageOf(tag) === language) ?? usual;
  languages =
    chosen || browser.length === 0 ? [locale, ...browser.filter((tag) => tag !== locale)] : browser;
  decimal =
    new Intl.NumberFormat(locale, { numberingSystem: "latn" })
      .formatToParts(0.5)
      .find(({ type }) => type === "decimal")?.value ?? ".";
}

/** Returns the tag that sets the rules for numbers, times and plurals, such as "en-GB". */
export const pageLocale = (): string => locale;
/** Returns the user's languages, the preferred one first. */
export const personLanguages = (): readonly string[] => languages;

/** Formats a fraction as a percentage, such as "12 %" or "0.4 %". */
export const formatPercent = (share: number): string =>
  `${(share * 100).toLocaleString(locale, { maximumSignificantDigits: share < 0.1 ? 2 : 3 })} %`;

export const formatCount = (n: number): string => n.toLocaleString(locale);
/** Formats a number with `decimals` decimals and without grouping, for coordinates. */
export const formatFixed = (value: number, decimals: number): string =>
  value.toLocaleString(locale, {
    minimumFractionDigits: decimals,
    maximumFractionDigits: decimals,
    useGrouping: false,
  });
export const formatList = (items: readonly string[]): string =>
  new Intl.ListFormat(locale, { style: "short", type: "unit" }).format(items);
/**
 * Joins numbers that belong together, such as the coordinates of a point. The separator differs
 * from the decimal sign.
 */
export const formatPlace = (numbers: readonly string[]): string =>
  numbers.join(decimal === "," ? "; " : ", ");

/** Formats a number with all its digits, as users type it. */
export const typedNumber = (value: number): string => withDecimalSign(String(value));
/**
 * Returns the separator of cells in CSV files that spreadsheets in this language expect. It is a
 * semicolon if the decimal sign is a comma.
 */
export const csvSeparator = (): "comma" | "semicolon" => (decimal === "," ? "semicolon" : "comma");
/**
 * Replaces the decimal point of a number that JavaScript formatted with the language's decimal
 * sign.
 */
export const withDecimalSign = (plain: string): string => plain.replace(".", decimal);

/**
 * Parses a typed number with the decimal sign of the language or a point. Returns NaN for invalid
 * and for ambiguous input. For example, in languages with a decimal comma, "1.500" could mean 1500.
 */
export function readNumber(typed: string): number {
  const text = typed.trim();
  if (decimal !== "." && /^[-+]?[1-9]\d{0,2}(\.\d{3})+$/.test(text)) return Number.NaN;
  const plain = decimal === "." ? text : text.replace(decimal, ".");
  return /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(plain) ? Number(plain) : Number.NaN;
}

/** Compares words in the dictionary order of the language. */
export const compareWords = (a: string, b: string): number => a.localeCompare(b, locale);
