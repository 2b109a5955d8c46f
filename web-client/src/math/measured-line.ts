// Measures of points that a user has set on a surface, computed only from these points. Lengths are
// in the unit of the points, areas in the square of this unit. domain/profile describes the surface
// between the points.

import { kFrames, type UpAxis } from "./camera";
import { add, cross, dot, length, scale, subtract, type Vec3 } from "./vector";

/** Returns the straight lengths from point to point, one for each leg. */
export const legsOf = (places: readonly Vec3[]): number[] =>
  places.slice(1).map((place, index) => length(subtract(place, places[index]!)));

export const sum = (numbers: readonly number[]): number =>
  numbers.reduce((total, each) => total + each, 0);

/** Returns the coordinate of the point along the model's up axis. */
export const heightOf = (place: Vec3, up: UpAxis): number => dot(place, kFrames[up].up);

export interface FlatPolygon {
  area: number;
  perimeter: number;
  /** The largest distance of a point from the plane. It is 0 if all points are in one plane. */
  off_plane: number;
}

/**
 * Returns the flat area of the polygon through the points, in their order (Newell's formula). The
 * area is exact for points in one plane. Otherwise it is the area of the projection in the
 * direction in which this area is largest. In a self-intersecting polygon, parts with the opposite
 * orientation have a negative area. Returns null for fewer than three points.
 */
export function flatPolygon(places: readonly Vec3[]): FlatPolygon | null {
  const [first, ...others] = places;
  if (!first || others.length < 2) return null;
  // A site may have large coordinates and small polygons.
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
