// The named views of the open model: which there are, how this person comes to see it as one of
// them has it, and how they come back.

import { ApiError, type Api } from "../../net/api";
import { place_like } from "../../math/fit-to-window";
import type { View, ViewEvent } from "../../core/protocol.gen";
import type { ViewContent } from "../../domain/views";
import { KnownItems } from "../../net/known-items";
import { notices } from "../../ui/notices";
import { hash_of_view, path_of_model } from "../../ui/routes";
import { texts } from "../../texts";
import type { ViewControl } from "../../session/view-control";
import type { AppearancePart, LayersPart, TablesPart } from "../../session/parts";

const words = texts.kept_views;
const kMostSaid = 300; // characters of a view's text in a notice

export interface ViewsHost {
  readonly view: ViewControl;
  readonly layers: LayersPart;
  readonly appearance: AppearancePart;
  readonly tables: TablesPart;
  /** Runs the action now, or as soon as no stroke is under way. */
  when_free(action: () => void): void;
  can_curate(): boolean;
  changed(): void;
}

export class Views {
  private me_ = "";
  private readonly known_ = new KnownItems<View>();
  // the newest that was gone to, and what was seen then
  private shown_: { id: number; place: string; settings: string } | null = null;
  private back_: (() => void) | null = null;
  private notice_ = 0;

  constructor(
    private readonly api_: Api,
    private readonly model_id_: string,
    private readonly host_: ViewsHost,
  ) {}

  // ── what there is
  // ─────────────────────────────────────────────────────────────────────────────────────────────────

  get loaded(): boolean {
    return this.known_.loaded;
  }
  /** They could not be read. */
  get failed(): boolean {
    return this.known_.failed;
  }
  /** In the order in which they were made. */
  get all(): View[] {
    return this.known_.all.sort((a, b) => a.id - b.id);
  }
  find(id: number): View | null {
    return this.known_.find(id);
  }
  /** The view that is seen: nothing was moved or changed since this person came there. */
  get current(): View | null {
    return this.shown_ && this.is_at_view ? this.find(this.shown_.id) : null;
  }
  may_change(view: View): boolean {
    return view.user === this.me_ || this.host_.can_curate();
  }
  link_to({ slug }: View): string {
    return `${location.origin}${path_of_model(this.model_id_)}${hash_of_view(slug)}`;
  }

  /** The server said who this is; what happened before, nobody told this page. */
  welcome(user: string): void {
    this.me_ = user;
    void this.load();
  }

  async load(): Promise<void> {
    if (await this.known_.load(() => this.api_.views(this.model_id_))) this.host_.changed();
  }

  on_event({ event, view }: ViewEvent): void {
    if (event === "deleted") this.drop(view);
    else void this.read(view);
  }

  private async read(id: number): Promise<void> {
    try {
      this.put(await this.api_.view(this.model_id_, id));
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      // otherwise it is as it was, until they are all read again
      if (error.status === 404) this.drop(id);
    }
  }

  private put(view: View): void {
    if (this.known_.put(view)) this.host_.changed();
  }

  private drop(id: number): void {
    this.known_.drop(id);
    this.host_.changed();
  }

  // ── there and back
  // ────────────────────────────────────────────────────────────────────────────────────────────────

  /**
   * This person sees the model as the view has it, fitted to their window. `tells`: by a notice,
   * for who does not have the list before them.
   */
  go_to(view: View, tells = false): void {
    this.host_.when_free(() => {
      this.show(view);
      notices.dismiss(this.notice_);
      const back = { label: words.back, act: () => this.go_back() };
      this.notice_ = tells
        ? notices.show("info", words.shown(view.name), view.text.slice(0, kMostSaid), back)
        : 0;
    });
  }

  /** By slug or id, as addresses have it. */
  follow(ref: string): void {
    const view = this.all.find(({ id, slug }) => slug === ref || String(id) === ref);
    if (view) this.go_to(view, true);
    else notices.show("info", words.missing);
  }

  /** To the next view of the list, or with −1 to the one before. */
  step(by: 1 | -1): void {
    const { all } = this;
    const at = all.findIndex(({ id }) => id === this.shown_?.id);
    const next = all[at < 0 ? (by > 0 ? 0 : all.length - 1) : (at + by + all.length) % all.length];
    if (next) this.go_to(next, true);
    else notices.show("info", words.none_yet);
  }

  /** There is something that this person saw before they went to views. */
  get leads_back(): boolean {
    return this.back_ !== null;
  }
  go_back(): void {
    this.host_.when_free(() => {
      notices.dismiss(this.notice_);
      this.back_?.();
      this.back_ = this.shown_ = null;
      this.host_.changed();
    });
  }

  private show(view: View): void {
    const { view: control, layers, appearance, tables } = this.host_;
    const was_at_view = this.is_at_view; // whose way back is this one's, too
    const { place } = control;
    const ways_back = [layers.show_view(view), appearance.show_view(view)];
    control.fly(place_like(view.camera, control.camera));
    if (!was_at_view || !this.back_) {
      this.back_ = () => {
        for (const back of ways_back) back();
        if (tables.view) layers.set_highlight(tables.view.layer_id, tables.view.highlight);
        control.fly(place);
      };
    }
    this.remember(view);
  }

  private remember({ id }: View): void {
    this.shown_ = { id, place: this.place_text(), settings: this.settings_text() };
    this.host_.changed();
  }
  private get is_at_view(): boolean {
    const { shown_ } = this;
    return (
      shown_ !== null &&
      shown_.place === this.place_text() &&
      shown_.settings === this.settings_text()
    );
  }
  private place_text(): string {
    return JSON.stringify(this.host_.view.place);
  }
  private settings_text(): string {
    const { layers, appearance } = this.host_;
    return JSON.stringify([layers.to_keep(), appearance.to_keep(), appearance.section]);
  }

  // ── what is kept
  // ──────────────────────────────────────────────────────────────────────────────────────────────────

  /** What this person sees now. */
  content(): ViewContent {
    const { view, layers, appearance } = this.host_;
    return { camera: view.camera.message(), layers: layers.to_keep(), ...appearance.to_keep() };
  }

  /** `key`: the same for each attempt at one view. */
  async keep(
    called: { name: string; text: string },
    content: ViewContent,
    key: string,
  ): Promise<void> {
    const made = await this.api_.create_view(this.model_id_, { ...called, ...content }, key);
    this.put(made);
    this.back_ = null; // what was seen before has a name now
    this.remember(made);
  }

  /**
   * Of what was read: another's change in between is an ApiError of status 412, and the view is
   * then as it is now.
   */
  async describe(view: View, called: { name: string; text: string }): Promise<void> {
    await this.newest_after(view, async () =>
      this.put(await this.api_.change_view(this.model_id_, view.id, called, view.version)),
    );
  }
  /** Under the view's name what this person sees now; the same about changes in between. */
  async replace(view: View): Promise<void> {
    const changed = await this.put_content(view, this.content());
    this.remember(changed);
    const { camera, layers, looks, light } = view;
    const before = { camera, layers, ...(looks ? { looks } : {}), light };
    const undo = (): void =>
      void this.put_content(changed, before).catch((error: unknown) => notices.error(error));
    notices.show("success", words.replaced(view.name), "", { label: words.undo, act: undo });
  }
  /** The same about changes in between. */
  async remove(view: View): Promise<void> {
    await this.newest_after(view, () =>
      this.api_.delete_view(this.model_id_, view.id, view.version),
    );
    this.drop(view.id);
  }

  private async put_content(
    view: View,
    content: Pick<View, "camera" | "layers" | "looks" | "light">,
  ): Promise<View> {
    let changed = view;
    await this.newest_after(view, async () => {
      changed = await this.api_.change_view(this.model_id_, view.id, content, view.version);
    });
    this.put(changed);
    return changed;
  }

  private async newest_after({ id }: View, work: () => Promise<void>): Promise<void> {
    try {
      await work();
    } catch (error) {
      if (error instanceof ApiError && error.status === 412) await this.read(id);
      throw error;
    }
  }
}
