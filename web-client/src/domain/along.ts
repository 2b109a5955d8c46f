// The directions along the axes in which flat maps show a model.

export const kAlong = ["-z", "+z", "-y", "+y", "-x", "+x"] as const;
export type Along = (typeof kAlong)[number];
