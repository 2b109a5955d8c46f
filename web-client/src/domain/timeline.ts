// The edits of a model over time, for the slider of the history.

import type { Timeline, TimelineInterval, TimelineStep } from "../core/protocol.gen";

/** Returns the last item for which `fits` is true, or null. */
export function lastWhere<T>(all: readonly T[], fits: (one: T) => boolean): T | null {
  for (let i = all.length - 1; i >= 0; --i) if (fits(all[i]!)) return all[i]!;
  return null;
}

/** Returns the position of a time on the timeline, from 0 (begin) to 1 (end). */
export function placeOfTime({ from, to }: Timeline, iso: string): number {
  if (from === undefined || to === undefined) return 1;
  const begin = Date.parse(from);
  const length = Date.parse(to) - begin;
  return length > 0 ? Math.min(1, Math.max(0, (Date.parse(iso) - begin) / length)) : 1;
}

/** Returns the time at a position from 0 to 1. */
export function timeAtPlace({ from, to }: Timeline, place: number): string | null {
  if (from === undefined || to === undefined) return null;
  const begin = Date.parse(from);
  return new Date(begin + (Date.parse(to) - begin) * place).toISOString();
}

/**
 * Returns the last interval that ended at or before the position. Returns null before the end of
 * the first interval.
 */
export function intervalAtPlace(timeline: Timeline, place: number): TimelineInterval | null {
  const { intervals } = timeline;
  let found: TimelineInterval | null = null;
  for (const interval of intervals)
    if (placeOfTime(timeline, interval.ended) <= place + 1e-9) found = interval;
  return found;
}

/** Returns the interval that contains the edit, or the last interval before it. */
export function intervalOf(timeline: Timeline, sequence: number): TimelineInterval | null {
  let found: TimelineInterval | null = null;
  for (const interval of timeline.intervals) if (interval.first <= sequence) found = interval;
  return found;
}

/** Returns the next interval before or after a state, or null. */
export function nextInterval(
  timeline: Timeline,
  sequence: number,
  forward: boolean,
): TimelineInterval | null {
  const { intervals } = timeline;
  return forward
    ? (intervals.find(({ last }) => last > sequence) ?? null)
    : lastWhere(intervals, ({ last }) => last < sequence);
}

/**
 * Merges both lists without duplicates, in ascending order. In a thinned history, several steps can
 * lead to the same state.
 */
export function joinSteps(
  known: readonly TimelineStep[],
  more: readonly TimelineStep[],
): TimelineStep[] {
  const key = ({ last, stroke }: TimelineStep): string => `${last} ${stroke}`;
  const all = new Map(known.map((step) => [key(step), step]));
  for (const step of more) all.set(key(step), step);
  return [...all.values()].sort((a, b) => a.last - b.last);
}

/** Returns the step that led to the state: the last step up to it. */
export const stepOf = (steps: readonly TimelineStep[], sequence: number): TimelineStep | null =>
  lastWhere(steps, ({ last }) => last <= sequence);

export interface Authors {
  people: { user: string; full_name?: string }[];
  layers: number[];
  edits: number;
}

/**
 * Returns the authors and layers of these steps, those with the most steps first. A step of a
 * thinned history has no author if several people made its edits.
 */
export function authorsOf(steps: readonly TimelineStep[]): Authors {
  const people = new Map<string, { user: string; full_name?: string; steps: number }>();
  const layers = new Map<number, number>();
  for (const { user, full_name: fullName, layer } of steps) {
    layers.set(layer, (layers.get(layer) ?? 0) + 1);
    if (user === "") continue;
    const person = people.get(user) ?? {
      user,
      ...(fullName === undefined ? {} : { full_name: fullName }),
      steps: 0,
    };
    person.steps += 1;
    people.set(user, person);
  }
  return {
    people: [...people.values()]
      .sort((a, b) => b.steps - a.steps)
      .map(({ steps: _, ...person }) => person),
    layers: [...layers].sort((a, b) => b[1] - a[1]).map(([layer]) => layer),
    edits: steps.length,
  };
}

/**
 * Returns the displayed time range, scaled by `factor` around a time and limited to the whole
 * timeline. Returns null for the whole timeline.
 */
export function zoomed(
  whole: Timeline,
  shown: Timeline,
  iso: string,
  factor: number,
): { from: string; to: string } | null {
  if (!whole.from || !whole.to || !shown.from || !shown.to) return null;
  const [least, most] = [Date.parse(whole.from), Date.parse(whole.to)];
  const length = (Date.parse(shown.to) - Date.parse(shown.from)) * factor;
  if (length >= most - least) return null;
  const middle = Math.min(most, Math.max(least, Date.parse(iso)));
  const from = Math.max(least, Math.min(most - length, middle - length / 2));
  return {
    from: new Date(Math.floor(from)).toISOString(),
    to: new Date(Math.ceil(from + Math.max(1000, length))).toISOString(),
  };
}
