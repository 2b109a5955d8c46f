// Where something that tells of the place under the pointer goes, so that it lies beside that place and not over it.

export interface Size {
  width: number;
  height: number;
}

/** Top left of a box within a frame: to the right of the place or else to its left, or else below or above it. Null: nowhere without covering it. */
export function beside([x, y]: readonly [number, number], box: Size, frame: Size, gap: number): { left: number; top: number } | null {
  if (box.width > frame.width || box.height > frame.height) return null;
  const within = (at: number, size: number, most: number): number => Math.min(Math.max(0, at), most - size);
  const past = (at: number, size: number, most: number): number | null =>
    at + gap + size <= most ? at + gap : at - gap - size >= 0 ? at - gap - size : null;
  const left = past(x, box.width, frame.width);
  const top = past(y, box.height, frame.height);
  if (left !== null) return { left, top: top ?? within(y + gap, box.height, frame.height) };
  return top === null ? null : { left: within(x + gap, box.width, frame.width), top };
}
