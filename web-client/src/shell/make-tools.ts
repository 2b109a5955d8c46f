// Makes the tools of an open model and connects them to the parts of the model.

import type { Point } from "../net/stroke";
import type { PointerSample } from "../ui/input";
import type { ModelSession } from "../session/model-session";
import { BrushTool } from "../features/painting/brush-tool";
import { BucketTool } from "../features/painting/bucket-tool";
import { CommentTool } from "../features/comments/comment-tool";
import { FaceTool } from "../features/figures/face-tool";
import { LineTool } from "../features/records/line-tool";
import { MeasureTool } from "../features/measuring/measure-tool";
import { PartTool } from "../features/past/part-tool";
import { OrbitTool, PanTool } from "../tools/navigate";
import { LassoTool, PolygonTool, type EdgeSnapping } from "../tools/outline";
import { PickTool } from "../features/painting/pick-tool";
import type { Selection } from "../features/painting/selection";
import type { Strokes } from "../features/painting/strokes";
import { StrokesTool } from "../features/painting/strokes-tool";
import { WandTool } from "../features/painting/wand-tool";
import { PointTool } from "../features/records/point-tool";
import type { Tool, ToolName } from "../tools/tool";
import { ToolManager } from "../tools/tool-manager";

// Between the pixels of a selecting brush, as a share of its radius: its edge deviates by 1 %.
const kBrushSpacing = 0.3;

export interface ToolHost {
  /** Uses the selection of polygon, lasso, wand and strokes, after it is loaded. */
  withSelection(use: (selection: Selection) => void): void;
  /** Returns null until it is loaded. */
  edges(): EdgeSnapping | null;
  /** Returns null until they are loaded. */
  strokes(): Strokes | null;
  /** Another tool was activated. */
  chosen(name: ToolName): void;
  /** The outline of the active tool has changed. */
  outline(): void;
}

export function makeTools(session: ModelSession, host: ToolHost): ToolManager {
  const { painting } = session;
  const brushHost = {
    strokeEnded: () => painting.strokeEnded(),
    radiusPx: () => painting.radiusWindowPx(),
    widthOf: (pressure: number) => painting.widthOf(pressure),
    nextFrame: (callback: () => void) => void requestAnimationFrame(callback),
  };
  const radiusMm = (): number => painting.widthMetres() * 500;
  const wandBrush = {
    ...brushHost,
    beginStroke: (at: PointerSample) => {
      const { selection } = session;
      if (!selection || !painting.beginOutline(at)) return null;
      selection.addSimilar([at.x, at.y], at, radiusMm());
      const spacing = painting.radiusWindowPx() * kBrushSpacing;
      return { extend: (points: readonly Point[]) => selection.brushTo(points, spacing), end() {} };
    },
  };
  const comment = (sample: PointerSample): void => void session.comments.begin(sample);
  const middle = (): PointerSample => ({
    x: session.view.camera.width / 2,
    y: session.view.camera.height / 2,
  });
  const navigator = {
    orbit: (dx: number, dy: number) => session.view.orbitPixels(dx, dy),
    pan: (dx: number, dy: number) => session.view.panPixels(dx, dy),
    tap: (sample: PointerSample) => session.pointer.look(sample),
  };
  const { measuring } = session;
  const measureHost = {
    ...navigator,
    tap: (sample: PointerSample) => measuring.setAt(sample),
    pointAt: (sample: PointerSample | null) => measuring.pointAt(sample),
    setInMiddle: () => measuring.setInMiddle(),
    end: () => measuring.end(),
    takeBack: () => measuring.takeBack(),
    clear: () => measuring.clear(),
    begun: () => measuring.begun,
  };
  const faceHost = {
    ...navigator,
    tap: (sample: PointerSample) => void session.face.takeAt(sample),
    takeInMiddle: () => session.face.takeInMiddle(),
    giveUp: () => session.face.giveUp(),
  };
  const outlineHost = {
    beginOutline: (at: PointerSample) => session.painting.beginOutline(at),
    finishOutline: (path: Point[], corners: boolean) =>
      session.painting.finishOutline(path, corners),
    outlineEnded: () => session.painting.strokeEnded(),
    scale: () => session.view.scale,
    outlineChanged: () => host.outline(),
    edges: () => (session.painting.brush.snaps ? host.edges() : null),
    selection: {
      grab: (at: PointerSample) => session.selection?.grab(at) ?? false,
      drag: (to: PointerSample) => session.selection?.drag(to),
      release: (keep: boolean) => session.selection?.release(keep),
      key: (key: string) => session.selection?.key(key) ?? false,
    },
  };
  const partHost = {
    ...outlineHost,
    // The camera does not move while the outline is drawn.
    beginOutline: () => (session.painting.stroking = true),
    finishOutline: (path: Point[]) => session.past.setPart(path),
    giveUp: () => session.past.setPart(null),
  };
  const lineHost = {
    scale: outlineHost.scale,
    outlineEnded: outlineHost.outlineEnded,
    edges: outlineHost.edges,
    beginOutline: () => session.marks.beginLine(),
    finishOutline: (path: Point[]) => void session.marks.finishLine(path),
    outlineChanged: () => {
      session.marks.lineChanged(session.tools.outline);
      host.outline();
    },
  };
  const tools: Readonly<Record<ToolName, Tool>> = {
    orbit: new OrbitTool(navigator),
    pan: new PanTool(navigator),
    brush: new BrushTool("brush", { ...brushHost, beginStroke: () => painting.beginStroke(false) }),
    eraser: new BrushTool("eraser", {
      ...brushHost,
      beginStroke: () => painting.beginStroke(true),
    }),
    polygon: new PolygonTool(outlineHost),
    lasso: new LassoTool(outlineHost),
    strokes: new StrokesTool({ strokes: () => host.strokes() }),
    bucket: new BucketTool((sample) => session.painting.fillAt(sample)),
    wand: new WandTool({
      orbit: navigator.orbit,
      pan: navigator.pan,
      selectAt: (at) =>
        host.withSelection((selection) =>
          selection.addSimilar([at.x, at.y], at, selection.wand.brushes ? radiusMm() : null),
        ),
      active: (isActive) =>
        isActive
          ? host.withSelection((selection) =>
              selection.wandIsActive(session.tools.active === "wand"),
            )
          : session.selection?.wandIsActive(false),
      brushes: () => session.selection?.wand.brushes ?? false,
      brush: wandBrush,
      middle,
      selectionKey: outlineHost.selection.key,
    }),
    pick: new PickTool((sample) => session.pointer.take(sample)),
    line: new LineTool(lineHost),
    point: new PointTool(({ x, y }) => void session.marks.setPoint([x, y])),
    measure: new MeasureTool(measureHost),
    face: new FaceTool(faceHost),
    part: new PartTool(partHost),
    comment: new CommentTool({ ...navigator, tap: comment }, middle),
  };
  return new ToolManager(Object.values(tools), "orbit", (name) => host.chosen(name));
}
