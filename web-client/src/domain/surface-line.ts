// Projects a line that a user drew over the frame onto the surface where it began. The server
// returns the surface point at each pixel of the drawing (`Step`). The drawing may leave the
// surface for a short distance, for example next to an edge. The line then continues along the
// surface and does not jump to the background. If it cannot continue, it is cut.

import type { Point } from "../net/stroke";
import { markLength, simplifyLine } from "./marks";
import type { MarkPlace, ProfileSample } from "../core/protocol.gen";
import { dot, length, subtract, type Vec3 } from "../math/vector";

export interface Step {
  at: Point; // in the frame
  place: MarkPlace | null; // null off the surface
  normal: Vec3 | null;
}
type Found = Step & { place: MarkPlace };
/** Consecutive steps on the surface without a jump. */
type Run = Found[];

/**
 * Lengths of a drawing. `pixelAt` returns the length of a pixel at a point of the surface, in the
 * model's unit. `scale` is the number of frame pixels per screen pixel.
 */
export interface Measures {
  pixelAt(place: MarkPlace): number;
  scale: number;
}

/**
 * Returns the nearest surface points along a straight line, in equal steps, including both ends.
 */
export type NearestAlong = (
  from: MarkPlace,
  to: MarkPlace,
  step: number,
) => Promise<readonly (MarkPlace | null)[]>;

// In pixels of the frame, or in lengths of a pixel at the point.
const kRelief = 6; // a step that is always accepted
const kLongestStep = 80; // reached at a viewing angle of 0.7° to the surface
const kDeepest = 40; // a jump that may be a hidden part of the surface
const kSlope = 2; // slope of the surface across a gap, relative to the image plane
const kOffSurface = 0.2; // fraction of a step that may be off the surface at either end
// In pixels of the screen: the largest distance of the drawing from the edge that it follows, and
// the longest gap without any surface.
const kStrayPx = 16;
const kSmallGapPx = 24;

/**
 * Returns the server's result at each pixel of a path, with its position. Between two points, the
 * server makes equal steps of at most one pixel.
 */
export function stepsAlong(path: readonly Point[], samples: readonly ProfileSample[]): Step[] {
  const at: Point[] = [path[0]!];
  path.slice(1).forEach(([x, y], index) => {
    const [fromX, fromY] = path[index]!;
    const count = Math.max(1, Math.ceil(Math.hypot(x - fromX, y - fromY)));
    for (let step = 1; step <= count; ++step)
      at.push([fromX + ((x - fromX) * step) / count, fromY + ((y - fromY) * step) / count]);
  });
  return samples.map(({ point: { hit, position, normal } }, index) => ({
    at: at[Math.min(index, at.length - 1)]!,
    place: hit && position ? position : null,
    normal: hit && normal ? normal : null,
  }));
}

const screenDistance = (a: Step, b: Step): number =>
  Math.hypot(a.at[0] - b.at[0], a.at[1] - b.at[1]);
const apart = (a: Found, b: Found): number => length(subtract(a.place, b.place));
const lastOf = <T>(list: readonly T[]): T => list[list.length - 1]!;

/**
 * Whether the surface continues from one step to the next. This is true if their points are close
 * together. It is also true if both points are on a surface that is seen at a very flat angle.
 */
function goesOn(from: Found, to: Found, pixel: number): boolean {
  const step = subtract(to.place, from.place);
  const far = length(step);
  if (far <= kRelief * pixel) return true;
  if (!from.normal || !to.normal || far > kLongestStep * pixel) return false;
  return (
    Math.max(Math.abs(dot(step, from.normal)), Math.abs(dot(step, to.normal))) <= kOffSurface * far
  );
}

function runsOf(steps: readonly Step[], { pixelAt }: Measures): Run[] {
  const runs: Run[] = [];
  let last: Found | null = null;
  for (const step of steps) {
    const found = step.place ? (step as Found) : null;
    if (found) {
      if (last && goesOn(last, found, pixelAt(last.place))) runs[runs.length - 1]!.push(found);
      else runs.push([found]);
    }
    last = found;
  }
  return runs;
}

/** Whether the surface may continue from `end` to a step after a gap in the drawing. */
function isBack(end: Found, step: Found, { pixelAt }: Measures): boolean {
  return apart(end, step) <= (kRelief + kSlope * screenDistance(end, step)) * pixelAt(end.place);
}

/**
 * Returns the length of the runs on the screen. The length includes the distance from `end` to the
 * first run, and the distance from the last run to `back` on the surface.
 */
function drawnLength(end: Found, aside: readonly Run[], back: Found | null): number {
  const way = [end, ...aside.flat(), ...(back ? [back] : [])];
  return way.slice(1).reduce((sum, step, index) => sum + screenDistance(way[index]!, step), 0);
}

function strayOf(end: Found, aside: readonly Run[], back: Found): number {
  const [x, y] = end.at;
  const [alongX, alongY] = [back.at[0] - x, back.at[1] - y];
  const squared = alongX * alongX + alongY * alongY;
  return Math.max(
    0,
    ...aside.flat().map(({ at }) => {
      const share =
        squared > 0
          ? Math.min(1, Math.max(0, ((at[0] - x) * alongX + (at[1] - y) * alongY) / squared))
          : 0;
      return Math.hypot(at[0] - x - share * alongX, at[1] - y - share * alongY);
    }),
  );
}

/**
 * Returns the runs that are on the surface. A run is off the surface if its jump in depth is larger
 * than half the length that is drawn until the line returns.
 */
function keptRuns(runs: readonly Run[], measures: Measures): Run[] {
  const kept: Run[] = runs.slice(0, 1);
  for (let at = 1; at < runs.length;) {
    const end = lastOf(lastOf(kept));
    const pixel = measures.pixelAt(end.place);
    const leap = apart(end, runs[at]![0]!) / pixel;
    const leadsAside = (way: number): boolean => leap > Math.max(kRelief, way / 2);
    const back = runs.findIndex((run, index) => {
      if (index <= at || !isBack(end, run[0]!, measures)) return false;
      const aside = runs.slice(at, index);
      return (
        leadsAside(drawnLength(end, aside, run[0]!)) &&
        strayOf(end, aside, run[0]!) <= kStrayPx * measures.scale
      );
    });
    if (back < 0) {
      const rest = drawnLength(end, runs.slice(at), null);
      // the pointer slipped off the edge at the end of the line
      if (rest <= kSmallGapPx * measures.scale && leadsAside(rest)) break;
    }
    at = back < 0 ? at : back;
    kept.push(runs[at]!);
    at += 1;
  }
  return kept;
}

/**
 * Returns the path over the surface between two runs, without its ends. Returns null if no such
 * path exists.
 */
async function joint(
  end: Found,
  begin: Found,
  measures: Measures,
  nearestAlong: NearestAlong,
): Promise<MarkPlace[] | null> {
  const pixel = measures.pixelAt(end.place);
  const far = apart(end, begin);
  const back = isBack(end, begin, measures);
  if (far <= kRelief * pixel) return [];
  if (back || far <= kDeepest * pixel) {
    const step = Math.max(pixel, far / 256);
    const way = await nearestAlong(end.place, begin.place, step);
    const places = [end.place, ...way.filter((place) => place !== null), begin.place];
    const goes = places
      .slice(1)
      .every((place, index) => length(subtract(place, places[index]!)) <= 4 * step);
    if (goes && markLength({ coordinates: places }) <= 4 * far) return places.slice(1, -1);
  }
  return back && screenDistance(end, begin) <= kSmallGapPx * measures.scale ? [] : null;
}

/**
 * Returns the line on the surface where the drawing began. The line has several pieces if it
 * crossed an edge and could not continue.
 */
export async function lineOnSurface(
  steps: readonly Step[],
  measures: Measures,
  nearestAlong: NearestAlong,
): Promise<MarkPlace[][]> {
  const pieces: MarkPlace[][] = [];
  let end: Found | null = null;
  for (const run of keptRuns(runsOf(steps, measures), measures)) {
    const between = end && (await joint(end, run[0]!, measures, nearestAlong));
    const places = run.map(({ place }) => place);
    if (between) pieces[pieces.length - 1]!.push(...between, ...places);
    else pieces.push(places);
    end = lastOf(run);
  }
  return pieces
    .map((each) => simplifyLine(each, (place) => measures.pixelAt(place) / 2))
    .filter((each) => markLength({ coordinates: each }) > 0);
}

/**
 * Returns the length of the line during drawing. The part between two runs is a straight
 * line.
 */
export function lengthSeen(steps: readonly Step[], measures: Measures): number {
  let sum = 0;
  let end: Found | null = null;
  for (const run of keptRuns(runsOf(steps, measures), measures)) {
    const begin = run[0]!;
    if (
      end &&
      (isBack(end, begin, measures) || apart(end, begin) <= kDeepest * measures.pixelAt(end.place))
    )
      sum += apart(end, begin);
    const kept = simplifyLine(
      run.map(({ place }) => place),
      (place) => measures.pixelAt(place) / 2,
    );
    sum += markLength({ coordinates: kept });
    end = lastOf(run);
  }
  return sum;
}
