// The paths of least cost from one pixel to all others, over the 8 neighbors of each pixel. The
// algorithm is Dijkstra's with buckets for the costs (Dial 1969), so its time is proportional to
// the number of pixels. Runs in any thread and has no access to the page.

/** A step costs this factor times the cost of the pixel that it enters. Their ratio is about √2. */
export const kStraight = 5;
export const kDiagonal = 7;
/** A longer path could exceed the range of the costs. */
export const kMaxPixels = 1 << 20;

/** Returns the cost of the straight path between two pixels. */
export function costOfStraight(
  costs: Uint8Array,
  width: number,
  [fromX, fromY]: readonly [number, number],
  [toX, toY]: readonly [number, number],
): number {
  const steps = Math.max(Math.abs(toX - fromX), Math.abs(toY - fromY));
  let [sum, lastX, lastY] = [0, fromX, fromY];
  for (let step = 1; step <= steps; ++step) {
    const x = Math.round(fromX + ((toX - fromX) * step) / steps);
    const y = Math.round(fromY + ((toY - fromY) * step) / steps);
    sum += (x !== lastX && y !== lastY ? kDiagonal : kStraight) * costs[y * width + x]!;
    [lastX, lastY] = [x, y];
  }
  return sum;
}

const kBuckets = 2048; // a power of two above the cost of the dearest step
const kNone = -1;

export class LeastCostPaths {
  private readonly _stride: number; // with a border of one pixel around the picture
  private readonly _seed: number;
  private readonly _offsets: readonly number[];
  private readonly _costs: Int32Array; // of the whole path to each pixel
  private readonly _cameBy: Int8Array; // index of the last step, or kNone

  /**
   * `costs` are the costs of the pixels, from left to right and top to bottom. Throws a RangeError
   * if the size does not match, if there are more than `kMaxPixels` pixels, or if the seed is
   * outside the picture.
   */
  constructor(
    costs: Uint8Array,
    private readonly _width: number,
    private readonly _height: number,
    seed: readonly [number, number],
  ) {
    const count = _width * _height;
    if (costs.length !== count || count < 1 || count > kMaxPixels)
      throw new RangeError(`${costs.length} costs for ${_width} × ${_height} pixels`);
    const stride = (this._stride = _width + 2);
    this._offsets = [1, -1, stride, -stride, stride + 1, stride - 1, 1 - stride, -1 - stride];
    this._seed = this.indexOf(seed);
    const padded = stride * (_height + 2);
    this._costs = new Int32Array(padded).fill(-1); // the border counts as settled
    this._cameBy = new Int8Array(padded).fill(kNone);
    const entering = new Uint8Array(padded);
    for (let y = 0; y < _height; ++y) {
      const row = (y + 1) * stride + 1;
      this._costs.fill(0x7fffffff, row, row + _width);
      entering.set(costs.subarray(y * _width, (y + 1) * _width), row);
    }
    this.settle(entering);
  }

  /** Returns the cost of the path to a pixel. */
  costTo(pixel: readonly [number, number]): number {
    return this._costs[this.indexOf(pixel)]!;
  }

  /** Returns the pixels of the path, from the seed to the given pixel. */
  pathTo(pixel: readonly [number, number]): [number, number][] {
    const path: [number, number][] = [];
    for (let at = this.indexOf(pixel); ; at -= this._offsets[this._cameBy[at]!]!) {
      path.push([(at % this._stride) - 1, Math.floor(at / this._stride) - 1]);
      if (at === this._seed) return path.reverse();
    }
  }

  private indexOf([x, y]: readonly [number, number]): number {
    const { _width: width, _height: height } = this;
    if (!(
      Number.isInteger(x) &&
      Number.isInteger(y) &&
      x >= 0 &&
      x < width &&
      y >= 0 &&
      y < height
    ))
      throw new RangeError(`pixel ${x}, ${y} is outside ${width} × ${height} pixels`);
    return (y + 1) * this._stride + x + 1;
  }

  private settle(entering: Uint8Array): void {
    const { _costs: costs, _cameBy: cameBy, _offsets: offsets } = this;
    // Each bucket is a doubly linked list of the waiting pixels with the same cost.
    const first = new Int32Array(kBuckets).fill(kNone);
    const next = new Int32Array(costs.length).fill(kNone);
    const previous = new Int32Array(costs.length).fill(kNone);
    const add = (at: number, cost: number): void => {
      const bucket = cost & (kBuckets - 1);
      const head = first[bucket]!;
      next[at] = head;
      previous[at] = kNone;
      if (head !== kNone) previous[head] = at;
      first[bucket] = at;
    };
    const remove = (at: number, cost: number): void => {
      const [before, after] = [previous[at]!, next[at]!];
      if (before === kNone) first[cost & (kBuckets - 1)] = after;
      else next[before] = after;
      if (after !== kNone) previous[after] = before;
    };
    costs[this._seed] = 0;
    add(this._seed, 0);
    let waiting = 1;
    for (let cost = 0; waiting > 0; ++cost)
      for (
        let at = first[cost & (kBuckets - 1)]!;
        at !== kNone;
        at = first[cost & (kBuckets - 1)]!
      ) {
        remove(at, cost);
        --waiting;
        for (let step = 0; step < 8; ++step) {
          const to = at + offsets[step]!;
          const reached = cost + (step < 4 ? kStraight : kDiagonal) * entering[to]!;
          const known = costs[to]!;
          if (reached >= known) continue; // also for settled pixels and the border
          if (known === 0x7fffffff) ++waiting;
          else remove(to, known);
          costs[to] = reached;
          cameBy[to] = step;
          add(to, reached);
        }
      }
  }
}
