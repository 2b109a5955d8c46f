// The differences between this user's view and the defaults. They are sent after each change, and
// again after each welcome.

import type {
  Background,
  ClientMessage,
  LayerOverride,
  Light,
  LookShown,
  Welcome,
} from "../core/protocol.gen";

/** The id of the view that shows an earlier state next to the newest state. */
export const kBesideView = 1;

export class ViewSettings {
  overrides: LayerOverride[] = [];
  private _looks: LookShown[] | null = null; // null for the default surface images
  private _light: Light | null = null; // null for the server's default
  private _background: Background | null = null; // null for the server's default
  private _at: number | null = null; // shows the state after this edit; null for the newest state
  // the second view shows this state, and the first view shows the newest state
  private _beside = false;

  /** Sets the surface images and light. Returns whether there is a change to send. */
  setAppearance(looks: LookShown[] | null, light: Light): boolean {
    const stays = !looks && !this._looks && isUsual(light) && isUsual(this._light);
    if (!stays) [this._looks, this._light] = [looks, light];
    return !stays;
  }

  /** Sets the background. Returns whether there is a change to send. */
  setBackground(background: Background | null): boolean {
    const changes = JSON.stringify(background) !== JSON.stringify(this._background);
    if (changes) this._background = background;
    return changes;
  }

  /** Sets the state to show. With `beside`, the second view shows it. */
  setPast(at: number | null, beside: boolean): void {
    [this._at, this._beside] = [at, at !== null && beside];
  }
  /** Whether the second view shows an earlier state. */
  get comparesWithPast(): boolean {
    return this._beside;
  }

  forgetShown(): void {
    this.overrides = [];
    this.setPast(null, false);
    this._looks = this._light = null;
  }

  /**
   * Removes deleted layers and surface images, because the server refuses a whole message if it
   * contains an unknown one.
   */
  keepOnly({ layers, looks }: Pick<Welcome, "layers" | "looks">): void {
    const layerIds = new Set<number | string>(layers.map(({ id }) => id));
    this.overrides = this.overrides.filter(({ layer }) => layerIds.has(layer));
    const lookIds = new Set<number | string>(looks.map(({ id }) => id));
    this._looks = this._looks?.filter(({ look }) => lookIds.has(look)) ?? null;
  }

  get differ(): boolean {
    return (
      this.overrides.length > 0 ||
      this._looks !== null ||
      !isUsual(this._light) ||
      this._background !== null ||
      this._at !== null
    );
  }

  message(): ClientMessage {
    return {
      op: "layers",
      layers: this.overrides,
      ...(this._looks ? { looks: this._looks } : {}),
      ...(this._light && !isUsual(this._light) ? { light: this._light } : {}),
      ...(this._background ? { background: this._background } : {}),
      ...(this._at !== null && !this._beside ? { at: this._at } : {}),
    };
  }

  /** Returns the message for the second view, which shows the earlier state. */
  messageBeside(): ClientMessage {
    const message = { ...this.message(), view_id: kBesideView };
    return this._at === null ? message : ({ ...message, at: this._at } as ClientMessage);
  }
}

const isUsual = (light: Light | null): boolean =>
  (light?.mode ?? "museum") === "museum" && (light?.exposure ?? 0) === 0;
