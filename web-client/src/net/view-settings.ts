// Differences of this person's view from the defaults: sent after each change, and again after each
// welcome.

import type {
  Background,
  ClientMessage,
  LayerOverride,
  Light,
  LookShown,
  Welcome,
} from "../core/protocol.gen";

export class ViewSettings {
  overrides: LayerOverride[] = [];
  private _looks: LookShown[] | null = null; // null: the default surface images
  private _light: Light | null = null; // null: the server's default
  private _background: Background | null = null; // null: the server's default

  /** Returns whether there is a change to send. */
  setAppearance(looks: LookShown[] | null, light: Light): boolean {
    const stays = !looks && !this._looks && isUsual(light) && isUsual(this._light);
    if (!stays) [this._looks, this._light] = [looks, light];
    return !stays;
  }

  /** Returns the same. */
  setBackground(background: Background | null): boolean {
    const changes = JSON.stringify(background) !== JSON.stringify(this._background);
    if (changes) this._background = background;
    return changes;
  }

  forgetShown(): void {
    this.overrides = [];
    this._looks = this._light = null;
  }

  /**
   * Removes deleted layers and surface images: the server refuses a whole message with an unknown
   * one.
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
      this._background !== null
    );
  }

  message(): ClientMessage {
    return {
      op: "layers",
      layers: this.overrides,
      ...(this._looks ? { looks: this._looks } : {}),
      ...(this._light && !isUsual(this._light) ? { light: this._light } : {}),
      ...(this._background ? { background: this._background } : {}),
    };
  }
}

const isUsual = (light: Light | null): boolean =>
  (light?.mode ?? "museum") === "museum" && (light?.exposure ?? 0) === 0;
