// What happens on one kiosk: its tour, the stop that is seen, the language, what is told of a
// record, and whether somebody is there. Elements subscribe and draw themselves from its state;
// they change it only through its methods.

import { type Api, ApiError } from "../net/api";
import type { SocketLike } from "../net/connection";
import type { KioskSelf, Picked, Tour, View } from "../core/protocol.gen";
import { AttractLoop } from "./attract";
import { card_of, type Card } from "./cards";
import { IdleWatch } from "./idle";
import { words_in } from "./languages";
import { KioskLink } from "./link";
import { layer_there, words_of_place, type TappedPlace } from "./place";
import { KioskShow } from "./show";
import {
  choices_of,
  first_choice,
  layers_shown,
  seen_layers,
  step_from,
  stops_of,
  type LayerChoice,
  type Stop,
} from "./stops";
import type { KioskStore } from "./store";
import { texts_in, type KioskTexts } from "./texts";

export interface NamedRecord {
  table: string;
  key: number;
  name: string;
}

export interface SessionOptions {
  api: Api;
  secret: string;
  store: Pick<KioskStore, "last_told" | "keep" | "forget">;
  reload: () => void;
  make_socket?: (url: string, protocol: string) => SocketLike;
}

export class KioskSession {
  self: KioskSelf | null = null;
  /** The link leads nowhere any more. */
  worthless = false;
  stops: Stop[] = [];
  /** The views were read, so that `stops` is what there is. */
  ready = false;
  index = 0;
  language = "en";
  choices: LayerChoice[] = [];
  choice: LayerChoice = null;
  /** Of the stop's records, under their names. */
  named: NamedRecord[] = [];
  card: Card | null = null;
  enlarged: Card["pictures"][number] | null = null;
  /** Where somebody tapped, while it is where they tapped. */
  private place_: TappedPlace | null = null;
  show: KioskShow | null = null;

  readonly idle: IdleWatch;
  private readonly attract_: AttractLoop;
  private readonly link_: KioskLink;
  private readonly listeners_ = new Set<() => void>();
  private views_ = new Map<string, View>(); // by slug
  private reading_ = 0; // the newest reading of views or records wins
  private naming_ = 0;
  private asked_card_ = 0;

  constructor(private readonly options_: SessionOptions) {
    const changed = (): void => this.changed();
    this.idle = new IdleWatch({
      idle_s: () => this.self?.tour.idle_s ?? 60,
      came: () => this.begin(),
      left: () => this.rest(),
      changed,
    });
    this.attract_ = new AttractLoop({
      times: () => this.stop?.stop ?? null,
      next: () => this.go_to(step_from(this.index, 1, Math.max(1, this.stops.length))),
    });
    this.link_ = new KioskLink(options_.api, options_.secret, {
      told: (self) => void this.on_told(self),
      missed: () => void this.on_missed(),
      worthless: () => void this.on_worthless(),
      reload: options_.reload,
    });
  }

  subscribe(listener: () => void): () => void {
    this.listeners_.add(listener);
    return () => this.listeners_.delete(listener);
  }

  open(): void {
    this.link_.ask();
  }
  close(): void {
    this.link_.stop();
    this.idle.stop();
    this.attract_.stop();
    this.show?.close();
    this.listeners_.clear();
  }
  /** The network or the page is back. */
  look_again(): void {
    this.link_.ask();
    this.show?.check_connection();
  }

  // ── what is seen
  // ──────────────────────────────────────────────────────────────────────────────────────────────────

  get tour(): Tour | null {
    return this.self?.tour ?? null;
  }
  get stop(): Stop | null {
    return this.stops[this.index] ?? null;
  }
  get languages(): readonly string[] {
    return this.tour?.languages ?? [];
  }
  get words(): KioskTexts {
    return texts_in(this.language, this.languages);
  }
  get title(): string {
    return words_in(this.stop?.stop.title, this.language, this.languages);
  }
  get text(): string {
    return words_in(this.stop?.stop.text, this.language, this.languages);
  }
  /**
   * What the place that was tapped is called, and where it is on the stage; null: there is nothing
   * to tell of any.
   */
  get place(): { title: string; about: string; x: number; y: number } | null {
    const { place_: place, show } = this;
    const layer = place && show?.layers.find(({ id }) => id === place.layer);
    return layer
      ? { ...words_of_place(layer, place.value, this.language), x: place.x, y: place.y }
      : null;
  }
  /** Nobody is there; the tour plays by itself. */
  get resting(): boolean {
    return this.idle.presence.is === "alone";
  }

  // ── what visitors do
  // ──────────────────────────────────────────────────────────────────────────────────────────────

  touched(): void {
    if (!this.worthless && this.ready) this.idle.touched();
  }
  step(by: 1 | -1): void {
    const to = this.index + by;
    if (this.stops[to]) this.go_to(to);
  }
  choose_language(language: string): void {
    if (!this.languages.includes(language) || language === this.language) return;
    this.language = language;
    void this.name_records();
    if (this.card) void this.open_card(this.card.table, this.card.key);
    this.changed();
  }
  choose_layer(choice: LayerChoice): void {
    if (!this.stop || !this.choices.includes(choice)) return;
    this.choice = choice;
    this.close_card();
    this.show?.show_layers(this.overrides());
    this.changed();
  }
  /** To the next of the layers; after the last one comes none. Not beneath a card. */
  swipe(by: 1 | -1): void {
    if (this.card) return;
    const next = this.choices[this.choices.indexOf(this.choice) + by];
    if (next !== undefined && this.show && !this.show.away) this.choose_layer(next);
  }
  async open_card(table: string, key: number): Promise<void> {
    const { stop } = this;
    const asked = ++this.asked_card_;
    if (!stop) return;
    try {
      const card = await card_of(this.options_.api, {
        table,
        key,
        stop: stop.stop,
        language: this.language,
        languages: this.languages,
      });
      if (asked !== this.asked_card_ || this.resting) return;
      this.card = card;
      this.changed();
    } catch (error) {
      // the server is away, and the record was never looked at: nothing opens
      if (!(error instanceof ApiError)) throw error;
    }
  }
  close_card(): void {
    this.asked_card_ += 1;
    this.card = this.enlarged = null;
    this.place_ = null;
    this.changed();
  }
  private forget_place(): void {
    if (!this.place_) return;
    this.place_ = null;
    this.changed();
  }
  enlarge(picture: Card["pictures"][number] | null): void {
    this.enlarged = picture;
    this.changed();
  }

  // ── the tour
  // ──────────────────────────────────────────────────────────────────────────────────────────────────────

  private begin(): void {
    this.attract_.stop();
    this.go_to(0);
  }

  /** As a visitor finds it: the first stop in the first language; then it plays by itself. */
  private rest(): void {
    this.language = this.languages[0] ?? "en";
    this.go_to(0);
    this.attract_.start();
  }

  private go_to(index: number): void {
    this.index = index;
    this.close_card();
    const { stop, show } = this;
    if (!stop) return;
    this.choices = choices_of(stop, show?.layers ?? []);
    this.choice = first_choice(stop, this.choices);
    const flight_s = stop.stop.transition === "cut" ? 0 : stop.stop.transition_s;
    show?.go_to(stop.view, this.overrides(), flight_s);
    void this.name_records();
    this.changed();
  }

  private overrides(): ReturnType<typeof layers_shown> {
    const { stop, show } = this;
    return stop && show ? layers_shown(stop, show.layers, this.choices, this.choice) : [];
  }

  /** Of the stop, by what they are called; those that there are no more are left out. */
  private async name_records(): Promise<void> {
    const naming = ++this.naming_;
    const { stop, language, languages } = this;
    const wanted =
      stop?.stop.records.flatMap(({ table, keys }) => keys.map((key) => ({ table, key }))) ?? [];
    if (wanted.length === 0 || this.resting) this.named = []; // which nobody reads then
    if (!stop || wanted.length === 0 || this.resting) return;
    const cards = await Promise.all(
      wanted.map((each) =>
        card_of(this.options_.api, { ...each, stop: stop.stop, language, languages }).catch(
          () => null,
        ),
      ),
    );
    if (naming !== this.naming_) return;
    this.named = cards.flatMap((card) =>
      card ? [{ table: card.table, key: card.key, name: card.title }] : [],
    );
    this.changed();
  }

  /** Of a record its card, of a class or a number what it is, beside the place. */
  private on_tapped(picked: Picked, { x, y }: { x: number; y: number }): void {
    const { show } = this;
    if (!show || this.resting) return;
    const found = layer_there(seen_layers(show.layers, this.overrides()), picked);
    this.close_card();
    if (found?.layer.table !== undefined)
      void this.open_card(String(found.layer.table), found.value);
    else if (found) {
      this.place_ = { x, y, layer: found.layer.id, value: found.value };
      this.changed();
    }
  }

  // ── the server
  // ────────────────────────────────────────────────────────────────────────────────────────────────────

  private async on_told(self: KioskSelf): Promise<void> {
    const before = this.self;
    this.self = self;
    if (!before || before.tour.version !== self.tour.version || before.tour.id !== self.tour.id)
      await this.take_tour();
    else if (this.show?.drawn) this.keep(); // what is seen comes first
    if (!this.ready) await this.read_views();
    this.changed();
  }

  /** Away at the start: goes on with what was told last. */
  private async on_missed(): Promise<void> {
    if (this.self && !this.ready) await this.read_views();
    if (this.self) return;
    const self = await this.options_.store.last_told();
    if (!self || this.self || this.worthless) return;
    this.self = self;
    await this.take_tour();
  }

  private async on_worthless(): Promise<void> {
    if (this.worthless) return;
    this.worthless = true;
    this.idle.stop();
    this.attract_.stop();
    this.show?.close();
    this.show = null;
    this.changed();
    await this.options_.store.forget();
  }

  private async take_tour(): Promise<void> {
    const { self } = this;
    if (!self) return;
    if (!this.languages.includes(this.language) || this.resting)
      this.language = this.languages[0] ?? "en";
    if (this.show?.model_ref !== self.model) {
      this.show?.close();
      this.show = this.make_show(self.model);
      this.show.open();
    }
    await this.read_views();
  }

  private make_show(model: string): KioskShow {
    return new KioskShow(
      model,
      {
        learned: (what) => (what === "views" ? void this.read_views() : this.show_again()),
        tapped: (picked, at) => this.on_tapped(picked, at),
        moved: () => this.forget_place(),
        changed: () => this.changed(),
        lost: () => this.link_.ask(), // which knows why
      },
      this.options_.make_socket,
    );
  }

  private async read_views(): Promise<void> {
    const { self } = this;
    if (!self) return;
    const reading = ++this.reading_;
    const slugs = [...new Set(self.tour.stops.flatMap(({ view }) => view ?? []))];
    const views = await Promise.all(slugs.map((slug) => this.read_view(self.model, slug)));
    if (reading !== this.reading_ || this.worthless) return;
    if (!this.ready && views.includes(undefined)) return; // asked again when the server is
    this.views_ = new Map(
      slugs.flatMap((slug, place): [string, View][] =>
        [views[place] ?? []].flat().map((view) => [slug, view]),
      ),
    );
    const was_ready = this.ready;
    this.stops = stops_of(self.tour, this.views_);
    this.ready = true;
    this.index = Math.min(this.index, Math.max(0, this.stops.length - 1));
    if (!was_ready) this.rest();
    else this.show_again();
  }

  /** Null: it is gone. Where the server is away, as it was known, or undefined. */
  private async read_view(model: string, slug: string): Promise<View | null | undefined> {
    try {
      return await this.options_.api.view(model, slug);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      return error.status === 404 ? null : this.views_.get(slug);
    }
  }

  /** The same stop, with what is known of the model or the tour now. */
  private show_again(): void {
    const { stop, show, choice } = this;
    if (!stop || !show) return void this.changed();
    this.choices = choices_of(stop, show.layers);
    this.choice =
      this.choices.find((each) => each?.id === choice?.id) ?? first_choice(stop, this.choices);
    show.go_on(stop.view, this.overrides());
    void this.name_records();
    this.changed();
  }

  private keep(): void {
    const { self } = this;
    if (!self) return;
    const state = JSON.stringify([
      self.id,
      self.tour.id,
      self.tour.version,
      [...this.views_.values()].map(({ id, version }) => [id, version]),
    ]);
    void this.options_.store.keep(self, state);
  }

  private changed(): void {
    for (const listener of this.listeners_) listener();
  }
}
