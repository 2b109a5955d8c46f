// The activity of the open model or of its project: the loaded lines and their targets. The lines
// are loaded when the panel opens, and again after each change.

import { withFirstPage, withNextPage, type ActivityLog } from "../../domain/activity";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { nameInText } from "../../domain/completion";
import type { Activity } from "../../core/protocol.gen";
import { ReadAgain } from "../../net/read-again";
import type { Layer, Model } from "../../core/types";
import { notices } from "../../ui/notices";
import { navigate, pathOfModel } from "../../ui/routes";
import type { ViewControl } from "../../session/view-control";
import type { CommentsPart, LayersPart, TablesPart } from "../../session/parts";

const kAtOnce = 50;

export interface ActivitiesHost {
  readonly view: ViewControl;
  readonly layers: LayersPart;
  readonly tables: TablesPart;
  readonly comments: CommentsPart;
  model(): Model | null;
  /** The name of this user. */
  me(): string;
  changed(): void;
}

const kNone: ActivityLog = { lines: [], next: undefined };

export class Activities {
  loaded = false;
  failed = false;
  /** Whether earlier lines are being loaded. */
  busy = false;
  /** Whether another user has changed something since the panel was last open. */
  unseen = false;
  private _whole = false;
  private _watched = false;
  private _log = kNone;
  private readonly _again = new ReadAgain(() => void this.load());
  // The numbers of the latest requests. Responses to earlier requests are ignored. A new first page
  // must not cancel the request for earlier lines, because the user asked for these lines.
  private readonly _asked = { first: 0, next: 0 };

  constructor(
    private readonly _api: Api,
    private readonly _host: ActivitiesHost,
  ) {}

  get lines(): readonly Activity[] {
    return this._log.lines;
  }
  get hasMore(): boolean {
    return this._log.next !== undefined;
  }

  /** True shows the activity of the whole project; false shows only the activity of this model. */
  get whole(): boolean {
    return this._whole;
  }
  set whole(whole: boolean) {
    if (whole === this._whole) return;
    this._whole = whole;
    this._log = kNone;
    this.loaded = false;
    this.busy = false;
    ++this._asked.next;
    void this.load();
  }

  /** Call this when the panel opens or closes. */
  watch(watched: boolean): void {
    if (watched === this._watched) return;
    this._watched = watched;
    if (watched) {
      this.unseen = false;
      void this.load();
    } else this._again.stop();
  }

  /** Call this after the activity has changed. `user` is the author of the change, if known. */
  outdated(user?: string): void {
    if (this._watched) this._again.news();
    else if (user !== undefined && user !== this._host.me() && !this.unseen) {
      this.unseen = true;
      this._host.changed();
    }
  }

  close(): void {
    this._watched = false;
    this._again.stop();
  }

  load(): Promise<void> {
    return this.ask("first", undefined, (page) => (this._log = withFirstPage(this._log, page)));
  }
  async more(): Promise<void> {
    const before = this._log.next;
    if (this.busy || before === undefined) return;
    this.busy = true;
    let isReplaced = false;
    await this.ask("next", before, (page) => {
      isReplaced = this._log.next !== before; // the log has changed since the request
      if (!isReplaced) this._log = withNextPage(this._log, page);
      this.busy = false;
    });
    if (isReplaced) await this.more();
  }

  private async ask(
    which: "first" | "next",
    before: string | undefined,
    take: (page: ActivityLog) => void,
  ): Promise<void> {
    const model = this._host.model();
    if (!model) return;
    const question = ++this._asked[which];
    this._host.changed();
    try {
      const page = await this._api.json("GET /projects/{project}/activity", {
        path: { project: model.project },
        query: {
          limit: kAtOnce,
          before,
          model: this._whole ? undefined : `${model.id}`,
        },
      });
      if (question !== this._asked[which]) return;
      take({ lines: page.activity, next: page.next });
      this.loaded = true;
      this.failed = false;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (question !== this._asked[which]) return;
      this.failed = true;
      if (which === "next") this.busy = false;
    }
    this._host.changed();
  }

  // ── targets of lines ───────────────────────────────────────────────────────────────────────────

  leadsSomewhere(line: Activity): boolean {
    if (line.kind === "comment") return line.comment !== undefined;
    return line.layer !== undefined || this.layerOfTable(line) !== null || this.isElsewhere(line);
  }

  /** Opens the comment, record or layer of the line. Loads another model if necessary. */
  async goTo(line: Activity): Promise<void> {
    if (this.isElsewhere(line)) {
      navigate(
        pathOfModel(line.model!) + (line.comment === undefined ? "" : `#comment=${line.comment}`),
      );
      return;
    }
    if (line.comment !== undefined) {
      this._host.comments.goTo(line.comment);
      return;
    }
    const { layers, tables } = this._host;
    const layer = layers.find(line.layer ?? null) ?? this.layerOfTable(line);
    if (!layer) return;
    layers.select(layer);
    if (!layers.visible(layer)) layers.setVisible(layer, true);
    if (line.table !== undefined && line.record !== undefined) tables.showRow(layer, line.record);
    else if (line.table !== undefined) tables.open(layer);
    await this.flyTo(layer, line.record);
  }

  isElsewhere({ model }: Activity): boolean {
    return model !== undefined && model !== this._host.model()?.id;
  }

  private layerOfTable({ table }: Activity): Layer | null {
    return table === undefined
      ? null
      : (this._host.layers.all.find((layer) => layer.table === table) ?? null);
  }

  private async flyTo(layer: Layer, record: number | undefined): Promise<void> {
    const model = this._host.model();
    if (!model) return;
    const slug = nameInText(layer.slug);
    const where = record === undefined ? `valid(${slug})` : `${slug} = ${record}`;
    try {
      const { bounds } = await this._api.json("POST /models/{model}/select", {
        path: { model: model.id },
        body: { where },
      });
      if (bounds) this._host.view.flyTo(bounds);
    } catch (error) {
      notices.error(error);
    }
  }
}
