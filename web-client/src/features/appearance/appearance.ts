// A user's view of the model: its surface images, light, section and hidden parts. Only saved views
// store these settings. Each user has separate settings.

import { nameOfFile } from "../../domain/file-names";
import { type Api, kAsItIs } from "../../net/api";
import type { Bounds } from "../../math/camera";
import type {
  Light,
  Look,
  LookEvent,
  LookPatch,
  LookShown,
  Plane,
  SectionCut,
} from "../../core/protocol.gen";
import {
  noSection,
  sectionChoice,
  sectionPlanes,
  type SectionChoice,
  type SectionMode,
} from "../../math/section";
import { looksOfView, type LookSettings } from "../../domain/views";
import { notices } from "../../ui/notices";
import { reorder } from "../../ui/order/reorder";
import { texts } from "../../texts";

export const kMostLooksShown = 4;
/**
 * The reduced opacity of layers keeps tool marks visible below the paint. The fill light keeps
 * detail visible in the shadows.
 */
const kFirstLight: Required<Light> = {
  mode: "museum",
  direction: [-0.85, 0.4, 0.35],
  exposure: 0,
  fill: 0.3,
  layer_opacity: 0.3,
};

export interface AppearanceHost {
  /** Null means the default surface images. */
  send(looks: LookShown[] | null, light: Light): void;
  sendSection(planes: Plane[], hiddenParts: readonly number[], moving: boolean): void;
  bounds(): Bounds | null;
  changed(): void;
}

export const kLightModes: readonly Light["mode"][] = ["museum", "headlight", "raking", "unlit"];
export const kCuts = ["off", "x", "y", "z"] as const satisfies readonly SectionMode[];
const after = <T>(all: readonly T[], one: T): T => all[(all.indexOf(one) + 1) % all.length]!;

export class Appearance {
  looks: Look[] = []; // in ascending order; the last one is on top
  light = kFirstLight;
  section: SectionChoice = noSection();
  hiddenParts: ReadonlySet<number> = new Set(); // numbers of parts of the model

  private _overrides = new Map<number, LookSettings>();
  // surface images of a saved view, bottom to top; other images are above them, in the order of
  // `looks`
  private _stack: number[] = [];

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _host: AppearanceHost,
  ) {}

  // ── surface images ─────────────────────────────────────────────────────────────────────────────

  visible(look: Look): boolean {
    return this._overrides.get(look.id)?.visible ?? look.visible;
  }
  opacity(look: Look): number {
    return this._overrides.get(look.id)?.opacity ?? look.opacity;
  }

  setVisible(look: Look, visible: boolean): void {
    if (visible && this.looks.filter((each) => this.visible(each)).length >= kMostLooksShown) {
      notices.show("info", texts.view.too_many_looks(kMostLooksShown));
      return;
    }
    this.override(look, { visible });
  }

  setOpacity(look: Look, opacity: number): void {
    this.override(look, { opacity });
  }

  async add(file: File): Promise<void> {
    const look = await this._api.json("POST /models/{model}/looks", {
      path: { model: this._modelId },
      query: { name: nameOfFile(file.name) },
      body: file,
      type: file.type,
    });
    this.put(look);
    if (!this.visible(look)) this.setVisible(look, true);
  }

  /** Shows a surface image that a job made for this user. */
  async showMade(id: number): Promise<void> {
    if (!this.looks.some((look) => look.id === id))
      this.takeLooks(
        await this._api.all("GET /models/{model}/looks", "looks", {
          path: { model: this._modelId },
        }),
      );
    const look = this.looks.find((each) => each.id === id);
    if (look && !this.visible(look)) this.setVisible(look, true);
  }

  async rename(look: Look, name: string): Promise<void> {
    this.put(await this.changeLook(look, { name }));
  }

  /** Moves the surface image to `index` in the list, which is ordered from bottom to top. */
  async move(look: Look, index: number): Promise<void> {
    await reorder(this.looks, look, index, {
      show: (looks) => this.takeLooks(looks),
      save: async (each) => this.put(await this.changeLook(each, { order: each.order })),
      reload: () =>
        this._api.all("GET /models/{model}/looks", "looks", { path: { model: this._modelId } }),
    });
  }

  /** Changes the current version of the surface image. */
  private async changeLook({ id }: Look, body: LookPatch): Promise<Look> {
    const path = { model: this._modelId, look: id };
    const { etag } = await this._api.versioned("GET /models/{model}/looks/{look}", { path });
    const header = { "If-Match": etag };
    return this._api.json("PATCH /models/{model}/looks/{look}", { path, body, header });
  }

  async remove(look: Look): Promise<void> {
    await this._api.send("DELETE /models/{model}/looks/{look}", {
      path: { model: this._modelId, look: look.id },
      header: kAsItIs,
    });
    this.drop(look.id);
  }

  async saveAsDefault(): Promise<void> {
    for (const look of this.looks) {
      const [visible, opacity] = [this.visible(look), this.opacity(look)];
      if (visible !== look.visible || opacity !== look.opacity)
        this.put(await this.changeLook(look, { visible, opacity }));
    }
    this.forgetOwnLooks();
    this.send();
  }

  get hasLookOverrides(): boolean {
    const isOwn = (look: Look): boolean =>
      this.visible(look) !== look.visible || Math.abs(this.opacity(look) - look.opacity) > 1e-6;
    const visible = this.looks.filter((look) => this.visible(look));
    return (
      this.looks.some(isOwn) || this.stacked(visible).some((look, place) => look !== visible[place])
    );
  }

  takeLooks(looks: Look[]): void {
    this.putAll(looks);
    for (const id of this._overrides.keys())
      if (!looks.some((look) => look.id === id)) this._overrides.delete(id);
    this.send();
  }

  onEvent(event: LookEvent): void {
    if (event.event === "deleted") this.drop(event.look_id);
    else if (event.look) this.put(event.look);
  }

  // ── light and section ──────────────────────────────────────────────────────────────────────────

  setLight(change: Partial<Light>): void {
    this.light = { ...this.light, ...change };
    this.send();
  }

  /** `moving` means that more changes follow immediately. */
  setSection(change: Partial<SectionChoice>, moving = false): void {
    this.section = { ...this.section, ...change };
    this.sendSection(moving);
  }

  setHiddenParts(hidden: ReadonlySet<number>): void {
    this.hiddenParts = hidden;
    this.sendSection();
  }

  nextLight(): void {
    this.setLight({ mode: after(kLightModes, this.light.mode) });
  }
  nextSection(): void {
    this.setSection({ mode: after(kCuts, this.section.mode) });
  }

  /** Call this when the model's bounds become known or change. */
  sendSection(moving = false): void {
    const bounds = this._host.bounds();
    if (bounds)
      this._host.sendSection(
        sectionPlanes(this.section, bounds),
        [...this.hiddenParts].sort((a, b) => a - b),
        moving,
      );
    this._host.changed();
  }

  /** Returns the cut areas in the order of the planes. */
  async measureSection(planes: Plane[]): Promise<SectionCut[]> {
    const path = { model: this._modelId };
    const body = { section: planes };
    return (await this._api.json("POST /models/{model}/section", { path, body })).cuts;
  }

  get isDefault(): boolean {
    const { mode, exposure } = this.light;
    return (
      mode === "museum" &&
      exposure === 0 &&
      this.section.mode === "off" &&
      this.hiddenParts.size === 0 &&
      !this.hasLookOverrides
    );
  }

  // ── saved views ────────────────────────────────────────────────────────────────────────────────

  /** Returns the settings that a saved view stores. Section and hidden parts are in the camera. */
  toKeep(): { looks: LookShown[]; light: Light } {
    return { looks: this.shownLooks(), light: lightShown(this.light) };
  }

  /**
   * Applies the settings of a saved view. Returns a function that restores the previous settings.
   */
  showView(view: {
    camera: { section?: Plane[]; hidden_parts?: number[] };
    looks?: LookShown[];
    light: Light;
  }): () => void {
    const { _overrides, _stack, light, section, hiddenParts } = this;
    const { settings, stack } = looksOfView(view, this.looks);
    const bounds = this._host.bounds();
    const ofView = bounds ? sectionChoice(view.camera.section ?? [], bounds) : section;
    this.take({
      _overrides: settings,
      _stack: stack,
      light: lightOf(view.light),
      section: ofView,
      hiddenParts: new Set(view.camera.hidden_parts ?? []),
    });
    return () => this.take({ _overrides, _stack, light, section, hiddenParts });
  }
  private take(all: {
    _overrides: Map<number, LookSettings>;
    _stack: number[];
    light: Required<Light>;
    section: SectionChoice;
    hiddenParts: ReadonlySet<number>;
  }): void {
    Object.assign(this, all);
    this.send();
    this.sendSection();
  }

  reset(): void {
    this.forgetOwnLooks();
    this.light = kFirstLight;
    this.section = noSection();
    this.hiddenParts = new Set();
    this.send();
    this.sendSection();
  }

  private forgetOwnLooks(): void {
    this._overrides = new Map();
    this._stack = [];
  }

  private override(look: Look, change: LookSettings): void {
    this._overrides.set(look.id, { ...this._overrides.get(look.id), ...change });
    this.send();
  }

  private send(): void {
    this._host.send(this.hasLookOverrides ? this.shownLooks() : null, lightShown(this.light));
    this._host.changed();
  }

  private shownLooks(): LookShown[] {
    const shown = this.stacked(this.looks.filter((look) => this.visible(look))).slice(
      -kMostLooksShown,
    );
    return shown.map((look) => ({ look: look.id, opacity: this.opacity(look) }));
  }

  /** Sorts the surface images from bottom to top. */
  private stacked(looks: Look[]): Look[] {
    const place = ({ id }: Look): number =>
      this._stack.includes(id) ? this._stack.indexOf(id) : this._stack.length;
    return [...looks].sort((a, b) => place(a) - place(b) || looks.indexOf(a) - looks.indexOf(b));
  }

  private put(look: Look): void {
    this.putAll([...this.looks.filter((other) => other.id !== look.id), look]);
    if (this._overrides.size > 0) this.send();
  }

  private putAll(looks: Look[]): void {
    this.looks = [...looks].sort((a, b) => a.order - b.order || a.id - b.id);
    this._host.changed();
  }

  private drop(id: number): void {
    this.looks = this.looks.filter((look) => look.id !== id);
    if (this._overrides.delete(id)) this.send();
    this._host.changed();
  }
}

/** Returns the settings that have an effect in this light. */
function lightShown(light: Required<Light>): Light {
  const { mode, direction, exposure, fill, layer_opacity: opacity } = light;
  return {
    mode,
    direction,
    ...(exposure === 0 ? {} : { exposure }),
    ...(mode === "raking" ? { fill, layer_opacity: opacity } : {}),
  };
}

/** Returns the light of a saved view. Absent numbers have the contract's defaults. */
function lightOf(light: Light): Required<Light> {
  const raking = light.mode === "raking" ? { fill: 0, layer_opacity: 1 } : {};
  return { ...kFirstLight, ...raking, ...light };
}
