// The shape of the page's texts, derived from English.

/**
 * The shape of the texts without their wording. Lists keep their length: each line of the help
 * exists in each language.
 */
type Shape<T> = T extends string
  ? string
  : T extends number
    ? number
    : T extends (...args: infer Arguments) => unknown
      ? (...args: Arguments) => string
      : { readonly [Key in keyof T]: Shape<T[Key]> };

export type HelpTexts = Shape<typeof import("./help-en").help>;

/** Of all parts of the page that are shown first. */
export type FirstTexts = Shape<typeof import("./en").texts>;

/** Of the parts of the page that are loaded later. */
export type LaterTexts = Shape<typeof import("./later-en").laterTexts>;

export type Texts = FirstTexts & LaterTexts;
