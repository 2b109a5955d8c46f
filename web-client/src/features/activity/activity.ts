// What was done on the open model, or in its whole project: what is known of it, and where its
// lines lead. It is read when somebody looks at it, and again after something happened here.

import { with_first_page, with_next_page, type ActivityLog } from "../../domain/activity";
import { ApiError, type Api } from "../../net/api";
import { name_in_text } from "../../domain/completion";
import type { Activity } from "../../core/protocol.gen";
import { ReadAgain } from "../../net/read-again";
import type { Layer, Model } from "../../core/types";
import { notices } from "../../ui/notices";
import { navigate, path_of_model } from "../../ui/routes";
import type { ViewControl } from "../../session/view-control";
import type { CommentsPart, LayersPart, TablesPart } from "../../session/parts";

const kAtOnce = 50;

export interface ActivitiesHost {
  readonly view: ViewControl;
  readonly layers: LayersPart;
  readonly tables: TablesPart;
  readonly comments: CommentsPart;
  model(): Model | null;
  changed(): void;
}

const kNone: ActivityLog = { lines: [], next: undefined };

export class Activities {
  loaded = false;
  failed = false;
  busy = false;
  private whole_ = false;
  private watched_ = false;
  private log_ = kNone;
  private readonly again_ = new ReadAgain(() => void this.load());
  private asked_ = 0; // the newest question; answers of older ones come too late

  constructor(
    private readonly api_: Api,
    private readonly host_: ActivitiesHost,
  ) {}

  get lines(): readonly Activity[] {
    return this.log_.lines;
  }
  get has_more(): boolean {
    return this.log_.next !== undefined;
  }

  /** Of the whole project, instead of this model. */
  get whole(): boolean {
    return this.whole_;
  }
  set whole(whole: boolean) {
    if (whole === this.whole_) return;
    this.whole_ = whole;
    this.log_ = kNone;
    this.loaded = false;
    void this.load();
  }

  /** Somebody looks at it. */
  watch(watched: boolean): void {
    if (watched === this.watched_) return;
    this.watched_ = watched;
    if (watched) void this.load();
    else this.again_.stop();
  }

  /** Something happened. */
  outdated(): void {
    if (this.watched_) this.again_.news();
  }

  close(): void {
    this.watched_ = false;
    this.again_.stop();
  }

  load(): Promise<void> {
    return this.ask(undefined, (page) => (this.log_ = with_first_page(this.log_, page)));
  }
  more(): Promise<void> {
    return this.ask(this.log_.next, (page) => (this.log_ = with_next_page(this.log_, page)));
  }

  private async ask(before: string | undefined, take: (page: ActivityLog) => void): Promise<void> {
    const model = this.host_.model();
    if (!model) return;
    const question = ++this.asked_;
    this.busy = true;
    this.host_.changed();
    try {
      const page = await this.api_.activity(model.project, {
        limit: kAtOnce,
        before,
        model: this.whole_ ? undefined : model.id,
      });
      if (question !== this.asked_) return;
      take({ lines: page.activity, next: page.next });
      this.loaded = true;
      this.failed = false;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (question !== this.asked_) return;
      this.failed = true;
    }
    this.busy = false;
    this.host_.changed();
  }

  // ── where a line leads
  // ────────────────────────────────────────────────────────────────────────────────────────────

  leads_somewhere(line: Activity): boolean {
    if (line.kind === "comment") return line.comment !== undefined;
    return (
      line.layer !== undefined || this.layer_of_table(line) !== null || this.is_elsewhere(line)
    );
  }

  /** To the comment, record or layer; to another model where it is on that. */
  async go_to(line: Activity): Promise<void> {
    if (this.is_elsewhere(line)) {
      navigate(
        path_of_model(line.model!) + (line.comment === undefined ? "" : `#comment=${line.comment}`),
      );
      return;
    }
    if (line.comment !== undefined) {
      this.host_.comments.go_to(line.comment);
      return;
    }
    const { layers, tables } = this.host_;
    const layer = layers.find(line.layer ?? null) ?? this.layer_of_table(line);
    if (!layer) return;
    layers.select(layer);
    if (!layers.visible(layer)) layers.set_visible(layer, true);
    if (line.table !== undefined && line.record !== undefined) tables.show_row(layer, line.record);
    else if (line.table !== undefined) tables.open(layer);
    await this.fly_to(layer, line.record);
  }

  private is_elsewhere({ model }: Activity): boolean {
    return model !== undefined && model !== this.host_.model()?.id;
  }

  private layer_of_table({ table }: Activity): Layer | null {
    return table === undefined
      ? null
      : (this.host_.layers.all.find((layer) => layer.table === table) ?? null);
  }

  private async fly_to(layer: Layer, record: number | undefined): Promise<void> {
    const model = this.host_.model();
    if (!model) return;
    const slug = name_in_text(layer.slug);
    const where = record === undefined ? `valid(${slug})` : `${slug} = ${record}`;
    try {
      const { bounds } = await this.api_.select(model.id, where);
      if (bounds) this.host_.view.fly_to(bounds);
    } catch (error) {
      notices.error(error);
    }
  }
}
