// The state of a kiosk: its tour, the current stop and language, the open card, and the presence of
// a visitor. Elements subscribe to the state and render it. They change it only through the
// session's methods.

import type { Api } from "../net/api";
import { ApiError } from "../net/api-error";
import type { SocketLike } from "../net/socket";
import type { KioskSelf, Picked, Tour, TourClassName, View } from "../core/protocol.gen";
import { roomOf } from "../domain/tour-theme";
import { AttractLoop } from "./attract";
import { cardOf, type Card } from "./cards";
import { IdleWatch } from "./idle";
import { wordsIn } from "./languages";
import { KioskLink } from "./link";
import { mediaOf, type ShownMedium } from "./media";
import type { PhonePlace } from "./phone";
import { layerThere, wordsOfPlace, type TappedPlace } from "./place";
import { KioskShow } from "./show";
import {
  choicesOf,
  firstChoice,
  layersShown,
  seenLayers,
  stepFrom,
  stopsOf,
  type LayerChoice,
  type Stop,
} from "./stops";
import type { KioskStore } from "./store";
import { textsIn, type KioskTexts } from "./texts";

export interface NamedRecord {
  table: string;
  key: number;
  name: string;
}

export interface SessionOptions {
  api: Api;
  secret: string;
  store: Pick<KioskStore, "lastTold" | "keep" | "forget">;
  reload: () => void;
  makeSocket?: (url: string, protocol: string) => SocketLike;
  /** The initial position on a visitor's phone, which is the position of the screen. */
  phone?: PhonePlace | null;
}

export class KioskSession {
  self: KioskSelf | null = null;
  /** Whether the link is invalid. */
  worthless = false;
  stops: Stop[] = [];
  /** Whether the views are loaded and `stops` is complete. */
  ready = false;
  index = 0;
  language = "en";
  choices: LayerChoice[] = [];
  choice: LayerChoice = null;
  /** The records of the stop with their names. */
  named: NamedRecord[] = [];
  card: Card | null = null;
  enlarged: Card["pictures"][number] | null = null;
  /** The id of the stop's open medium. */
  private _medium: number | null = null;
  /** The tapped point, until the camera moves. */
  private _place: TappedPlace | null = null;
  show: KioskShow | null = null;

  readonly idle: IdleWatch;
  private readonly _attract: AttractLoop;
  private readonly _link: KioskLink;
  private readonly _listeners = new Set<() => void>();
  private _views = new Map<string, View>(); // views by slug
  private _reading = 0; // only the results of the latest read of views or records are used
  private _naming = 0;
  private _askedCard = 0;

  constructor(private readonly _options: SessionOptions) {
    const changed = (): void => this.changed();
    this.idle = new IdleWatch({
      idleS: () => this.self?.tour.idle_s ?? 60,
      came: () => this.begin(),
      left: () => this.rest(),
      changed,
    });
    this._attract = new AttractLoop({
      times: () => this.stop?.stop ?? null,
      next: () => this.goTo(stepFrom(this.index, 1, Math.max(1, this.stops.length))),
    });
    this._link = new KioskLink(_options.api, _options.secret, {
      told: (self) => void this.onTold(self),
      missed: () => void this.onMissed(),
      worthless: () => void this.onWorthless(),
      reload: _options.reload,
    });
  }

  subscribe(listener: () => void): () => void {
    this._listeners.add(listener);
    return () => this._listeners.delete(listener);
  }

  open(): void {
    this._link.ask();
  }
  close(): void {
    this._link.stop();
    this.idle.stop();
    this._attract.stop();
    this.show?.close();
    this._listeners.clear();
  }
  /** Call this when the network is available again, or the page is visible again. */
  lookAgain(): void {
    this._link.ask();
    this.show?.checkConnection();
  }

  // ── state ──────────────────────────────────────────────────────────────────────────────────────

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
    return textsIn(this.language, this.languages);
  }
  get title(): string {
    return wordsIn(this.stop?.stop.title, this.language, this.languages);
  }
  get text(): string {
    return wordsIn(this.stop?.stop.text, this.language, this.languages);
  }
  /** The images, sounds and videos of the stop. */
  get media(): ShownMedium[] {
    return this.self && this.stop ? mediaOf(this.self, this.stop.stop, this.language) : [];
  }
  /** The medium that covers the screen. */
  get medium(): ShownMedium | null {
    return this._medium === null
      ? null
      : (this.media.find(({ id }) => id === this._medium) ?? null);
  }
  /** The name of the tapped point and its position on the stage, or null. */
  get place(): { title: string; about: string; x: number; y: number } | null {
    const { _place: place, show } = this;
    const layer = place && show?.layers.find(({ id }) => id === place.layer);
    return layer
      ? {
          ...wordsOfPlace(layer, place.value, this.language, this.classNames(layer.slug)),
          x: place.x,
          y: place.y,
        }
      : null;
  }
  private classNames(layer: string): readonly TourClassName[] {
    return this.tour?.classes?.find((each) => each.layer === layer)?.classes ?? [];
  }
  /** Whether no visitor is present and the tour plays automatically. */
  get resting(): boolean {
    return this.idle.presence.is === "alone";
  }

  // ── actions of visitors ────────────────────────────────────────────────────────────────────────

  touched(): void {
    if (!this.worthless && this.ready) this.idle.touched();
  }
  step(by: 1 | -1): void {
    const to = this.index + by;
    if (this.stops[to]) this.goTo(to);
  }
  chooseLanguage(language: string): void {
    if (!this.languages.includes(language) || language === this.language) return;
    this.language = language;
    void this.nameRecords();
    if (this.card) void this.openCard(this.card.table, this.card.key);
    this.changed();
  }
  chooseLayer(choice: LayerChoice): void {
    if (!this.stop || !this.choices.includes(choice)) return;
    this.choice = choice;
    this.closeCard();
    this.show?.showLayers(this.overrides());
    this.changed();
  }
  /** Shows the next layer, if there is one. Has no effect while a card is open. */
  swipe(by: 1 | -1): void {
    if (this.card) return;
    const next = this.choices[this.choices.indexOf(this.choice) + by];
    if (next !== undefined && this.show && !this.show.away) this.chooseLayer(next);
  }
  async openCard(table: string, key: number): Promise<void> {
    const { stop } = this;
    const asked = ++this._askedCard;
    if (!stop) return;
    try {
      const card = await cardOf(this._options.api, {
        table,
        key,
        stop: stop.stop,
        language: this.language,
        languages: this.languages,
      });
      if (asked !== this._askedCard || this.resting) return;
      this.card = card;
      this.changed();
    } catch (error) {
      // If the server is unreachable and the record is not stored, no card opens.
      if (!(error instanceof ApiError)) throw error;
    }
  }
  closeCard(): void {
    this._askedCard += 1;
    this.card = this.enlarged = null;
    this._place = null;
    this._medium = null;
    this.changed();
  }
  showMedium(medium: ShownMedium | null): void {
    this._medium = medium?.id ?? null;
    this.changed();
  }
  private forgetPlace(): void {
    if (!this._place) return;
    this._place = null;
    this.changed();
  }
  enlarge(picture: Card["pictures"][number] | null): void {
    this.enlarged = picture;
    this.changed();
  }

  // ── the tour ───────────────────────────────────────────────────────────────────────────────────

  private begin(): void {
    this._attract.stop();
    this.goTo(0);
  }

  private beginAt({ stop, language }: PhonePlace): void {
    this.language = this.languages.includes(language) ? language : (this.languages[0] ?? "en");
    this.idle.touched(); // starts at the first stop
    this.goTo(Math.min(stop, Math.max(0, this.stops.length - 1)));
  }

  /**
   * Restores the initial state: the first stop in the first language. The tour then plays
   * automatically.
   */
  private rest(): void {
    this.language = this.languages[0] ?? "en";
    this.goTo(0);
    this._attract.start();
  }

  private goTo(index: number): void {
    this.index = index;
    this.closeCard();
    const { stop, show } = this;
    if (!stop) return;
    this.choices = choicesOf(stop, show?.layers ?? []);
    this.choice = firstChoice(stop, this.choices);
    const flightS = stop.stop.transition === "cut" ? 0 : stop.stop.transition_s;
    show?.goTo(stop.view, this.overrides(), flightS);
    void this.nameRecords();
    this.changed();
  }

  private overrides(): ReturnType<typeof layersShown> {
    const { stop, show } = this;
    return stop && show ? layersShown(stop, show.layers, this.choices, this.choice) : [];
  }

  /** Loads the names of the stop's records. Deleted records are omitted. */
  private async nameRecords(): Promise<void> {
    const naming = ++this._naming;
    const { stop, language, languages } = this;
    const wanted =
      stop?.stop.records.flatMap(({ table, keys }) => keys.map((key) => ({ table, key }))) ?? [];
    if (wanted.length === 0 || this.resting) this.named = []; // their names are not visible now
    if (!stop || wanted.length === 0 || this.resting) return;
    const cards = await Promise.all(
      wanted.map((each) =>
        cardOf(this._options.api, { ...each, stop: stop.stop, language, languages }).catch(
          () => null,
        ),
      ),
    );
    if (naming !== this._naming) return;
    this.named = cards.flatMap((card) =>
      card ? [{ table: card.table, key: card.key, name: card.title }] : [],
    );
    this.changed();
  }

  /** Opens the card of a record. For a class or a number, shows its name at the tapped point. */
  private onTapped(picked: Picked, { x, y }: { x: number; y: number }): void {
    const { show } = this;
    if (!show || this.resting) return;
    const found = layerThere(seenLayers(show.layers, this.overrides()), picked);
    this.closeCard();
    if (found?.layer.table !== undefined)
      void this.openCard(String(found.layer.table), found.value);
    else if (found) {
      this._place = { x, y, layer: found.layer.id, value: found.value };
      this.changed();
    }
  }

  // ── the server ─────────────────────────────────────────────────────────────────────────────────

  private async onTold(self: KioskSelf): Promise<void> {
    const before = this.self;
    this.self = self;
    if (!before || before.tour.version !== self.tour.version || before.tour.id !== self.tour.id)
      await this.takeTour();
    else if (this.show?.drawn) this.keep(); // the first frame has priority
    if (!this.ready) await this.readViews();
    this.changed();
  }

  /** If the server is unreachable at the start, continues with the last stored response. */
  private async onMissed(): Promise<void> {
    if (this.self && !this.ready) await this.readViews();
    if (this.self) return;
    const self = await this._options.store.lastTold();
    if (!self || this.self || this.worthless) return;
    this.self = self;
    await this.takeTour();
  }

  private async onWorthless(): Promise<void> {
    if (this.worthless) return;
    this.worthless = true;
    this.idle.stop();
    this._attract.stop();
    this.show?.close();
    this.show = null;
    this.changed();
    await this._options.store.forget();
  }

  private async takeTour(): Promise<void> {
    const { self } = this;
    if (!self) return;
    if (!this.languages.includes(this.language) || this.resting)
      this.language = this.languages[0] ?? "en";
    if (this.show?.modelRef !== self.model) {
      this.show?.close();
      this.show = this.makeShow(self.model);
      this.show.open();
    }
    this.show.setRoom(roomOf(self.tour.theme));
    await this.readViews();
  }

  private makeShow(model: string): KioskShow {
    return new KioskShow(
      model,
      {
        learned: (what) => (what === "views" ? void this.readViews() : this.showAgain()),
        tapped: (picked, at) => this.onTapped(picked, at),
        moved: () => this.forgetPlace(),
        changed: () => this.changed(),
        lost: () => this._link.ask(), // determines the reason
      },
      this._options.makeSocket,
    );
  }

  private async readViews(): Promise<void> {
    const { self } = this;
    if (!self) return;
    const reading = ++this._reading;
    const slugs = [...new Set(self.tour.stops.flatMap(({ view }) => view ?? []))];
    const views = await Promise.all(slugs.map((slug) => this.readView(self.model, slug)));
    if (reading !== this._reading || this.worthless) return;
    if (!this.ready && views.includes(undefined)) return; // retried when the server is reachable
    this._views = new Map(
      slugs.flatMap((slug, place): [string, View][] =>
        [views[place] ?? []].flat().map((view) => [slug, view]),
      ),
    );
    const wasReady = this.ready;
    this.stops = stopsOf(self.tour, this._views);
    this.ready = true;
    this.index = Math.min(this.index, Math.max(0, this.stops.length - 1));
    const { phone } = this._options;
    if (!wasReady && phone) this.beginAt(phone);
    else if (!wasReady) this.rest();
    else this.showAgain();
  }

  /**
   * Returns null if the view was deleted. If the server is unreachable, returns the known view or
   * undefined.
   */
  private async readView(model: string, slug: string): Promise<View | null | undefined> {
    try {
      return await this._options.api.json("GET /models/{model}/views/{view}", {
        path: { model, view: slug },
      });
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      return error.status === 404 ? null : this._views.get(slug);
    }
  }

  /** Shows the current stop again, with the newest version of the model and the tour. */
  private showAgain(): void {
    const { stop, show, choice } = this;
    if (!stop || !show) return void this.changed();
    this.choices = choicesOf(stop, show.layers);
    this.choice =
      this.choices.find((each) => each?.id === choice?.id) ?? firstChoice(stop, this.choices);
    show.goOn(stop.view, this.overrides());
    void this.nameRecords();
    this.changed();
  }

  private keep(): void {
    const { self } = this;
    if (!self) return;
    const state = JSON.stringify([
      self.id,
      self.tour.id,
      self.tour.version,
      [...this._views.values()].map(({ id, version }) => [id, version]),
    ]);
    void this._options.store.keep(self, state);
  }

  private changed(): void {
    for (const listener of this._listeners) listener();
  }
}
