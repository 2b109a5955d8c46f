// The saved views of the open model: lists them, applies them, and restores the previous state.

import { ApiError } from "../../net/api-error";
import { type Api, ifVersion } from "../../net/api";
import { placeLike } from "../../math/fit-to-window";
import type { View, ViewEvent } from "../../core/protocol.gen";
import type { ViewContent } from "../../domain/views";
import { FollowedItems } from "../../net/followed-items";
import { notices } from "../../ui/notices";
import { hashOfView, pathOfModel } from "../../ui/routes";
import { texts } from "../../texts";
import type { ViewControl } from "../../session/view-control";
import type { AppearancePart, LayersPart, TablesPart } from "../../session/parts";

const words = texts.kept_views;
const kMostSaid = 300; // number of characters of a view's text in a notice

export interface ViewsHost {
  readonly view: ViewControl;
  readonly layers: LayersPart;
  readonly appearance: AppearancePart;
  readonly tables: TablesPart;
  /** Runs the action immediately, or after the current stroke. */
  whenFree(action: () => void): void;
  canCurate(): boolean;
  changed(): void;
}

export class Views {
  private _me = "";
  private readonly _known: FollowedItems<View>;
  // the last applied view, and the state after it was applied
  private _shown: { id: number; place: string; settings: string } | null = null;
  private _back: (() => void) | null = null;
  private _notice = 0;

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _host: ViewsHost,
  ) {
    this._known = new FollowedItems({
      all: () => _api.all("GET /models/{model}/views", "views", { path: { model: _modelId } }),
      one: (id) =>
        _api.json("GET /models/{model}/views/{view}", { path: { model: _modelId, view: id } }),
      changed: () => _host.changed(),
    });
  }

  // ── list ───────────────────────────────────────────────────────────────────────────────────────

  get loaded(): boolean {
    return this._known.loaded;
  }
  /** Whether the last request for the views failed. */
  get failed(): boolean {
    return this._known.failed;
  }
  /** The views in order of creation. */
  get all(): View[] {
    return this._known.all;
  }
  find(id: number): View | null {
    return this._known.find(id);
  }
  /** The applied view; null after the first change to the camera or the settings. */
  get current(): View | null {
    return this._shown && this.isAtView ? this.find(this._shown.id) : null;
  }
  mayChange(view: View): boolean {
    return view.user === this._me || this._host.canCurate();
  }
  linkTo({ slug }: View): string {
    return `${location.origin}${pathOfModel(this._modelId)}${hashOfView(slug)}`;
  }

  /**
   * Runs when the server has identified this user. This page has not received earlier events, so it
   * loads all views.
   */
  welcome(user: string): void {
    this._me = user;
    void this.load();
  }

  load(): Promise<void> {
    return this._known.load();
  }

  onEvent({ event, view }: ViewEvent): void {
    this._known.onEvent(event, view);
  }

  // ── applying and returning ─────────────────────────────────────────────────────────────────────

  /**
   * Applies the view, fitted to this user's window. `tells` shows a notice, for users who do not
   * see the list.
   */
  goTo(view: View, tells = false): void {
    this._host.whenFree(() => {
      this.show(view);
      notices.dismiss(this._notice);
      const back = { label: words.back, act: () => this.goBack() };
      this._notice = tells
        ? notices.show("info", words.shown(view.name), view.text.slice(0, kMostSaid), back)
        : 0;
    });
  }

  /** Applies a view by slug or id, as in addresses. */
  follow(ref: string): void {
    const view = this.all.find(({ id, slug }) => slug === ref || String(id) === ref);
    if (view) this.goTo(view, true);
    else notices.show("info", words.missing);
  }

  /** Applies the next view of the list. With −1, applies the previous one. */
  step(by: 1 | -1): void {
    const { all } = this;
    const at = all.findIndex(({ id }) => id === this._shown?.id);
    const next = all[at < 0 ? (by > 0 ? 0 : all.length - 1) : (at + by + all.length) % all.length];
    if (next) this.goTo(next, true);
    else notices.show("info", words.none);
  }

  /** Whether the user can return to the state before the first applied view. */
  get leadsBack(): boolean {
    return this._back !== null;
  }
  goBack(): void {
    this._host.whenFree(() => {
      notices.dismiss(this._notice);
      this._back?.();
      this._back = this._shown = null;
      this._host.changed();
    });
  }

  private show(view: View): void {
    const { view: control, layers, appearance, tables } = this._host;
    // if true, the state from before the first applied view is kept
    const wasAtView = this.isAtView;
    const { place } = control;
    const waysBack = [layers.showView(view), appearance.showView(view)];
    control.fly(placeLike(view.camera, control.camera));
    if (!wasAtView || !this._back) {
      this._back = () => {
        for (const back of waysBack) back();
        if (tables.view) layers.setHighlight(tables.view.layerId, tables.view.highlight);
        control.fly(place);
      };
    }
    this.remember(view);
  }

  private remember({ id }: View): void {
    this._shown = { id, place: this.placeText(), settings: this.settingsText() };
    this._host.changed();
  }
  private get isAtView(): boolean {
    const { _shown } = this;
    return (
      _shown !== null &&
      _shown.place === this.placeText() &&
      _shown.settings === this.settingsText()
    );
  }
  private placeText(): string {
    return JSON.stringify(this._host.view.place);
  }
  private settingsText(): string {
    const { layers, appearance } = this._host;
    return JSON.stringify([
      layers.toKeep(),
      appearance.toKeep(),
      appearance.section,
      [...appearance.hiddenParts].sort(),
    ]);
  }

  // ── saving ─────────────────────────────────────────────────────────────────────────────────────

  /** Returns this user's current view. */
  content(): ViewContent {
    const { view, layers, appearance } = this._host;
    return { camera: view.camera.message(), layers: layers.toKeep(), ...appearance.toKeep() };
  }

  /** `key` is the idempotency key, the same for all attempts to create one view. */
  async keep(
    called: { name: string; text: string },
    content: ViewContent,
    key: string,
  ): Promise<void> {
    const made = await this._api.json("POST /models/{model}/views", {
      path: { model: this._modelId },
      body: { ...called, ...content },
      header: { "Idempotency-Key": key },
    });
    this._known.put(made);
    this._back = null; // the current state is now a saved view, so users need no way back
    this.remember(made);
  }

  /**
   * Changes the name and text of a view. If another user has changed it since this page loaded it,
   * throws an ApiError with status 412 and updates the view.
   */
  async describe(view: View, called: { name: string; text: string }): Promise<void> {
    await this.newestAfter(view, async () =>
      this._known.put(
        await this._api.json("PATCH /models/{model}/views/{view}", {
          path: { model: this._modelId, view: view.id },
          body: called,
          header: ifVersion(view.version),
        }),
      ),
    );
  }
  /**
   * Saves the current view under the existing name. If another user has changed the saved view
   * since this page loaded it, throws the same ApiError as describe().
   */
  async replace(view: View): Promise<void> {
    const changed = await this.putContent(view, this.content());
    this.remember(changed);
    const { camera, layers, looks, light } = view;
    const before = { camera, layers, ...(looks ? { looks } : {}), light };
    const undo = (): void =>
      void this.putContent(changed, before).catch((error: unknown) => notices.error(error));
    notices.show("success", words.replaced(view.name), "", { label: words.undo, act: undo });
  }
  /**
   * Deletes a view. If another user has changed it since this page loaded it, throws the same
   * ApiError as describe().
   */
  async remove(view: View): Promise<void> {
    await this.newestAfter(view, () =>
      this._api.send("DELETE /models/{model}/views/{view}", {
        path: { model: this._modelId, view: view.id },
        header: ifVersion(view.version),
      }),
    );
    this._known.drop(view.id);
  }

  private async putContent(
    view: View,
    content: Pick<View, "camera" | "layers" | "looks" | "light">,
  ): Promise<View> {
    let changed = view;
    await this.newestAfter(view, async () => {
      changed = await this._api.json("PATCH /models/{model}/views/{view}", {
        path: { model: this._modelId, view: view.id },
        body: content,
        header: ifVersion(view.version),
      });
    });
    this._known.put(changed);
    return changed;
  }

  private async newestAfter({ id }: View, work: () => Promise<void>): Promise<void> {
    try {
      await work();
    } catch (error) {
      if (error instanceof ApiError && error.status === 412) await this._known.read(id);
      throw error;
    }
  }
}
