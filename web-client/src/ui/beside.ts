// Positions a box with information about a point next to the point, so the box does not cover the
// point.

export interface Size {
  width: number;
  height: number;
}

/**
 * Returns the top left corner of a box inside a frame: right of the point, otherwise left,
 * otherwise below or above. Returns null if the box covers the point at each position.
 */
export function beside(
  [x, y]: readonly [number, number],
  box: Size,
  frame: Size,
  gap: number,
): { left: number; top: number } | null {
  if (box.width > frame.width || box.height > frame.height) return null;
  const within = (at: number, size: number, most: number): number =>
    Math.min(Math.max(0, at), most - size);
  const past = (at: number, size: number, most: number): number | null =>
    at + gap + size <= most ? at + gap : at - gap - size >= 0 ? at - gap - size : null;
  const left = past(x, box.width, frame.width);
  const top = past(y, box.height, frame.height);
  if (left !== null) return { left, top: top ?? within(y + gap, box.height, frame.height) };
  return top === null ? null : { left: within(x + gap, box.width, frame.width), top };
}

export interface Box extends Size {
  left: number;
  top: number;
}

/**
 * Returns the top left corner of a box next to a bar, aligned with an element in that bar. The box
 * is right, left, below or above, at the first position that fits. If no position fits, the box is
 * below or above, on the side with more space, with a height of at most `mostHeight`.
 */
export function besideBar(
  thing: Box,
  bar: Box,
  box: Size,
  frame: Size,
  gap: number,
): { left: number; top: number; mostHeight: number } {
  const within = (at: number, size: number, most: number): number =>
    Math.max(gap, Math.min(at, most - size - gap));
  const top = within(thing.top + (thing.height - box.height) / 2, box.height, frame.height);
  const left = within(thing.left + (thing.width - box.width) / 2, box.width, frame.width);
  const mostHeight = frame.height - 2 * gap;
  const [rightEnd, bottomEnd] = [bar.left + bar.width, bar.top + bar.height];
  if (box.height <= mostHeight) {
    if (rightEnd + box.width + 2 * gap <= frame.width)
      return { left: rightEnd + gap, top, mostHeight };
    if (bar.left - box.width - 2 * gap >= 0)
      return { left: bar.left - box.width - gap, top, mostHeight };
  }
  const [above, below] = [bar.top - 2 * gap, frame.height - bottomEnd - 2 * gap];
  if (below >= box.height || (below >= above && above < box.height))
    return { left, top: bottomEnd + gap, mostHeight: below };
  return { left, top: Math.max(gap, bar.top - gap - box.height), mostHeight: above };
}
