// Where the user sees the surface on which lines and points are drawn: through a camera, or on an
// unrolled sheet.

import type { MarkPlace, ProfileRequest, ProfileSample, UnrolledLine } from "../core/protocol.gen";
import type { Model } from "../core/types";
import { metresPer } from "../domain/measure";
import { stepsAlong, type Measures, type Step } from "../domain/surface-line";
import { pixelSizeThrough, type CameraMessage } from "../math/camera";
import type { Api } from "../net/api";
import type { Point } from "../net/stroke";

export interface MarkSight {
  readonly measures: Measures;
  /** Returns the surface along a drawn path. */
  along(path: readonly Point[]): Promise<Step[]>;
  /** Returns the surface at a drawn point, or null off the surface. */
  at(point: Point): Promise<MarkPlace | null>;
}

/** The model on the server. */
export interface SightHost {
  api: Api;
  model: Pick<Model, "id" | "unit">;
}

const kMostPoints = 1000; // of a path in the contract
const kOneStepMm = 1e9; // longer than any part of a path

const profile = async (
  { api, model }: SightHost,
  body: ProfileRequest,
): Promise<readonly ProfileSample[]> =>
  (await api.json("POST /models/{model}/profile", { path: { model: `${model.id}` }, body }))
    .samples;

/** Points are pixels of the camera's window. `scale` is the number of them per screen pixel. */
export const sightThrough = (host: SightHost, camera: CameraMessage, scale: number): MarkSight => ({
  measures: { pixelAt: pixelSizeThrough(camera), scale },
  along: async (path) =>
    stepsAlong(path, await profile(host, { camera, path: [...path], layers: [] })),
  at: async ([x, y]) => {
    const { hit, position } = await host.api.json("POST /models/{model}/pick", {
      path: { model: `${host.model.id}` },
      body: { camera, x, y },
    });
    return hit && position ? position : null;
  },
});

/**
 * Points are millimeters on the sheet, y up. `mmPerPixel` is the width of a screen pixel. A path is
 * followed in steps of this width, or in longer ones if it is long.
 */
export function sightOnSheet(
  host: SightHost,
  sheet: Omit<UnrolledLine, "path">,
  mmPerPixel: number,
): MarkSight {
  let step = mmPerPixel;
  const samples = (path: Point[]): Promise<readonly ProfileSample[]> =>
    profile(host, { unrolled: { ...sheet, path }, step_mm: kOneStepMm, layers: [] });
  const mmPerUnit = metresPer(host.model.unit) * 1000;
  return {
    measures: { pixelAt: () => step / mmPerUnit, scale: 1 },
    along: async (path) => {
      step = Math.max(mmPerPixel, lengthOf(path) / (kMostPoints - path.length));
      const steps = inSteps(path, step);
      const found = await samples(steps);
      return steps.map(([x, y], i) => {
        const { hit, position, normal } = found[i]!.point;
        return {
          at: [x / step, y / step],
          place: hit && position ? position : null,
          normal: hit && normal ? normal : null,
        };
      });
    },
    at: async (point) => {
      const [found] = await samples([point, point]);
      return found!.point.hit ? (found!.point.position ?? null) : null;
    },
  };
}

const apart = ([ax, ay]: Point, [bx, by]: Point): number => Math.hypot(ax - bx, ay - by);

const lengthOf = (path: readonly Point[]): number =>
  path.slice(1).reduce((sum, point, i) => sum + apart(path[i]!, point), 0);

/** Returns the points of a path in steps of at most this length, including its corners. */
function inSteps(path: readonly Point[], step: number): Point[] {
  const points: Point[] = [path[0]!];
  path.slice(1).forEach((to, i) => {
    const from = path[i]!;
    const count = Math.max(1, Math.floor(apart(from, to) / step));
    for (let k = 1; k <= count; ++k)
      points.push([
        from[0] + ((to[0] - from[0]) * k) / count,
        from[1] + ((to[1] - from[1]) * k) / count,
      ]);
  });
  return points;
}
