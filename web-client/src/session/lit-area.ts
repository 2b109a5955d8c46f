// The part of the surface that a condition or outlines select, lit in the picture before anything
// changes, or the part that differs between two states. The server measures it and draws where the camera sees it; both are requested again
// when the camera rests.

import type { SelectRequest, SelectResponse } from "../core/protocol.gen";
import type { OrbitCamera } from "../math/camera";
import { cancelled, ApiError } from "../net/api-error";
import type { Api } from "../net/api";

const kMostPixels = 640; // of the longer side: the picture only marks an area

/** What is lit. */
export type LitRequest = Pick<SelectRequest, "where" | "within" | "layers" | "include" | "changed">;

export interface LitHost {
  camera(): OrbitCamera;
  changed(): void;
}

export class LitArea {
  /** The address of a picture in the stage's window: opaque where the area is seen. */
  picture: string | null = null;
  private _request: LitRequest | null = null;
  private _lasting: LitRequest | null = null; // lit again when another area is no longer lit
  private _running: AbortController | null = null;

  /** The rest of the picture is dimmed: what changed may be small. */
  get dims(): boolean {
    return this._request?.changed !== undefined;
  }

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _host: LitHost,
  ) {}

  /**
   * Measures and lights an area in place of the previous one. A later call cancels this one
   * (ApiError 499). A refused area leaves nothing lit.
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

  /** As `show`, and the area stays lit after others were lit in between. Null: no longer. */
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

  /** The picture no longer fits. */
  cameraMoved(): void {
    this.put(null);
  }

  cameToRest(): void {
    // A failure leaves the area unlit; the measured one stays valid.
    if (this._request && !this.picture) void this.measure(this._request).catch(ignored);
  }

  private async measure(request: LitRequest): Promise<SelectResponse> {
    this._running?.abort();
    const running = (this._running = new AbortController());
    const camera = this._host.camera();
    const scale = Math.min(1, kMostPixels / Math.max(camera.width, camera.height));
    const seenBy = camera.message();
    const answer = await this._api.json("POST /models/{model}/select", {
      path: { model: this._modelId },
      body: {
        ...request,
        picture: {
          camera: seenBy,
          width: Math.max(1, Math.round(camera.width * scale)),
          height: Math.max(1, Math.round(camera.height * scale)),
        },
      },
      signal: running.signal,
    });
    if (running.signal.aborted) throw cancelled();
    this._running = null;
    const fits = JSON.stringify(seenBy) === JSON.stringify(this._host.camera().message());
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
