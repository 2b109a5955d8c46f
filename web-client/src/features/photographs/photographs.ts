// The photographs of the open model that see a place, and how many photographs the model has.

import type { PhotographsSeeing, SurfacePlace } from "../../core/protocol.gen";
import type { CameraMessage } from "../../math/camera";
import type { Vec3 } from "../../math/vector";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";

const kMostShown = 60;

export interface PhotographsHost {
  camera(): CameraMessage;
  changed(): void;
}

export class Photographs {
  /** Whether the list is open, so that a click on the model asks for photographs. */
  isOpen = false;
  /** The photographs that see the place, best first; null before the first response. */
  found: PhotographsSeeing | null = null;
  /** How many photographs the model has, and how many of them have an image; null: unknown. */
  counts: { total: number; pictures: number } | null = null;
  isSearching = false;
  problem = "";
  private _at: SurfacePlace | null = null;
  private _asked: AbortController | null = null;

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _host: PhotographsHost,
  ) {}

  /** The place on the surface whose photographs are listed, or null. */
  get place(): Vec3 | null {
    return this.isOpen ? (this.found?.position ?? null) : null;
  }

  open(): void {
    this.isOpen = true;
    if (this._at) this.look(this._at);
    else this.lookAtMiddle();
    void this.count();
  }

  close(): void {
    this._asked?.abort();
    this._asked = this.found = null;
    this.problem = "";
    this.isOpen = this.isSearching = false;
    this._host.changed();
  }

  /** Lists the photographs that see the middle of the view. */
  lookAtMiddle(): void {
    const camera = this._host.camera();
    this.look({ camera, x: camera.width / 2, y: camera.height / 2 });
  }

  lookAt(position: Vec3): void {
    if (this.isOpen) this.look({ point: [...position] });
  }

  /** Reads everything again, after photographs were added or deleted. */
  readAgain(): void {
    void this.count();
    if (this._at) this.look(this._at);
  }

  private look(at: SurfacePlace): void {
    this._at = at;
    void this.search(at);
  }

  private async search(at: SurfacePlace): Promise<void> {
    this._asked?.abort();
    const asked = (this._asked = new AbortController());
    this.isSearching = true;
    this.problem = "";
    this._host.changed();
    try {
      const found = await this._api.json("POST /models/{model}/photographs/seeing", {
        path: { model: this._modelId },
        body: { at, limit: kMostShown },
        signal: asked.signal,
      });
      if (asked !== this._asked) return;
      this.found = found;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (asked !== this._asked) return; // a newer request has been sent, or the list was closed
      this.found = null;
      this.problem = error.message;
    }
    this.isSearching = false;
    this._host.changed();
  }

  private async count(): Promise<void> {
    try {
      const { total, with_picture: pictures } = await this._api.json(
        "GET /models/{model}/photographs",
        {
          path: { model: this._modelId },
          query: { limit: 1 },
        },
      );
      this.counts = { total, pictures };
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.problem ||= error.message;
    }
    this._host.changed();
  }
}
