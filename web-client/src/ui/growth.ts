// The text size is larger on wall displays (page.css). Pixel layouts around the text scale with it.

const kUsualSizePx = 16;

/** Returns the ratio of the text size to the default size. */
export const growth = (): number =>
  parseFloat(getComputedStyle(document.documentElement).fontSize) / kUsualSizePx;

/**
 * Converts a length in pixels at the default text size to a CSS length that scales with the text.
 */
export const growing = (lengthPx: number): string => `${lengthPx / kUsualSizePx}rem`;
