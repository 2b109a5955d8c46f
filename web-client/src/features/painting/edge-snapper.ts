// Follows edges in the shown frame, for polygons and lines, and moves lassos to them. For a point, a
// part of the frame around it is enough. The costs of this part, and the paths from the point to all
// of its pixels, are computed once per point, so a moved pointer only needs to look up its path.

import { simplifyLine } from "../../domain/marks";
import { edgeCosts, kMaxCost } from "../../math/edge-costs";
import { costOfStraight, LeastCostPaths } from "../../math/least-cost-paths";
import type { Point } from "../../net/stroke";
import type { EdgeSnapping } from "../../tools/outline";
import { fittedOutline, kFitReach } from "./outline-fitter";
import type { SharpFrame } from "./sharp-frame";

export interface EdgeSnapperHost {
  /** Returns null while the 3D view shows no such frame. */
  frame(): SharpFrame | null;
  /** The size of the camera's window in window pixels. */
  window(): { width: number; height: number };
  /** The number of window pixels per CSS pixel. */
  scale(): number;
  nowMs(): number;
}

type Pixel = readonly [number, number];

/** A part of a frame. */
interface Part {
  frame: Pick<SharpFrame, "number" | "camera" | "width" | "height">;
  readMs: number;
  x: number;
  y: number;
  width: number;
  height: number;
  costs: Uint8Array;
}

// These lengths are in pixels of the frame.
export const kPartSize = 512; // limits the time and memory for a point
const kPointerMargin = 64; // a new part reaches this far beyond the pointer
const kMargin = 4; // pixels closer to the border of a part are not smoothed correctly
const kTolerance = 0.75; // of the simplified path

export const kSnapReach = 4; // CSS pixels by which a point moves to an edge
const kEdgeCost = kMaxCost / 2; // a pixel with a higher cost is no edge
// A path that costs more than this share of the straight one follows nothing but noise.
const kWorth = 0.8;
// While the content of the frame changes, for example because others paint, a newer frame replaces
// the read one at most this often.
const kReadEveryMs = 500;

export class EdgeSnapper implements EdgeSnapping {
  private _part: Part | null = null;
  private _tree: { part: Part; from: Pixel; paths: LeastCostPaths } | null = null;
  private _edge: { paths: LeastCostPaths; to: Pixel; points: Point[] } | null = null;

  constructor(private readonly _host: EdgeSnapperHost) {}

  placeAt(at: Point, from: Point | null): Point {
    const part = this.partWith(from ?? at, at);
    if (!part) return at;
    const [atX, atY] = this.pixelAt(at, part);
    const reach = kSnapReach * this._host.scale() * (part.frame.width / this._host.window().width);
    const steps = Math.floor(reach);
    let best: Pixel | null = null;
    let [least, nearest] = [kEdgeCost, 0];
    for (let y = Math.max(0, atY - steps); y <= Math.min(part.height - 1, atY + steps); ++y)
      for (let x = Math.max(0, atX - steps); x <= Math.min(part.width - 1, atX + steps); ++x) {
        const distance = Math.hypot(x - atX, y - atY);
        const cost = part.costs[y * part.width + x]!;
        if (distance > reach || cost > least || (cost === least && distance >= nearest)) continue;
        [best, least, nearest] = [[x, y], cost, distance];
      }
    return best ? this.pointAt(best, part) : at;
  }

  between(from: Point, to: Point): Point[] {
    const part = this.partWith(from, to);
    if (!part) return [];
    const start = this.pixelAt(from, part);
    const end = this.pixelAt(to, part);
    const paths = this.pathsFrom(start, part);
    if (this._edge?.paths !== paths || !isSame(this._edge.to, end)) {
      const straight = costOfStraight(part.costs, part.width, start, end);
      const isWorth = paths.costTo(end) < kWorth * straight;
      const points = isWorth ? this.pointsOf(paths.pathTo(end), part) : [];
      this._edge = { paths, to: end, points };
    }
    return this._edge.points;
  }

  around(outline: readonly Point[]): Point[] {
    const frame = this._host.frame();
    if (!frame) return [...outline];
    const view = this._host.window();
    const [across, down] = [frame.width / view.width, frame.height / view.height];
    const inFrame = outline.map(([x, y]): Point => [x * across, y * down]);
    const reach = kFitReach * this._host.scale() * across;
    return fittedOutline(frame, inFrame, reach).map(([x, y]) => [x / across, y / down]);
  }

  /** Returns the points of a path, without its ends. */
  private pointsOf(path: readonly Pixel[], part: Part): Point[] {
    const places = path.map(([x, y]): [number, number, number] => [x, y, 0]);
    return simplifyLine(places, () => kTolerance)
      .slice(1, -1)
      .map(([x, y]) => this.pointAt([x, y], part));
  }

  private pathsFrom(from: Pixel, part: Part): LeastCostPaths {
    if (this._tree?.part !== part || !isSame(this._tree.from, from)) {
      const { costs, width, height } = part;
      this._tree = { part, from, paths: new LeastCostPaths(costs, width, height, from) };
    }
    return this._tree.paths;
  }

  /**
   * Returns a part of the frame with both points. Returns null if no part has both, or if the frame
   * does not show the current camera, because edges of an older picture would be at other places.
   */
  private partWith(from: Point, to: Point): Part | null {
    const frame = this._host.frame();
    if (!frame) return null;
    if (this._part && this.isCurrent(this._part, frame) && this.hasBoth(this._part, from, to))
      return this._part;
    const part = this.read(frame, from, to);
    if (part) this._part = part;
    return part;
  }

  private isCurrent({ frame: known, readMs }: Part, frame: SharpFrame): boolean {
    if (known.number === frame.number) return true;
    return (
      known.camera === frame.camera &&
      known.width === frame.width &&
      known.height === frame.height &&
      this._host.nowMs() - readMs < kReadEveryMs
    );
  }

  private hasBoth(part: Part, from: Point, to: Point): boolean {
    return [from, to].every((point) => {
      const [x, y] = this.pixelAt(point, part);
      return (
        isWithin(x, part.width, part.x, part.frame.width) &&
        isWithin(y, part.height, part.y, part.frame.height)
      );
    });
  }

  private read(frame: SharpFrame, from: Point, to: Point): Part | null {
    const [fromX, fromY] = this.framePixelAt(from, frame);
    const [toX, toY] = this.framePixelAt(to, frame);
    const across = rangeWith(fromX, toX, frame.width);
    const down = rangeWith(fromY, toY, frame.height);
    if (!across || !down) return null;
    const { at: x, size: width } = across;
    const { at: y, size: height } = down;
    const pixels = frame.read(x, y, width, height);
    return {
      frame,
      readMs: this._host.nowMs(),
      x,
      y,
      width,
      height,
      costs: edgeCosts({ width, height, channels: 4, pixels }),
    };
  }

  private framePixelAt([x, y]: Point, frame: Part["frame"]): Pixel {
    const { width, height } = this._host.window();
    return [Math.floor((x / width) * frame.width), Math.floor((y / height) * frame.height)];
  }

  private pixelAt(point: Point, part: Part): Pixel {
    const [x, y] = this.framePixelAt(point, part.frame);
    return [x - part.x, y - part.y];
  }

  /** Returns the middle of a pixel as window pixels. */
  private pointAt([x, y]: Pixel, part: Part): Point {
    const { width, height } = this._host.window();
    return [
      ((x + part.x + 0.5) / part.frame.width) * width,
      ((y + part.y + 0.5) / part.frame.height) * height,
    ];
  }
}

const isSame = (a: Pixel, b: Pixel): boolean => a[0] === b[0] && a[1] === b[1];

/** Whether a part of a frame contains a pixel, not too close to a border inside the frame. */
function isWithin(at: number, size: number, start: number, whole: number): boolean {
  const first = start === 0 ? 0 : kMargin;
  const last = start + size === whole ? size - 1 : size - 1 - kMargin;
  return at >= first && at <= last;
}

/**
 * Returns the range of a part along one axis. `from` is in its middle, if the pointer is then
 * inside. Returns null if both are too far apart, or outside the frame.
 */
function rangeWith(from: number, to: number, whole: number): { at: number; size: number } | null {
  if (Math.min(from, to) < 0 || Math.max(from, to) >= whole) return null;
  const size = Math.min(kPartSize, whole);
  const margin = kPointerMargin;
  if (Math.abs(to - from) > size - 1 - margin - kMargin && size < whole) return null;
  const centered = from - Math.floor(size / 2);
  const moved = Math.min(Math.max(centered, to + margin - (size - 1)), to - margin);
  const start = Math.min(Math.max(moved, 0), whole - size);
  return { at: start, size };
}
