// The shape of the page's texts, derived from English.

/**
 * The shape of the texts without their wording. Lists have the same length in each
 * language, so no line of the help can be missing.
 */
type Shape<T> = T extends string
  ? string
  : T extends number
    ? number
    : T extends (...args: infer Arguments) => unknown
      ? (...args: Arguments) => string
      : { readonly [Key in keyof T]: Shape<T[Key]> };

export type HelpTexts = Shape<typeof import("./help-en").help>;

/** The texts of all parts that the page shows first. */
export type FirstTexts = Shape<typeof import("./en").texts>;

/** The texts of the parts that the page loads later. */
export type LaterTexts = Shape<typeof import("./later-en").laterTexts>;

export type Texts = FirstTexts & LaterTexts;
