// What of the open model's layers waits for review, and what curators decide about it. It is read
// anew soon after something changed on a layer.

import { label_of } from "../../domain/cells";
import { ApiError, type Api } from "../../net/api";
import { place_like } from "../../math/fit-to-window";
import type { LayerEvent, Review, ReviewQueue, WaitingStroke } from "../../core/protocol.gen";
import { ReadAgain } from "../../net/read-again";
import type { Layer } from "../../core/types";
import { notices } from "../../ui/notices";
import { texts } from "../../texts";
import type { ViewControl } from "../../session/view-control";
import type { LayersPart } from "../../session/parts";

const words = texts.review;
const kAtOnce = 200; // strokes of a layer that are listed; the oldest come first

export interface ReviewsHost {
  readonly view: ViewControl;
  readonly layers: LayersPart;
  me(): string;
  /** What somebody is called. */
  name_of(user: string): string;
  can_paint(): boolean;
  can_curate(): boolean;
  changed(): void;
}

/** Of a layer. */
export interface Waiting {
  layer: Layer;
  queue: ReviewQueue;
}

export class Reviews {
  private readonly failed_ = new Set<number>(); // layers of which it could not be read
  // layers on which something waited, or was decided, since the page is open
  private readonly told_ = new Set<number>();
  private readonly queues_ = new Map<number, ReviewQueue>(); // by layer
  private readonly outdated_ = new Set<number>();
  // the newest question by layer; answers of older ones come too late
  private readonly asked_ = new Map<number, number>();
  private readonly again_ = new ReadAgain((last) => void this.load(last));

  constructor(
    private readonly api_: Api,
    private readonly model_id_: string,
    private readonly host_: ReviewsHost,
  ) {}

  get failed(): boolean {
    return this.failed_.size > 0;
  }
  /** Some layer asks for review, or something still waits. */
  get is_used(): boolean {
    return this.host_.layers.all.some((layer) => layer.review) || this.count > 0;
  }
  /** Layers of which something waits: for curators of anybody, for others of their own. */
  get waiting(): Waiting[] {
    return this.host_.layers.all.flatMap((layer) => {
      const queue = this.queues_.get(layer.id);
      return queue && queue.total > 0 ? [{ layer, queue }] : [];
    });
  }
  /** Strokes, on all layers. */
  get count(): number {
    return this.waiting.reduce((sum, { queue }) => sum + queue.total, 0);
  }
  waiting_on(layer: Layer): number {
    return this.queues_.get(layer.id)?.total ?? 0;
  }

  welcome(): void {
    this.queues_.clear();
    void this.load_all();
  }

  on_event({ layer_id, event, user, review, provisional }: LayerEvent): void {
    if (event === "deleted") this.queues_.delete(layer_id);
    else this.outdated(layer_id);
    if (review || provisional) this.told_.add(layer_id);
    const me = this.host_.me();
    const layer = this.host_.layers.find(layer_id);
    if (!review || !layer || user === undefined || user === me || !review.authors.includes(me))
      return;
    notices.show(
      review.decision === "reject" ? "problem" : "info",
      words.told[review.decision](this.host_.name_of(user), label_of(layer)),
      review.reason ?? "",
    );
  }

  /** This person changed something, somewhere. */
  saved(): void {
    for (const { id } of this.host_.layers.all) this.outdated(id);
  }

  /** Something changed there. */
  outdated(layer: number): void {
    this.outdated_.add(layer);
    this.again_.news();
  }

  close(): void {
    this.again_.stop();
  }

  /**
   * What curators see holds layers, too, that ask for no review any more, of which something still
   * waits.
   */
  async load_all(): Promise<void> {
    if (!this.host_.can_paint()) return;
    const layers = this.host_.layers.all.filter((layer) => layer.review || this.host_.can_curate());
    await Promise.all(layers.map((layer) => this.read(layer.id)));
  }

  private async load(last: boolean): Promise<void> {
    const layers = this.host_.can_paint()
      ? [...this.outdated_].filter(
          (id) => this.host_.layers.find(id)?.review || this.told_.has(id) || this.waits_on(id),
        )
      : [];
    if (last) this.outdated_.clear();
    await Promise.all(layers.map((id) => this.read(id)));
  }
  private waits_on(layer: number): boolean {
    return (this.queues_.get(layer)?.total ?? 0) > 0;
  }

  private async read(layer: number): Promise<void> {
    const question = (this.asked_.get(layer) ?? 0) + 1;
    this.asked_.set(layer, question);
    try {
      const whose = this.host_.can_curate() ? null : this.host_.me();
      const queue = await this.api_.review_queue(this.model_id_, layer, kAtOnce, whose);
      if (this.asked_.get(layer) !== question) return;
      this.queues_.set(layer, queue);
      this.failed_.delete(layer);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (this.asked_.get(layer) !== question) return;
      this.failed_.delete(layer);
      if (error.status === 404) this.queues_.delete(layer);
      else this.failed_.add(layer);
    }
    this.host_.changed();
  }

  /** The layer, as its author saw it. */
  go_to(layer: Layer, { camera }: WaitingStroke): void {
    const { layers, view } = this.host_;
    layers.select(layer);
    if (!layers.visible(layer)) layers.set_visible(layer, true);
    if (camera) view.fly(place_like(camera, view.camera));
  }

  /**
   * True: it is decided, which the person can take back for a moment. Otherwise why not was told.
   */
  async decide(layer: Layer, decision: Review): Promise<boolean> {
    const { strokes, total, people } = this.queues_.get(layer.id) ?? {
      strokes: [],
      total: 0,
      people: [],
    };
    const is_about = ({ sequence, user }: WaitingStroke): boolean =>
      decision.edits
        ? decision.edits.includes(sequence)
        : decision.user === undefined || decision.user === user;
    const edits = strokes.filter(is_about).map(({ sequence }) => sequence);
    const count = decision.edits
      ? edits.length
      : decision.user === undefined
        ? total
        : (people.find(({ user }) => user === decision.user)?.strokes ?? 0);
    const done = await this.send(layer, decision);
    if (!done) return false;
    // What is not listed cannot be named.
    const act = (): void => void this.send(layer, { decision: "reopen", edits });
    const take_back = edits.length === count && count > 0 ? { label: words.take_back, act } : null;
    notices.show(
      "success",
      words.done[decision.decision as "accept" | "reject"](count),
      label_of(layer),
      take_back,
    );
    return true;
  }

  private async send(layer: Layer, decision: Review): Promise<boolean> {
    let done = true;
    try {
      await this.api_.review(this.model_id_, layer.id, decision);
    } catch (error) {
      notices.error(error);
      done = false;
    }
    await this.read(layer.id); // also where somebody else was quicker
    return done;
  }
}
