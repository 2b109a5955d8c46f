// A line that was drawn over a picture, put onto the surface: it follows the surface on which it
// began. The server tells what each pixel of the drawing shows (`Step`); where the hand left the
// surface for a short way, as beside an edge, the line goes on along the surface instead of leaping
// to what lies behind, and where that cannot be it is cut.

import type { Point } from "../net/connection";
import { mark_length, simplify_line } from "./marks";
import type { MarkPlace, ProfileSample } from "../core/protocol.gen";
import { dot, length, subtract, type Vec3 } from "../math/vector";

export interface Step {
  at: Point; // on the picture
  place: MarkPlace | null; // null: there is no surface
  normal: Vec3 | null;
}
type Found = Step & { place: MarkPlace };
/** Steps that lie on the surface without a leap. */
type Run = Found[];

/**
 * Lengths of a drawing: that of a pixel at a place of the surface, in the model's unit, and pixels
 * of the picture in one of the screen.
 */
export interface Measures {
  pixel_at(place: MarkPlace): number;
  scale: number;
}

/** The nearest places of the surface along a straight way, in equal steps; the ends among them. */
export type NearestAlong = (
  from: MarkPlace,
  to: MarkPlace,
  step: number,
) => Promise<readonly (MarkPlace | null)[]>;

// In pixels of the picture, or lengths of so many there.
const kRelief = 6; // a step of the surface that needs no reason
const kLongestStep = 80; // where the surface is seen at 0.7°
const kDeepest = 40; // a leap that may be a part of the surface which hides itself
const kSlope = 2; // of the surface across a gap, to the plane of the picture
const kOffSurface = 0.2; // share of a step that may lead off the surface at either of its ends
// In pixels of the screen: how far a hand strays from an edge that it follows, and how long a gap
// may be without any surface.
const kStray_px = 16;
const kSmallGap_px = 24;

/**
 * What was found at each pixel of a path, with where that is: the server takes whole steps of a
 * pixel or less between two points.
 */
export function steps_along(path: readonly Point[], samples: readonly ProfileSample[]): Step[] {
  const at: Point[] = [path[0]!];
  path.slice(1).forEach(([x, y], index) => {
    const [from_x, from_y] = path[index]!;
    const count = Math.max(1, Math.ceil(Math.hypot(x - from_x, y - from_y)));
    for (let step = 1; step <= count; ++step)
      at.push([from_x + ((x - from_x) * step) / count, from_y + ((y - from_y) * step) / count]);
  });
  return samples.map(({ point: { hit, position, normal } }, index) => ({
    at: at[Math.min(index, at.length - 1)]!,
    place: hit && position ? position : null,
    normal: hit && normal ? normal : null,
  }));
}

const screen_distance = (a: Step, b: Step): number =>
  Math.hypot(a.at[0] - b.at[0], a.at[1] - b.at[1]);
const apart = (a: Found, b: Found): number => length(subtract(a.place, b.place));
const last_of = <T>(list: readonly T[]): T => list[list.length - 1]!;

/**
 * Whether the surface goes on from one step to the next: they are near each other, or it is seen so
 * much at a slant that both lie along it.
 */
function goes_on(from: Found, to: Found, pixel: number): boolean {
  const step = subtract(to.place, from.place);
  const far = length(step);
  if (far <= kRelief * pixel) return true;
  if (!from.normal || !to.normal || far > kLongestStep * pixel) return false;
  return (
    Math.max(Math.abs(dot(step, from.normal)), Math.abs(dot(step, to.normal))) <= kOffSurface * far
  );
}

function runs_of(steps: readonly Step[], { pixel_at }: Measures): Run[] {
  const runs: Run[] = [];
  let last: Found | null = null;
  for (const step of steps) {
    const found = step.place ? (step as Found) : null;
    if (found) {
      if (last && goes_on(last, found, pixel_at(last.place))) runs[runs.length - 1]!.push(found);
      else runs.push([found]);
    }
    last = found;
  }
  return runs;
}

/** Whether a step lies where the surface may have gone on to, after a gap of the drawing. */
function is_back(end: Found, step: Found, { pixel_at }: Measures): boolean {
  return apart(end, step) <= (kRelief + kSlope * screen_distance(end, step)) * pixel_at(end.place);
}

/** How long the runs are on the screen, from where the line left and to where it came back. */
function drawn_length(end: Found, aside: readonly Run[], back: Found | null): number {
  const way = [end, ...aside.flat(), ...(back ? [back] : [])];
  return way.slice(1).reduce((sum, step, index) => sum + screen_distance(way[index]!, step), 0);
}

function stray_of(end: Found, aside: readonly Run[], back: Found): number {
  const [x, y] = end.at;
  const [along_x, along_y] = [back.at[0] - x, back.at[1] - y];
  const squared = along_x * along_x + along_y * along_y;
  return Math.max(
    0,
    ...aside.flat().map(({ at }) => {
      const share =
        squared > 0
          ? Math.min(1, Math.max(0, ((at[0] - x) * along_x + (at[1] - y) * along_y) / squared))
          : 0;
      return Math.hypot(at[0] - x - share * along_x, at[1] - y - share * along_y);
    }),
  );
}

/**
 * The runs without those beside the surface: what lies much deeper or nearer than the way over it
 * is long, until the line is back.
 */
function kept_runs(runs: readonly Run[], measures: Measures): Run[] {
  const kept: Run[] = runs.slice(0, 1);
  for (let at = 1; at < runs.length;) {
    const end = last_of(last_of(kept));
    const pixel = measures.pixel_at(end.place);
    const leap = apart(end, runs[at]![0]!) / pixel;
    const leads_aside = (way: number): boolean => leap > Math.max(kRelief, way / 2);
    const back = runs.findIndex((run, index) => {
      if (index <= at || !is_back(end, run[0]!, measures)) return false;
      const aside = runs.slice(at, index);
      return (
        leads_aside(drawn_length(end, aside, run[0]!)) &&
        stray_of(end, aside, run[0]!) <= kStray_px * measures.scale
      );
    });
    if (back < 0) {
      const rest = drawn_length(end, runs.slice(at), null);
      // the hand slipped off the edge at the end
      if (rest <= kSmallGap_px * measures.scale && leads_aside(rest)) break;
    }
    at = back < 0 ? at : back;
    kept.push(runs[at]!);
    at += 1;
  }
  return kept;
}

/** The way over the surface between two runs, without its ends; null: there is none. */
async function joint(
  end: Found,
  begin: Found,
  measures: Measures,
  nearest_along: NearestAlong,
): Promise<MarkPlace[] | null> {
  const pixel = measures.pixel_at(end.place);
  const far = apart(end, begin);
  const back = is_back(end, begin, measures);
  if (far <= kRelief * pixel) return [];
  if (back || far <= kDeepest * pixel) {
    const step = Math.max(pixel, far / 256);
    const way = await nearest_along(end.place, begin.place, step);
    const places = [end.place, ...way.filter((place) => place !== null), begin.place];
    const goes = places
      .slice(1)
      .every((place, index) => length(subtract(place, places[index]!)) <= 4 * step);
    if (goes && mark_length({ coordinates: places }) <= 4 * far) return places.slice(1, -1);
  }
  return back && screen_distance(end, begin) <= kSmallGap_px * measures.scale ? [] : null;
}

/**
 * The line on the surface that was begun, in one piece, or in several where it crossed an edge and
 * could not go on.
 */
export async function line_on_surface(
  steps: readonly Step[],
  measures: Measures,
  nearest_along: NearestAlong,
): Promise<MarkPlace[][]> {
  const pieces: MarkPlace[][] = [];
  let end: Found | null = null;
  for (const run of kept_runs(runs_of(steps, measures), measures)) {
    const between = end && (await joint(end, run[0]!, measures, nearest_along));
    const places = run.map(({ place }) => place);
    if (between) pieces[pieces.length - 1]!.push(...between, ...places);
    else pieces.push(places);
    end = last_of(run);
  }
  return pieces
    .map((each) => simplify_line(each, (place) => measures.pixel_at(place) / 2))
    .filter((each) => mark_length({ coordinates: each }) > 0);
}

/**
 * How long such a line is, while it is drawn: what it goes along between two runs is taken as
 * straight.
 */
export function length_seen(steps: readonly Step[], measures: Measures): number {
  let sum = 0;
  let end: Found | null = null;
  for (const run of kept_runs(runs_of(steps, measures), measures)) {
    const begin = run[0]!;
    if (
      end &&
      (is_back(end, begin, measures) ||
        apart(end, begin) <= kDeepest * measures.pixel_at(end.place))
    )
      sum += apart(end, begin);
    const kept = simplify_line(
      run.map(({ place }) => place),
      (place) => measures.pixel_at(place) / 2,
    );
    sum += mark_length({ coordinates: kept });
    end = last_of(run);
  }
  return sum;
}
