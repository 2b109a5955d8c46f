// What a person points with at this device.

/** Fingers, first of all. */
export const hasFingers = (): boolean => matchMedia("(pointer: coarse)").matches;

/**
 * Fingers and nothing finer: words on the mouse and its buttons would be about something that is
 * not there.
 */
export const hasFingersOnly = (): boolean =>
  hasFingers() && !matchMedia("(any-pointer: fine)").matches;
