import { describe, expect, it } from "vitest";

import { marksOf } from "../../src/domain/snapshot-marks";
import type { Snapshot, Timeline } from "../../src/core/protocol.gen";

describe("marks of snapshots", () => {
  const at = (minute: number): string => new Date(Date.UTC(2026, 4, 4, 12, minute)).toISOString();
  const snapshot = (id: number, minute: number | null): Snapshot => ({
    id,
    slug: `s${id}`,
    name: `S ${id}`,
    text: "",
    sequence: id,
    ...(minute === null ? {} : { state_time: at(minute) }),
    user: "ada",
    time: at(59),
    version: 1,
  });
  const shown: Timeline = { newest: 9, edits: 9, from: at(0), to: at(50), intervals: [] };
  const told = (snapshots: Snapshot[]): [number, number, number][] =>
    marksOf(shown, snapshots).map(({ snapshot: { id }, place, room }) => [
      id,
      Number(place.toFixed(2)),
      Number(room.toFixed(2)),
    ]);

  it("are at the times of their states, with room until the next one", () => {
    expect(told([snapshot(2, 25), snapshot(1, 10)])).toEqual([
      [1, 0.2, 0.3],
      [2, 0.5, 0.5],
    ]);
  });

  it("have their names at the left near the end, and share the room", () => {
    expect(told([snapshot(1, 30), snapshot(2, 45), snapshot(3, 50)])).toEqual([
      [1, 0.6, 0.15],
      [2, 0.9, 0.15],
      [3, 1, 0.1],
    ]);
  });

  it("leave out other times, and marks that would lie over another one", () => {
    expect(told([snapshot(1, null), snapshot(2, 1), snapshot(3, 55)])).toEqual([[1, 0, 1]]);
    expect(marksOf({ newest: 0, edits: 0, intervals: [] }, [snapshot(1, 3)])).toEqual([]);
  });
});
