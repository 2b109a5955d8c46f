// The highlighted part of the surface. It is the area that a condition or outlines select, before
// the user paints or erases it, or the area that differs between two states. The server measures
// the area and draws an image of its visible part. The page requests both again when the camera
// stops.

import type { SelectRequest, SelectResponse } from "../core/protocol.gen";
import type { OrbitCamera } from "../math/camera";
import { cancelled, ApiError } from "../net/api-error";
import type { Api } from "../net/api";
import { pictureOfView } from "./view-picture";

/** The highlighted area. */
export type LitRequest = Pick<SelectRequest, "where" | "within" | "layers" | "include" | "changed">;

export interface LitHost {
  camera(): OrbitCamera;
  changed(): void;
}

export class LitArea {
  /** The address of an image of the stage's window. It is opaque where the area is visible. */
  picture: string | null = null;
  private _request: LitRequest | null = null;
  private _lasting: LitRequest | null = null; // highlighted again after a temporary highlight
  private _running: AbortController | null = null;

  /** Whether the rest of the frame is dimmed, because changed parts may be small. */
  get dims(): boolean {
    return this._request?.changed !== undefined;
  }

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _host: LitHost,
  ) {}

  /**
   * Measures and highlights an area, which replaces the previous one. A later call cancels this one
   * (ApiError 499). If the server refuses the area, no area is highlighted.
   */
  async show(request: LitRequest): Promise<SelectResponse> {
    this._request = request;
    try {
      return await this.measure(request);
    } catch (error) {
      if (error instanceof ApiError && error.status !== 499 && this._request === request) {
        if (this._lasting === request) this._lasting = null;
        this.clear();
      }
      throw error;
    }
  }

  /**
   * Works like `show`, but also highlights the area again after a temporary highlight of another
   * area. Null removes this area.
   */
  async showLasting(request: LitRequest | null): Promise<SelectResponse | null> {
    this._lasting = request;
    if (request) return this.show(request);
    this.clear();
    return null;
  }

  clear(): void {
    this._request = this._lasting;
    this._running?.abort();
    this._running = null;
    this.put(null);
    if (this._request) void this.measure(this._request).catch(ignored);
  }

  stop(): void {
    this._lasting = this._request = null;
    this._running?.abort();
  }

  /** Removes the image, which no longer matches the camera. */
  cameraMoved(): void {
    this.put(null);
  }

  cameToRest(): void {
    // After a failure, the area is not highlighted. Its measured size remains valid.
    if (this._request && !this.picture) void this.measure(this._request).catch(ignored);
  }

  private async measure(request: LitRequest): Promise<SelectResponse> {
    this._running?.abort();
    const running = (this._running = new AbortController());
    const picture = pictureOfView(this._host.camera());
    const answer = await this._api.json("POST /models/{model}/select", {
      path: { model: this._modelId },
      body: {
        ...request,
        picture,
      },
      signal: running.signal,
    });
    if (running.signal.aborted) throw cancelled();
    this._running = null;
    const fits = JSON.stringify(picture.camera) === JSON.stringify(this._host.camera().message());
    this.put(fits && answer.picture ? `data:image/png;base64,${answer.picture}` : null);
    return answer;
  }

  private put(picture: string | null): void {
    if (picture === this.picture) return;
    this.picture = picture;
    this._host.changed();
  }
}

const ignored = (error: unknown): void => {
  if (!(error instanceof ApiError)) throw error;
};
