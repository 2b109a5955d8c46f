// The surface along a line: prepares the server's answer for text and plot, with the distance along
// the surface, the gaps in it, and a layer's values.

import { partsOfLine, simplifyLine } from "./marks";
import type { ProfileSample } from "../core/protocol.gen";
import { length, subtract, type Vec3 } from "../math/vector";

/** A place on the surface. Lengths in the model's unit. */
export interface ProfilePlace {
  along: number;
  place: Vec3;
  normal: Vec3 | null;
  /** The value of the requested layer; null where it has none. */
  value: number | null;
}

/** Continuous parts of a line on the surface, each with at least one place. */
export type ProfileParts = readonly (readonly ProfilePlace[])[];

/** A gap between two parts (see `partsOfLine`) adds nothing to the distances. */
export function profileParts(
  samples: readonly ProfileSample[],
  stepAt: (place: Vec3) => number,
  layer: string | null,
): ProfileParts {
  const found = samples.map(({ point: { hit, position, normal, values } }): ProfilePlace | null => {
    if (!hit || !position) return null;
    const value = layer === null ? undefined : values?.[layer];
    return {
      along: 0,
      place: position,
      normal: normal ?? null,
      value: value?.valid && value.value !== undefined ? value.value : null,
    };
  });
  const parts = partsOfLine(found, ({ place }) => place as [number, number, number], stepAt);
  let along = 0;
  for (const part of parts) {
    part.forEach((each, index) => {
      if (index > 0) along += length(subtract(each.place, part[index - 1]!.place));
      each.along = along;
    });
  }
  return parts;
}

/** The length along the surface, without the gaps. */
export const lengthOf = (parts: ProfileParts): number =>
  parts[parts.length - 1]?.at(-1)?.along ?? 0;

/** Whether the line passes each of the places within the distance `reachAt`. */
export const passesThrough = (
  parts: ProfileParts,
  places: readonly Vec3[],
  reachAt: (place: Vec3) => number,
): boolean =>
  places.every((place) =>
    parts.some((part) =>
      part.some((each) => length(subtract(each.place, place)) <= reachAt(place)),
    ),
  );

/**
 * Keeps only the places that the plot needs: a removed place is no farther from the line than the
 * tolerance there.
 */
export function simplifyProfile(
  parts: ProfileParts,
  toleranceAt: (place: Vec3) => number,
): ProfileParts {
  return parts.map((part) => {
    const kept = new Set<Vec3>(
      simplifyLine(
        part.map(({ place }) => place as [number, number, number]),
        toleranceAt,
      ),
    );
    return part.filter(({ place }) => kept.has(place));
  });
}
