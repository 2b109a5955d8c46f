// Draws lines and points on the surface. They belong to the record that the brush paints, in the
// layer's table.

import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { readRecord, changeRecord } from "../../net/records";
import type { Point } from "../../net/stroke";
import { markColumns, markLength, marksOf, type MarkKind } from "../../domain/marks";
import { formatLength, metresPer } from "../../domain/measure";
import type { Column, MarkPlace, TableRecord } from "../../core/protocol.gen";
import { lengthSeen, lineOnSurface, type Step } from "../../domain/surface-line";
import type { Model } from "../../core/types";
import type { Outline } from "../../tools/tool";
import { LineMeasure } from "../../session/line-measure";
import { sightThrough, type MarkSight } from "../../session/mark-sight";
import { notices } from "../../ui/notices";
import { texts } from "../../texts";
import type { ViewControl } from "../../session/view-control";
import type { LayersPart, PaintingPart, TablesPart } from "../../session/parts";

export interface MarkDrawingHost {
  readonly view: ViewControl;
  readonly layers: LayersPart;
  readonly painting: PaintingPart;
  readonly tables: TablesPart;
  model(): Model | null;
  changed(): void;
}

/** The record and the column that receive the drawing. */
interface Target {
  model: Model;
  table: number;
  key: number;
  column: Column;
}

const kMostTries = 5; // for simultaneous changes to the record by other users
const words = texts.marks;

const metresOf = (lines: readonly MarkPlace[][], { unit }: Model): number =>
  lines.reduce((sum, coordinates) => sum + markLength({ coordinates }), 0) * metresPer(unit);

export class MarkDrawing {
  // ids of the chosen columns, by table and kind
  private readonly _chosen = new Map<string, number>();
  private _work: Promise<unknown> = Promise.resolve(); // drawings are saved one at a time
  private _notice = 0; // the notice that offers to undo the latest drawing
  private readonly _measure: LineMeasure<Step>; // the measured length of the current line

  constructor(
    private readonly _api: Api,
    private readonly _host: MarkDrawingHost,
  ) {
    this._measure = new LineMeasure({
      lookAlong: async (path) => this.sight(_host.model()!).along(path),
      metresAlong: (steps) =>
        lengthSeen(steps, this.sight(_host.model()!).measures) * metresPer(_host.model()!.unit),
      changed: () => _host.changed(),
    });
  }

  /** The length of the current line to the pointer, in meters; null if it is unknown. */
  get metresSoFar(): number | null {
    return this._measure.metres;
  }

  /** Returns the columns of the selected layer's table that can store such marks. */
  columns(kind: MarkKind): Column[] {
    const { table: id } = this._host.layers.selected ?? {};
    const table = id === undefined ? null : this._host.tables.find(id);
    return table ? markColumns(table, kind) : [];
  }
  /** Returns the column for new marks. */
  column(kind: MarkKind): Column | null {
    const columns = this.columns(kind);
    const chosen = this._chosen.get(`${this._host.layers.selected?.table} ${kind}`);
    return columns.find(({ id }) => id === chosen) ?? columns[0] ?? null;
  }
  chooseColumn(table: number, { id, kind }: Column): void {
    this._chosen.set(`${table} ${kind}`, id);
    this._host.changed();
  }

  /** Returns false if no record is selected, after showing the reason to the user. */
  beginLine(): boolean {
    if (!this.target("line")) return false;
    this._host.painting.stroking = true;
    return true;
  }

  /** Call this when the line becomes longer or shorter, or with null when it ends. */
  lineChanged(outline: Outline | null): void {
    this._measure.follow(outline);
  }

  /** Returns whether the line was saved. `seen` is the 3D view by default. */
  finishLine(path: readonly Point[], seen?: MarkSight): Promise<boolean> {
    const target = this.target("line");
    if (!target) return Promise.resolve(false);
    const sight = seen ?? this.sight(target.model);
    return this.queue(async () => {
      const steps = await sight.along(path);
      const lines = await lineOnSurface(steps, sight.measures, (from, to, step) =>
        this.nearestAlong(target.model, from, to, step),
      );
      const cut = lines.length > 1 ? words.line_cut(lines.length) : "";
      return this.add(
        target,
        lines,
        (name) => words.line_drawn(formatLength(metresOf(lines, target.model)), name),
        cut,
      );
    });
  }

  /** Returns whether the point was saved. */
  setPoint(at: Point, seen?: MarkSight): Promise<boolean> {
    const target = this.target("point");
    if (!target) return Promise.resolve(false);
    const sight = seen ?? this.sight(target.model);
    return this.queue(async () => {
      const place = await sight.at(at);
      return this.add(target, place ? [[place]] : [], words.point_set);
    });
  }

  async undo(): Promise<void> {
    const { table } = this._host.layers.selected ?? {};
    if (table !== undefined) await this._host.tables.undo(table);
  }
  async redo(): Promise<void> {
    const { table } = this._host.layers.selected ?? {};
    if (table !== undefined) await this._host.tables.redo(table);
  }

  private target(kind: MarkKind): Target | null {
    const { painting, tables } = this._host;
    const model = this._host.model();
    const layer = painting.chosenLayer();
    if (!model || !layer) return null;
    const column = this.column(kind);
    const key = painting.brush.valueFor(layer);
    const wrong =
      layer.table === undefined || !column
        ? words.no_column[kind]
        : tables.lacks(layer.table, key)
          ? texts.brush.no_record(key)
          : null;
    if (wrong) notices.show("problem", wrong);
    return wrong || layer.table === undefined || !column
      ? null
      : { model, table: layer.table, key, column };
  }

  private async nearestAlong(
    { id, unit }: Model,
    from: MarkPlace,
    to: MarkPlace,
    step: number,
  ): Promise<(MarkPlace | null)[]> {
    const { samples } = await this._api.json("POST /models/{model}/profile", {
      path: { model: `${id}` },
      body: {
        places: [from, to],
        step_mm: step * metresPer(unit) * 1000,
        layers: [],
      },
    });
    return samples.map(({ point }) => (point.hit && point.position ? point.position : null));
  }
  private sight(model: Model): MarkSight {
    const scale = Math.max(1, globalThis.devicePixelRatio || 1);
    return sightThrough({ api: this._api, model }, this._host.view.camera.message(), scale);
  }

  private queue(work: () => Promise<boolean>): Promise<boolean> {
    const saved = this._work.then(work).catch((error: unknown) => {
      notices.error(error);
      return false;
    });
    this._work = saved;
    return saved;
  }

  private async add(
    { model, table, key, column }: Target,
    places: MarkPlace[][],
    told: (name: string) => string,
    cut = "",
  ): Promise<boolean> {
    if (places.length === 0) {
      notices.show("info", words.missed);
      return false;
    }
    const marks = places.map((coordinates) => ({ model: model.id, coordinates }));
    const changed = await this.change(table, key, ({ version, values }) =>
      changeRecord(this._api, table, key, {
        version,
        values: { [column.slug]: [...marksOf(values[column.slug]), ...marks] },
      }),
    );
    const { tables } = this._host;
    if (tables.view?.tableId === table) tables.view.rows.put(changed);
    notices.dismiss(this._notice);
    const act = (): void => void this.queue(() => this.takeBack(table, changed.version));
    const what = told(tables.label(table, key) ?? texts.tables.record(key));
    const link = { label: texts.model.undo, act };
    this._notice = cut
      ? notices.show("problem", cut, what, link)
      : notices.show("success", what, "", link);
    return true;
  }

  /** Changes the current version of the record, which keeps the marks of other users. */
  private async change(
    table: number,
    key: number,
    change: (record: TableRecord) => Promise<TableRecord>,
  ): Promise<TableRecord> {
    for (let tries = 1; ; ++tries) {
      try {
        return await change(await readRecord(this._api, { table }, key));
      } catch (error) {
        if (!(error instanceof ApiError) || error.status !== 412 || tries === kMostTries)
          throw error;
      }
    }
  }

  /** Undoes only the change that the notice reports, and not a later one. */
  private async takeBack(table: number, version: number): Promise<boolean> {
    const {
      edits: [newest],
    } = await this._api.json("GET /tables/{table}/edits", { path: { table }, query: { limit: 1 } });
    if (newest?.sequence === version) await this._host.tables.undo(table);
    else notices.show("info", words.changed_since);
    return true;
  }
}
