// Words are larger in the windows of walls (page.css). What is laid out around them in pixels grows
// with them.

const kUsualSizePx = 16;

/** How much larger than usual. */
export const growth = (): number =>
  parseFloat(getComputedStyle(document.documentElement).fontSize) / kUsualSizePx;

/** A length in pixels where words have their usual size, as CSS has it when it grows with them. */
export const growing = (lengthPx: number): string => `${lengthPx / kUsualSizePx}rem`;
