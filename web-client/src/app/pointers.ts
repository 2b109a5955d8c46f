// What a person points with at this device.

/** Fingers and nothing finer: words on the mouse and its buttons would be about something that is not there. */
export const has_fingers_only = (): boolean => matchMedia("(pointer: coarse)").matches && !matchMedia("(any-pointer: fine)").matches;
