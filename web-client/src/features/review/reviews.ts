// The edits of the open model that wait for review, and the curators' decisions. They are loaded
// again shortly after a change to a layer.

import { labelOf } from "../../domain/cells";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { placeLike } from "../../math/fit-to-window";
import type { LayerEvent, Review, ReviewQueue, WaitingStroke } from "../../core/protocol.gen";
import { ReadAgain } from "../../net/read-again";
import type { Layer } from "../../core/types";
import { notices } from "../../ui/notices";
import { texts } from "../../texts";
import type { ViewControl } from "../../session/view-control";
import type { LayersPart } from "../../session/parts";

const words = texts.review;
const kAtOnce = 200; // number of listed strokes for each layer, with the oldest first

export interface ReviewsHost {
  readonly view: ViewControl;
  readonly layers: LayersPart;
  me(): string;
  /** Returns the display name of a user. */
  nameOf(user: string): string;
  canPaint(): boolean;
  canCurate(): boolean;
  changed(): void;
}

/** A layer with its queue of waiting edits. */
export interface Waiting {
  layer: Layer;
  queue: ReviewQueue;
}

export class Reviews {
  private readonly _failed = new Set<number>(); // layers whose queue could not be loaded
  // layers that had waiting or decided edits since the page opened
  private readonly _told = new Set<number>();
  private readonly _queues = new Map<number, ReviewQueue>(); // keyed by layer
  private readonly _outdated = new Set<number>();
  // the latest request by layer; responses to older requests are ignored
  private readonly _asked = new Map<number, number>();
  private readonly _again = new ReadAgain((last) => void this.load(last));

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _host: ReviewsHost,
  ) {}

  get failed(): boolean {
    return this._failed.size > 0;
  }
  /** Whether a layer requires review, or any edits still wait for review. */
  get isUsed(): boolean {
    return this._host.layers.all.some((layer) => layer.review) || this.count > 0;
  }
  /**
   * The layers with waiting edits. Curators see the edits of all authors, and others see their own.
   */
  get waiting(): Waiting[] {
    return this._host.layers.all.flatMap((layer) => {
      const queue = this._queues.get(layer.id);
      return queue && queue.total > 0 ? [{ layer, queue }] : [];
    });
  }
  /** The number of strokes on all layers. */
  get count(): number {
    return this.waiting.reduce((sum, { queue }) => sum + queue.total, 0);
  }
  waitingOn(layer: Layer): number {
    return this._queues.get(layer.id)?.total ?? 0;
  }

  welcome(): void {
    this._queues.clear();
    void this.loadAll();
  }

  onEvent({ layer_id: layerId, event, user, review, provisional }: LayerEvent): void {
    if (event === "deleted") this._queues.delete(layerId);
    else this.outdated(layerId);
    if (review || provisional) this._told.add(layerId);
    const me = this._host.me();
    const layer = this._host.layers.find(layerId);
    if (!review || !layer || user === undefined || user === me || !review.authors.includes(me))
      return;
    notices.show(
      review.decision === "reject" ? "problem" : "info",
      words.told[review.decision](this._host.nameOf(user), labelOf(layer)),
      review.reason ?? "",
    );
  }

  /** Call this after edits of this user were saved, on any layer. */
  saved(): void {
    for (const { id } of this._host.layers.all) this.outdated(id);
  }

  /** Call this after a change to the layer. */
  outdated(layer: number): void {
    this._outdated.add(layer);
    this._again.news();
  }

  close(): void {
    this._again.stop();
  }

  /** Curators also see layers that no longer require review but still have waiting edits. */
  async loadAll(): Promise<void> {
    if (!this._host.canPaint()) return;
    const layers = this._host.layers.all.filter((layer) => layer.review || this._host.canCurate());
    await Promise.all(layers.map((layer) => this.read(layer.id)));
  }

  private async load(last: boolean): Promise<void> {
    const layers = this._host.canPaint()
      ? [...this._outdated].filter(
          (id) => this._host.layers.find(id)?.review || this._told.has(id) || this.waitsOn(id),
        )
      : [];
    if (last) this._outdated.clear();
    await Promise.all(layers.map((id) => this.read(id)));
  }
  private waitsOn(layer: number): boolean {
    return (this._queues.get(layer)?.total ?? 0) > 0;
  }

  private async read(layer: number): Promise<void> {
    const question = (this._asked.get(layer) ?? 0) + 1;
    this._asked.set(layer, question);
    try {
      const whose = this._host.canCurate() ? null : this._host.me();
      const queue = await this._api.json("GET /models/{model}/layers/{layer}/review", {
        path: { model: this._modelId, layer },
        query: { limit: kAtOnce, user: whose ?? undefined },
      });
      if (this._asked.get(layer) !== question) return;
      this._queues.set(layer, queue);
      this._failed.delete(layer);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (this._asked.get(layer) !== question) return;
      this._failed.delete(layer);
      if (error.status === 404) this._queues.delete(layer);
      else this._failed.add(layer);
    }
    this._host.changed();
  }

  /** Shows the layer from the camera of the stroke's author. */
  goTo(layer: Layer, { camera }: WaitingStroke): void {
    const { layers, view } = this._host;
    layers.select(layer);
    if (!layers.visible(layer)) layers.setVisible(layer, true);
    if (camera) view.fly(placeLike(camera, view.camera));
  }

  /**
   * Returns true after success, and a notice offers to undo the decision for a short time. Returns
   * false otherwise, after showing the reason to the user.
   */
  async decide(layer: Layer, decision: Review): Promise<boolean> {
    const { strokes, total, people } = this._queues.get(layer.id) ?? {
      strokes: [],
      total: 0,
      people: [],
    };
    const isAbout = ({ sequence, user }: WaitingStroke): boolean =>
      decision.edits
        ? decision.edits.includes(sequence)
        : decision.user === undefined || decision.user === user;
    const edits = strokes.filter(isAbout).map(({ sequence }) => sequence);
    const count = decision.edits
      ? edits.length
      : decision.user === undefined
        ? total
        : (people.find(({ user }) => user === decision.user)?.strokes ?? 0);
    const done = await this.send(layer, decision);
    if (!done) return false;
    // a request can only name listed strokes
    const act = (): void => void this.send(layer, { decision: "reopen", edits });
    const takeBack = edits.length === count && count > 0 ? { label: words.take_back, act } : null;
    notices.show(
      "success",
      words.done[decision.decision as "accept" | "reject"](count),
      labelOf(layer),
      takeBack,
    );
    return true;
  }

  private async send(layer: Layer, decision: Review): Promise<boolean> {
    let done = true;
    try {
      await this._api.json("POST /models/{model}/layers/{layer}/review", {
        path: { model: this._modelId, layer: layer.id },
        body: decision,
      });
    } catch (error) {
      notices.error(error);
      done = false;
    }
    await this.read(layer.id); // also necessary if another user decided first
    return done;
  }
}
