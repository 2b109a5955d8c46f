// The surface along a line, as the server answers it, made ready to be told and drawn: how far each
// place is along the surface, where the line leaves it, and what a layer holds there.

import { partsOfLine, simplifyLine } from "./marks";
import type { ProfileSample } from "../core/protocol.gen";
import { length, subtract, type Vec3 } from "../math/vector";

/** A place on the surface. Lengths in the model's unit. */
export interface ProfilePlace {
  along: number;
  place: Vec3;
  normal: Vec3 | null;
  /** Of the layer that was asked for; null where it has none. */
  value: number | null;
}

/** Parts of a line that lie on the surface without a gap, each with at least one place. */
export type ProfileParts = readonly (readonly ProfilePlace[])[];

/** What lies between two parts (see `partsOfLine`) adds nothing to the distances. */
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

/** Along the surface, without the gaps. */
export const lengthOf = (parts: ProfileParts): number =>
  parts[parts.length - 1]?.at(-1)?.along ?? 0;

/** Whether the line comes as near to each of the places as `reachAt` allows there. */
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
 * Only what its course needs to be drawn: no place farther than the tolerance there is left out.
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
