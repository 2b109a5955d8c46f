// Where the snapshots of a model are on the slider of its history.

import type { Snapshot, Timeline } from "../core/protocol.gen";
import { placeOfTime } from "./timeline";

/** A mark of the slider: from its place it has room until the next one, as a share of the width. */
export interface SnapshotMark {
  snapshot: Snapshot;
  place: number;
  room: number;
}

const kLeastRoom = 0.03;
const kToLeft = 0.8; // names of later marks are at their left

/** Marks of the snapshots whose state is in the shown time; where many are near, the first ones. */
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
    // A mark whose name is at its left shares the room with a name at the right of the one before.
    const share = before && before.place <= kToLeft ? 2 : 1;
    const room = isLeft
      ? (mark.place - (before?.place ?? 0)) / share
      : after && after.place > kToLeft
        ? (after.place - mark.place) / 2
        : (after?.place ?? 1) - mark.place;
    return { ...mark, room };
  });
}
