// Measures of places that a user has set on a surface, computed from the places alone: lengths in
// their unit, areas in its square. domain/profile describes the surface between them.

import { kFrames, type UpAxis } from "./camera";
import { add, cross, dot, length, scale, subtract, type Vec3 } from "./vector";

/** The straight lengths from place to place, one for each leg. */
export const legsOf = (places: readonly Vec3[]): number[] =>
  places.slice(1).map((place, index) => length(subtract(place, places[index]!)));

export const sum = (numbers: readonly number[]): number =>
  numbers.reduce((total, each) => total + each, 0);

/** The place's coordinate along the model's up axis. */
export const heightOf = (place: Vec3, up: UpAxis): number => dot(place, kFrames[up].up);

export interface FlatPolygon {
  area: number;
  perimeter: number;
  /** Largest distance of a place from the plane: 0 where all are in one plane. */
  off_plane: number;
}

/**
 * The flat area of the polygon through the places, in their order (Newell's formula): exact for
 * places in one plane; otherwise the area of the projection along the normal with the largest area.
 * In a self-intersecting polygon, parts with the opposite orientation count as negative. Null:
 * fewer than three places.
 */
export function flatPolygon(places: readonly Vec3[]): FlatPolygon | null {
  const [first, ...others] = places;
  if (!first || others.length < 2) return null;
  // coordinates of a site may be large and its polygons small
  const fromFirst = others.map((place) => subtract(place, first));
  const twice = fromFirst
    .slice(1)
    .reduce<Vec3>((total, each, index) => add(total, cross(fromFirst[index]!, each)), [0, 0, 0]);
  const area = length(twice) / 2;
  const perimeter = sum(legsOf([...places, first]));
  if (area === 0) return { area, perimeter, off_plane: 0 };
  const normal = scale(twice, 1 / (2 * area));
  const offsets = [0, ...fromFirst.map((each) => dot(each, normal))];
  const middle = sum(offsets) / offsets.length;
  return {
    area,
    perimeter,
    off_plane: Math.max(...offsets.map((each) => Math.abs(each - middle))),
  };
}
