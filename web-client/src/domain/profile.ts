// Prepares the server's profile of the surface along a line for text and plot. It computes the
// distance along the surface, the gaps, and a layer's values.

import { partsOfLine, simplifyLine } from "./marks";
import type { ProfileSample } from "../core/protocol.gen";
import { length, subtract, type Vec3 } from "../math/vector";

/** A point on the surface. Lengths are in the model's unit. */
export interface ProfilePlace {
  along: number;
  place: Vec3;
  normal: Vec3 | null;
  /** The value of the requested layer at the point. Null if it has no value there. */
  value: number | null;
}

/** Continuous parts of a line on the surface, each with at least one point. */
export type ProfileParts = readonly (readonly ProfilePlace[])[];

/**
 * Splits samples of a line into parts. A gap between two parts (see `partsOfLine`) is not
 * included in the distance.
 */
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

/** Returns the length along the surface, without the gaps. */
export const lengthOf = (parts: ProfileParts): number =>
  parts[parts.length - 1]?.at(-1)?.along ?? 0;

/** Whether the line passes each of these points within the distance that `reachAt` returns. */
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
 * Keeps only the points that the plot needs. The distance of a removed point from the line is at
 * most the tolerance at that point.
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
