// What a person points with at this device.

/** Fingers, first of all. */
export const has_fingers = (): boolean => matchMedia("(pointer: coarse)").matches;

/**
 * Fingers and nothing finer: words on the mouse and its buttons would be about something that is
 * not there.
 */
export const has_fingers_only = (): boolean =>
  has_fingers() && !matchMedia("(any-pointer: fine)").matches;
