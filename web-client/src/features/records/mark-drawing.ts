// Lines and points that this person draws on the surface. They go to the record that the brush
// paints with, into the layer's table.

import { ApiError, type Api } from "../../net/api";
import type { CameraMessage } from "../../math/camera";
import type { Point } from "../../net/connection";
import type { PointerSample } from "../../ui/input";
import { mark_columns, mark_length, marks_of, type MarkKind } from "../../domain/marks";
import { format_length, metres_per } from "../../domain/measure";
import type { Column, MarkPlace, TableRecord } from "../../core/protocol.gen";
import {
  length_seen,
  line_on_surface,
  steps_along,
  type Measures,
  type Step,
} from "../../domain/surface-line";
import type { Model } from "../../core/types";
import type { Outline } from "../../tools/tool";
import { LineMeasure } from "../../session/line-measure";
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

/** What is drawn for. */
interface Target {
  model: Model;
  table: number;
  key: number;
  column: Column;
}

const kMostTries = 5; // where others change the record at the same time
const words = texts.marks;

const metres_of = (lines: readonly MarkPlace[][], { unit }: Model): number =>
  lines.reduce((sum, coordinates) => sum + mark_length({ coordinates }), 0) * metres_per(unit);

export class MarkDrawing {
  private readonly chosen_ = new Map<string, number>(); // ids of columns, by table and kind
  private work_: Promise<void> = Promise.resolve(); // one after the other
  private notice_ = 0; // that offers to take the newest back
  private readonly measure_: LineMeasure<Step>; // of the line that is being drawn

  constructor(
    private readonly api_: Api,
    private readonly host_: MarkDrawingHost,
  ) {
    this.measure_ = new LineMeasure({
      look_along: async (path) =>
        this.look_along(host_.model()!, host_.view.camera.message(), path),
      metres_along: (steps) =>
        length_seen(steps, this.measures()) * metres_per(host_.model()!.unit),
      changed: () => host_.changed(),
    });
  }

  /** Of what is being drawn, to the pointer; null where that is not known. */
  get metres_so_far(): number | null {
    return this.measure_.metres;
  }

  /** Of the layer that is painted on: where such marks can go. */
  columns(kind: MarkKind): Column[] {
    const { table: id } = this.host_.layers.selected ?? {};
    const table = id === undefined ? null : this.host_.tables.find(id);
    return table ? mark_columns(table, kind) : [];
  }
  /** Where they go. */
  column(kind: MarkKind): Column | null {
    const columns = this.columns(kind);
    const chosen = this.chosen_.get(`${this.host_.layers.selected?.table} ${kind}`);
    return columns.find(({ id }) => id === chosen) ?? columns[0] ?? null;
  }
  choose_column(table: number, { id, kind }: Column): void {
    this.chosen_.set(`${table} ${kind}`, id);
    this.host_.changed();
  }

  /** False: there is no record to draw for, and the person was told. */
  begin_line(): boolean {
    if (!this.target("line")) return false;
    this.host_.painting.stroking = true;
    return true;
  }

  /** More of it is drawn, or taken back; null: no longer. */
  line_changed(outline: Outline | null): void {
    this.measure_.follow(outline);
  }

  finish_line(path: Point[]): void {
    const target = this.target("line");
    if (!target) return;
    const seen_by = this.host_.view.camera.message();
    const measures = this.measures();
    this.queue(async () => {
      const steps = await this.look_along(target.model, seen_by, path);
      const lines = await line_on_surface(steps, measures, (from, to, step) =>
        this.nearest_along(target.model, from, to, step),
      );
      const cut = lines.length > 1 ? words.line_cut(lines.length) : "";
      await this.add(
        target,
        lines,
        (name) => words.line_drawn(format_length(metres_of(lines, target.model)), name),
        cut,
      );
    });
  }

  set_point({ x, y }: PointerSample): void {
    const target = this.target("point");
    if (!target) return;
    const seen_by = this.host_.view.camera.message();
    this.queue(async () => {
      const { hit, position } = await this.api_.pick(`${target.model.id}`, seen_by, [x, y]);
      await this.add(target, hit && position ? [[position]] : [], words.point_set);
    });
  }

  undo(): void {
    const { table } = this.host_.layers.selected ?? {};
    if (table !== undefined) void this.host_.tables.undo(table);
  }
  redo(): void {
    const { table } = this.host_.layers.selected ?? {};
    if (table !== undefined) void this.host_.tables.redo(table);
  }

  private target(kind: MarkKind): Target | null {
    const { painting, tables } = this.host_;
    const model = this.host_.model();
    const layer = painting.chosen_layer();
    if (!model || !layer) return null;
    const column = this.column(kind);
    const key = painting.brush.value_of(layer);
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

  private async look_along(
    { id }: Model,
    seen_by: CameraMessage,
    path: readonly Point[],
  ): Promise<Step[]> {
    const { samples } = await this.api_.profile(`${id}`, seen_by, path);
    return steps_along(path, samples);
  }
  private async nearest_along(
    { id, unit }: Model,
    from: MarkPlace,
    to: MarkPlace,
    step: number,
  ): Promise<(MarkPlace | null)[]> {
    const { samples } = await this.api_.profile_of(`${id}`, {
      places: [from, to],
      step_mm: step * metres_per(unit) * 1000,
      layers: [],
    });
    return samples.map(({ point }) => (point.hit && point.position ? point.position : null));
  }
  private measures(): Measures {
    return {
      pixel_at: this.host_.view.camera.pixel_size(),
      scale: Math.max(1, globalThis.devicePixelRatio || 1),
    };
  }

  private queue(work: () => Promise<void>): void {
    this.work_ = this.work_.then(work).catch((error: unknown) => notices.error(error));
  }

  private async add(
    { model, table, key, column }: Target,
    places: MarkPlace[][],
    told: (name: string) => string,
    cut = "",
  ): Promise<void> {
    if (places.length === 0) {
      notices.show("info", words.missed);
      return;
    }
    const marks = places.map((coordinates) => ({ model: model.id, coordinates }));
    const changed = await this.change(table, key, ({ version, values }) =>
      this.api_.change_record(table, key, {
        version,
        values: { [column.slug]: [...marks_of(values[column.slug]), ...marks] },
      }),
    );
    const { tables } = this.host_;
    if (tables.view?.table_id === table) tables.view.rows.put(changed);
    notices.dismiss(this.notice_);
    const act = (): void => this.queue(() => this.take_back(table, changed.version));
    const what = told(tables.label(table, key) ?? texts.tables.record(key));
    const link = { label: texts.model.undo, act };
    this.notice_ = cut
      ? notices.show("problem", cut, what, link)
      : notices.show("success", what, "", link);
  }

  /** Onto the record as it is: marks that others add meanwhile stay. */
  private async change(
    table: number,
    key: number,
    change: (record: TableRecord) => Promise<TableRecord>,
  ): Promise<TableRecord> {
    for (let tries = 1; ; ++tries) {
      try {
        return await change(await this.api_.record({ table }, key));
      } catch (error) {
        if (!(error instanceof ApiError) || error.status !== 412 || tries === kMostTries)
          throw error;
      }
    }
  }

  /** Only that change: what came after it is not what the notice spoke of. */
  private async take_back(table: number, version: number): Promise<void> {
    const [newest] = await this.api_.table_edits(table, 1);
    if (newest?.sequence === version) await this.host_.tables.undo(table);
    else notices.show("info", words.changed_since);
  }
}
