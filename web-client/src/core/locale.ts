// The language of the page, and how numbers, moments and lists are written in it. Set once, before
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
 * What was chosen, else the first of the browser's languages that the page is written in, else
 * English.
 */
export function pageLanguage(chosen: string | null, browser: readonly string[]): PageLanguage {
  return (
    [...(chosen === null ? [] : [chosen]), ...browser].map(languageOf).find(isPageLanguage) ?? "en"
  );
}

/**
 * From now on numbers and moments are written as in `language`, in the browser's own variety of it
 * where it names one ("de-CH"), and data with names in several languages are called by the language
 * that was chosen, or else by the browser's.
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

/** The tag whose rules numbers, moments and plurals follow: "en-GB". */
export const pageLocale = (): string => locale;
/** Those that this person reads, the best first. */
export const personLanguages = (): readonly string[] => languages;

export const formatCount = (n: number): string => n.toLocaleString(locale);
/** With that many decimals, none grouped: for coordinates. */
export const formatFixed = (value: number, decimals: number): string =>
  value.toLocaleString(locale, {
    minimumFractionDigits: decimals,
    maximumFractionDigits: decimals,
    useGrouping: false,
  });
export const formatList = (items: readonly string[]): string =>
  new Intl.ListFormat(locale, { style: "short", type: "unit" }).format(items);
/**
 * Numbers that belong together, as the coordinates of a place: parted by what is no decimal sign.
 */
export const formatPlace = (numbers: readonly string[]): string =>
  numbers.join(decimal === "," ? "; " : ", ");

/** A number with all of its digits, as it is typed into a field. */
export const typedNumber = (value: number): string => withDecimalSign(String(value));
/**
 * Between the cells of CSV files, as spreadsheets of the language's countries take them: a comma
 * stands in their numbers.
 */
export const csvSeparator = (): "comma" | "semicolon" => (decimal === "," ? "semicolon" : "comma");
/** What JavaScript wrote with a point. */
export const withDecimalSign = (plain: string): string => plain.replace(".", decimal);

/**
 * What was typed into a field: with the decimal sign of the language, or a point. NaN where it is
 * no number, and where it may be either of two: in languages with a decimal comma "1.500" is not
 * told from a grouped 1500. Nothing is guessed.
 */
export function readNumber(typed: string): number {
  const text = typed.trim();
  if (decimal !== "." && /^[-+]?[1-9]\d{0,2}(\.\d{3})+$/.test(text)) return Number.NaN;
  const plain = decimal === "." ? text : text.replace(decimal, ".");
  return /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(plain) ? Number(plain) : Number.NaN;
}

/** As dictionaries of the language order words. */
export const compareWords = (a: string, b: string): number => a.localeCompare(b, locale);
