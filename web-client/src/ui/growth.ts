// Text is larger in the windows of wall displays (page.css). Pixel layouts around it scale with it.

const kUsualSizePx = 16;

/** Ratio to the default size. */
export const growth = (): number =>
  parseFloat(getComputedStyle(document.documentElement).fontSize) / kUsualSizePx;

/** A CSS length that scales with the text, from pixels at the default text size. */
export const growing = (lengthPx: number): string => `${lengthPx / kUsualSizePx}rem`;
