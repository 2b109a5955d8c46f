// The edits of a model over time, as the slider of the history shows them.

import type { Timeline, TimelineInterval, TimelineStep } from "../core/protocol.gen";

/** The last one that fits; null: none. */
export function lastWhere<T>(all: readonly T[], fits: (one: T) => boolean): T | null {
  for (let i = all.length - 1; i >= 0; --i) if (fits(all[i]!)) return all[i]!;
  return null;
}

/** Where a moment of the timeline is, from 0 (begin) to 1 (end). */
export function placeOfTime({ from, to }: Timeline, iso: string): number {
  if (from === undefined || to === undefined) return 1;
  const begin = Date.parse(from);
  const length = Date.parse(to) - begin;
  return length > 0 ? Math.min(1, Math.max(0, (Date.parse(iso) - begin) / length)) : 1;
}

/** The time at a place from 0 to 1. */
export function timeAtPlace({ from, to }: Timeline, place: number): string | null {
  if (from === undefined || to === undefined) return null;
  const begin = Date.parse(from);
  return new Date(begin + (Date.parse(to) - begin) * place).toISOString();
}

/**
 * The interval whose end the place shows: the last one that had ended by then. Null: before the
 * first one.
 */
export function intervalAtPlace(timeline: Timeline, place: number): TimelineInterval | null {
  const { intervals } = timeline;
  let found: TimelineInterval | null = null;
  for (const interval of intervals)
    if (placeOfTime(timeline, interval.ended) <= place + 1e-9) found = interval;
  return found;
}

/** The interval with the edit, or the last one before it. */
export function intervalOf(timeline: Timeline, sequence: number): TimelineInterval | null {
  let found: TimelineInterval | null = null;
  for (const interval of timeline.intervals) if (interval.first <= sequence) found = interval;
  return found;
}

/** The next interval before or after a state; null: none. */
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

/** Steps of both lists, each once, ascending. */
export function joinSteps(
  known: readonly TimelineStep[],
  more: readonly TimelineStep[],
): TimelineStep[] {
  const all = new Map(known.map((step) => [step.last, step]));
  for (const step of more) all.set(step.last, step);
  return [...all.values()].sort((a, b) => a.last - b.last);
}

/** The step that made the state: the last one up to it. */
export const stepOf = (steps: readonly TimelineStep[], sequence: number): TimelineStep | null =>
  lastWhere(steps, ({ last }) => last <= sequence);

export interface Authors {
  people: { user: string; full_name?: string }[];
  layers: number[];
  edits: number;
}

/** Who changed what in these steps; people and layers with the most steps first. */
export function authorsOf(steps: readonly TimelineStep[]): Authors {
  const people = new Map<string, { user: string; full_name?: string; steps: number }>();
  const layers = new Map<number, number>();
  for (const { user, full_name: fullName, layer } of steps) {
    const person = people.get(user) ?? {
      user,
      ...(fullName === undefined ? {} : { full_name: fullName }),
      steps: 0,
    };
    person.steps += 1;
    people.set(user, person);
    layers.set(layer, (layers.get(layer) ?? 0) + 1);
  }
  return {
    people: [...people.values()]
      .sort((a, b) => b.steps - a.steps)
      .map(({ steps: _, ...person }) => person),
    layers: [...layers].sort((a, b) => b[1] - a[1]).map(([layer]) => layer),
    edits: steps.length,
  };
}

/** The time that is shown around a place, closer or farther by a factor, within the whole. */
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
