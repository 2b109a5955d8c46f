// Detects the available pointing devices.

/** Whether touch is the main pointing device. */
export const hasFingers = (): boolean => matchMedia("(pointer: coarse)").matches;

/** Whether touch is the only pointing device, so texts about mouse buttons do not apply. */
export const hasFingersOnly = (): boolean =>
  hasFingers() && !matchMedia("(any-pointer: fine)").matches;
