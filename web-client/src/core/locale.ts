// The language of the page, and the format of numbers, times and lists in it. Set once, before
// anything is shown.

export const kPageLanguages = ["en", "de", "es"] as const;
export type PageLanguage = (typeof kPageLanguages)[number];

let locale = "en-GB";
let languages: readonly string[] = [locale];
let decimal = ".";

const languageOf = (tag: string): string => tag.toLowerCase().split("-")[0]!;
const isPageLanguage = (language: string): language is PageLanguage =>
  (kPageLanguages as readonly string[]).includes(language);

/**
 * The chosen language, else the first of the browser's languages that the page has, else English.
 */
export function pageLanguage(chosen: string | null, browser: readonly string[]): PageLanguage {
  return (
    [...(chosen === null ? [] : [chosen]), ...browser].map(languageOf).find(isPageLanguage) ?? "en"
  );
}

/**
 * Sets the language of numbers and times to `language`, in the browser's own variety of it if the
 * browser names one ("de-CH"). Data with names in several languages use the chosen language, or
 * else the browser's.
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

/** The tag that sets the rules for numbers, times and plurals: "en-GB". */
export const pageLocale = (): string => locale;
/** The languages that this person reads, the best first. */
export const personLanguages = (): readonly string[] => languages;

/** A share of a whole in percent: "12 %", "0.4 %". */
export const formatPercent = (share: number): string =>
  `${(share * 100).toLocaleString(locale, { maximumSignificantDigits: share < 0.1 ? 2 : 3 })} %`;

export const formatCount = (n: number): string => n.toLocaleString(locale);
/** Formats with `decimals` decimals and without grouping: for coordinates. */
export const formatFixed = (value: number, decimals: number): string =>
  value.toLocaleString(locale, {
    minimumFractionDigits: decimals,
    maximumFractionDigits: decimals,
    useGrouping: false,
  });
export const formatList = (items: readonly string[]): string =>
  new Intl.ListFormat(locale, { style: "short", type: "unit" }).format(items);
/**
 * Joins numbers that belong together, such as the coordinates of a place, by a separator that is
 * not the decimal sign.
 */
export const formatPlace = (numbers: readonly string[]): string =>
  numbers.join(decimal === "," ? "; " : ", ");

/** A number with all of its digits, in the form that users type. */
export const typedNumber = (value: number): string => withDecimalSign(String(value));
/**
 * The separator of cells in CSV files, as spreadsheets of the language's countries expect it: a
 * semicolon where numbers contain a comma.
 */
export const csvSeparator = (): "comma" | "semicolon" => (decimal === "," ? "semicolon" : "comma");
/** Replaces the point of a number that JavaScript formatted by the decimal sign of the language. */
export const withDecimalSign = (plain: string): string => plain.replace(".", decimal);

/**
 * Parses a typed number with the decimal sign of the language or a point. Returns NaN for anything
 * else and for ambiguous input: in languages with a decimal comma, "1.500" may be a grouped 1500.
 * Nothing is guessed.
 */
export function readNumber(typed: string): number {
  const text = typed.trim();
  if (decimal !== "." && /^[-+]?[1-9]\d{0,2}(\.\d{3})+$/.test(text)) return Number.NaN;
  const plain = decimal === "." ? text : text.replace(decimal, ".");
  return /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(plain) ? Number(plain) : Number.NaN;
}

/** Compares words in the dictionary order of the language. */
export const compareWords = (a: string, b: string): number => a.localeCompare(b, locale);
