// The positions of a model's snapshots on the slider of its history.

import type { Snapshot, Timeline } from "../core/protocol.gen";
import { placeOfTime } from "./timeline";

/**
 * A mark on the slider. `place` and `room` are fractions of the slider's width. `room` is the free
 * width for the mark's name.
 */
export interface SnapshotMark {
  snapshot: Snapshot;
  place: number;
  room: number;
}

const kLeastRoom = 0.03;
const kToLeft = 0.8; // later marks have their name on the left

/**
 * Returns the marks of the snapshots in the displayed time. Of marks that are too close together,
 * only the first is returned.
 */
export function marksOf(timeline: Timeline, snapshots: readonly Snapshot[]): SnapshotMark[] {
  const { from, to } = timeline;
  if (from === undefined || to === undefined) return [];
  const shown = snapshots
    .map((snapshot) => ({ snapshot, time: snapshot.state_time ?? from }))
    .filter(
      ({ time }) => Date.parse(time) >= Date.parse(from) && Date.parse(time) <= Date.parse(to),
    )
    .map(({ snapshot, time }) => ({ snapshot, place: placeOfTime(timeline, time) }))
    .sort((a, b) => a.place - b.place);
  const apart: typeof shown = [];
  for (const mark of shown)
    if (apart.length === 0 || mark.place - apart.at(-1)!.place >= kLeastRoom) apart.push(mark);
  return apart.map((mark, index) => {
    const isLeft = mark.place > kToLeft;
    const before = apart[index - 1];
    const after = apart[index + 1];
    // A mark with its name on the left shares the space with the previous mark if the name of that
    // mark is on the right.
    const share = before && before.place <= kToLeft ? 2 : 1;
    const room = isLeft
      ? (mark.place - (before?.place ?? 0)) / share
      : after && after.place > kToLeft
        ? (after.place - mark.place) / 2
        : (after?.place ?? 1) - mark.place;
    return { ...mark, room };
  });
}
