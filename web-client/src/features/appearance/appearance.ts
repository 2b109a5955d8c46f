// How this person sees the model: its looks, the light and the section. Nothing of it is kept but
// by named views, and others see it their way.

import type { Api } from "../../net/api";
import type { Bounds } from "../../math/camera";
import type { Light, Look, LookEvent, LookShown, Plane } from "../../core/protocol.gen";
import {
  no_section,
  section_choice,
  section_planes,
  type SectionChoice,
  type SectionMode,
} from "../../math/section";
import { looks_of_view, type LookSettings } from "../../domain/views";
import { notices } from "../../ui/notices";
import { reorder } from "../../ui/reorder";
import { texts } from "../../texts";

export const kMostLooksShown = 4;
const kFirstRaking: [number, number, number] = [-0.85, 0.4, 0.35];

export interface AppearanceHost {
  /** Null: the looks that everyone sees at first. */
  send(looks: LookShown[] | null, light: Light): void;
  send_section(planes: Plane[], moving: boolean): void;
  bounds(): Bounds | null;
  changed(): void;
}

const kLightModes: readonly Light["mode"][] = ["museum", "headlight", "raking", "unlit"];
const kCuts: readonly SectionMode[] = ["off", "x", "y", "z"];
const after = <T>(all: readonly T[], one: T): T => all[(all.indexOf(one) + 1) % all.length]!;

export class Appearance {
  looks: Look[] = []; // by order: the last is on top
  light: Required<Light> = { mode: "museum", direction: kFirstRaking };
  section: SectionChoice = no_section();

  private overrides_ = new Map<number, LookSettings>();
  // looks of a named view, bottom to top; others lie above them in their own order
  private stack_: number[] = [];

  constructor(
    private readonly api_: Api,
    private readonly model_id_: string,
    private readonly host_: AppearanceHost,
  ) {}

  // ── looks
  // ─────────────────────────────────────────────────────────────────────────────────────────────────────────

  visible(look: Look): boolean {
    return this.overrides_.get(look.id)?.visible ?? look.visible;
  }
  opacity(look: Look): number {
    return this.overrides_.get(look.id)?.opacity ?? look.opacity;
  }

  set_visible(look: Look, visible: boolean): void {
    if (visible && this.looks.filter((each) => this.visible(each)).length >= kMostLooksShown) {
      notices.show("info", texts.view.too_many_looks(kMostLooksShown));
      return;
    }
    this.override(look, { visible });
  }

  set_opacity(look: Look, opacity: number): void {
    this.override(look, { opacity });
  }

  async add(file: File): Promise<void> {
    const look = await this.api_.create_look(this.model_id_, file);
    this.put(look);
    if (!this.visible(look)) this.set_visible(look, true);
  }

  /** A look that work made for this person: they see it at once. */
  async show_made(id: number): Promise<void> {
    if (!this.looks.some((look) => look.id === id))
      this.take_looks(await this.api_.looks(this.model_id_));
    const look = this.looks.find((each) => each.id === id);
    if (look && !this.visible(look)) this.set_visible(look, true);
  }

  async rename(look: Look, name: string): Promise<void> {
    this.put(await this.api_.change_look(this.model_id_, look.id, { name }));
  }

  /** Moves the look to the place `index` of the list, which is bottom to top. */
  async move(look: Look, index: number): Promise<void> {
    await reorder(this.looks, look, index, {
      show: (looks) => this.take_looks(looks),
      save: async (each) =>
        this.put(await this.api_.change_look(this.model_id_, each.id, { order: each.order })),
      reload: () => this.api_.looks(this.model_id_),
    });
  }

  async remove(look: Look): Promise<void> {
    await this.api_.delete_look(this.model_id_, look.id);
    this.drop(look.id);
  }

  async save_as_default(): Promise<void> {
    for (const look of this.looks) {
      const [visible, opacity] = [this.visible(look), this.opacity(look)];
      if (visible !== look.visible || opacity !== look.opacity)
        this.put(await this.api_.change_look(this.model_id_, look.id, { visible, opacity }));
    }
    this.forget_own_looks();
    this.send();
  }

  get has_look_overrides(): boolean {
    const is_own = (look: Look): boolean =>
      this.visible(look) !== look.visible || Math.abs(this.opacity(look) - look.opacity) > 1e-6;
    const visible = this.looks.filter((look) => this.visible(look));
    return (
      this.looks.some(is_own) ||
      this.stacked(visible).some((look, place) => look !== visible[place])
    );
  }

  take_looks(looks: Look[]): void {
    this.put_all(looks);
    for (const id of this.overrides_.keys())
      if (!looks.some((look) => look.id === id)) this.overrides_.delete(id);
    this.send();
  }

  on_event(event: LookEvent): void {
    if (event.event === "deleted") this.drop(event.look_id);
    else if (event.look) this.put(event.look);
  }

  // ── light and section
  // ─────────────────────────────────────────────────────────────────────────────────────────────

  set_light(change: Partial<Light>): void {
    this.light = { ...this.light, ...change };
    this.send();
  }

  /** `moving`: more will follow at once. */
  set_section(change: Partial<SectionChoice>, moving = false): void {
    this.section = { ...this.section, ...change };
    this.send_section(moving);
  }

  next_light(): void {
    this.set_light({ mode: after(kLightModes, this.light.mode) });
  }
  next_section(): void {
    this.set_section({ mode: after(kCuts, this.section.mode) });
  }

  /** The model's bounds are known, or others. */
  send_section(moving = false): void {
    const bounds = this.host_.bounds();
    if (bounds) this.host_.send_section(section_planes(this.section, bounds), moving);
    this.host_.changed();
  }

  get is_default(): boolean {
    return this.light.mode === "museum" && this.section.mode === "off" && !this.has_look_overrides;
  }

  // ── named views
  // ───────────────────────────────────────────────────────────────────────────────────────────────────

  /** What a named view keeps of all this, apart from the section, which is the camera's. */
  to_keep(): { looks: LookShown[]; light: Light } {
    return { looks: this.shown_looks(), light: this.light };
  }

  /** As a named view has it. Returns the way back. */
  show_view(view: {
    camera: { section?: Plane[] };
    looks?: LookShown[];
    light: Light;
  }): () => void {
    const { overrides_, stack_, light, section } = this;
    const { settings, stack } = looks_of_view(view, this.looks);
    const bounds = this.host_.bounds();
    const of_view = bounds ? section_choice(view.camera.section ?? [], bounds) : section;
    this.take({
      overrides_: settings,
      stack_: stack,
      light: { direction: kFirstRaking, ...view.light },
      section: of_view,
    });
    return () => this.take({ overrides_, stack_, light, section });
  }
  private take(all: {
    overrides_: Map<number, LookSettings>;
    stack_: number[];
    light: Required<Light>;
    section: SectionChoice;
  }): void {
    Object.assign(this, all);
    this.send();
    this.send_section();
  }

  reset(): void {
    this.forget_own_looks();
    this.light = { mode: "museum", direction: kFirstRaking };
    this.section = no_section();
    this.send();
    this.send_section();
  }

  private forget_own_looks(): void {
    this.overrides_ = new Map();
    this.stack_ = [];
  }

  private override(look: Look, change: LookSettings): void {
    this.overrides_.set(look.id, { ...this.overrides_.get(look.id), ...change });
    this.send();
  }

  private send(): void {
    this.host_.send(this.has_look_overrides ? this.shown_looks() : null, this.light);
    this.host_.changed();
  }

  private shown_looks(): LookShown[] {
    const shown = this.stacked(this.looks.filter((look) => this.visible(look))).slice(
      -kMostLooksShown,
    );
    return shown.map((look) => ({ look: look.id, opacity: this.opacity(look) }));
  }

  /** Bottom to top. */
  private stacked(looks: Look[]): Look[] {
    const place = ({ id }: Look): number =>
      this.stack_.includes(id) ? this.stack_.indexOf(id) : this.stack_.length;
    return [...looks].sort((a, b) => place(a) - place(b) || looks.indexOf(a) - looks.indexOf(b));
  }

  private put(look: Look): void {
    this.put_all([...this.looks.filter((other) => other.id !== look.id), look]);
    if (this.overrides_.size > 0) this.send();
  }

  private put_all(looks: Look[]): void {
    this.looks = [...looks].sort((a, b) => a.order - b.order || a.id - b.id);
    this.host_.changed();
  }

  private drop(id: number): void {
    this.looks = this.looks.filter((look) => look.id !== id);
    if (this.overrides_.delete(id)) this.send();
    this.host_.changed();
  }
}
