// Reads and changes the metadata of the open model, and previews another unit and up direction.

import type { Api, Versioned } from "../net/api";
import type { Model, ModelPatch } from "../core/types";
import type { ViewControl } from "./view-control";

export type ModelScale = Pick<Model, "unit" | "up">;

export class EditableModel {
  private _value: Model | null = null;
  private _etag = "";
  private _preview: ModelScale | null = null;

  constructor(
    private readonly _api: Api,
    private readonly _id: string,
    private readonly _host: {
      view: ViewControl;
      changed(): void;
    },
  ) {}

  get value(): Model | null {
    return this._value;
  }

  /** Reads the server's version without displaying it. */
  read(): Promise<Versioned<Model>> {
    return this._api.versioned("GET /models/{model}", { path: { model: this._id } });
  }

  async change(change: ModelPatch): Promise<void> {
    this.take(
      await this._api.versioned("PATCH /models/{model}", {
        path: { model: this._id },
        body: change,
        header: { "If-Match": this._etag },
      }),
    );
  }

  /**
   * Displays the model with this unit and up direction, without saving them. Null restores the
   * model's own unit and up direction.
   */
  preview(scale: ModelScale | null): void {
    if (!this.value) return;
    this._preview = scale;
    this._host.view.previewUp(this.value, scale?.up ?? this.value.up);
    this._host.changed();
  }

  /** The unit of the displayed lengths. */
  get shownUnit(): Model["unit"] {
    return this._preview?.unit ?? this.value?.unit ?? "m";
  }

  take({ value, etag }: Versioned<Model>): void {
    this._etag = etag;
    this.put(value);
  }

  put(model: Model): void {
    const turned = this.value !== null && this.value.up !== model.up;
    this._value = model;
    // Changes by other users do not end the preview.
    const { view } = this._host;
    if (this._preview) view.setModel({ ...model, up: this._preview.up }, false);
    else view.setModel(model, turned);
    this._host.changed();
  }
}
