// The tours of the open model, for curators. The page receives no events about other users' changes
// to tours, so it loads the tours again when necessary.

import { ApiError } from "../../net/api-error";
import { type Api, ifVersion } from "../../net/api";
import type { Progress, Upload } from "../../net/upload";
import type { Tour, TourCreate, TourEntry, TourFile } from "../../core/protocol.gen";
import { KnownItems } from "../../net/known-items";

export class Tours {
  private readonly _known = new KnownItems<TourEntry>();

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _changed: () => void,
  ) {}

  get loaded(): boolean {
    return this._known.loaded;
  }
  /** Whether the last request for the tours failed. */
  get failed(): boolean {
    return this._known.failed;
  }
  /** The tours in order of creation. */
  get all(): TourEntry[] {
    return this._known.all.sort((a, b) => a.id - b.id);
  }

  async load(): Promise<void> {
    if (
      await this._known.load(() =>
        this._api.all("GET /models/{model}/tours", "tours", { path: { model: this._modelId } }),
      )
    )
      this._changed();
  }

  /** Returns the current version, with its stops. */
  async read(id: number): Promise<Tour> {
    try {
      return this.put(
        await this._api.json("GET /models/{model}/tours/{tour}", {
          path: { model: this._modelId, tour: id },
        }),
      );
    } catch (error) {
      if (error instanceof ApiError && error.status === 404) this.drop(id);
      throw error;
    }
  }

  /** `key` is the idempotency key, the same for all attempts to create one tour. */
  async make(tour: TourCreate, key: string): Promise<Tour> {
    return this.put(
      await this._api.json("POST /models/{model}/tours", {
        path: { model: this._modelId },
        body: tour,
        header: { "Idempotency-Key": key },
      }),
    );
  }
  /**
   * Changes a tour. If another user has changed the tour since this page loaded it, throws an
   * ApiError with status 412.
   */
  async change(
    { id, version }: { id: number; version: number },
    change: TourCreate,
  ): Promise<Tour> {
    return this.put(
      await this._api.json("PATCH /models/{model}/tours/{tour}", {
        path: { model: this._modelId, tour: id },
        body: change,
        header: ifVersion(version),
      }),
    );
  }
  /**
   * Uploads a picture, sound, video or subtitles. The tour uses the file only after a version of
   * the tour that contains the file is saved.
   */
  addFile(tour: number, file: File, progress: Progress): Upload<TourFile> {
    return this._api.upload(
      "POST /models/{model}/tours/{tour}/files",
      { path: { model: this._modelId, tour }, query: { name: file.name.slice(0, 255) } },
      [{ file, path: file.name }],
      progress,
    );
  }
  /** Returns the address of a file, or of its thumbnail. */
  addressOf(tour: number, file: number, thumbnail?: 256): string {
    const address = `/api/v1/models/${this._modelId}/tours/${tour}/files/${file}`;
    return thumbnail ? `${address}?thumbnail=${thumbnail}` : address;
  }
  /**
   * Deletes a tour. If another user has changed the tour since this page loaded it, throws the same
   * ApiError as change().
   */
  async remove({ id, version }: TourEntry): Promise<void> {
    try {
      await this._api.send("DELETE /models/{model}/tours/{tour}", {
        path: { model: this._modelId, tour: id },
        header: ifVersion(version),
      });
    } catch (error) {
      if (error instanceof ApiError && error.status === 412) await this.load();
      if (!(error instanceof ApiError && error.status === 404)) throw error;
    }
    this.drop(id);
  }

  private put(tour: Tour): Tour {
    const { stops, idle_s: _, theme: __, classes: ___, files: ____, ...entry } = tour;
    if (this._known.put({ ...entry, stop_count: stops.length })) this._changed();
    return tour;
  }
  private drop(id: number): void {
    this._known.drop(id);
    this._changed();
  }
}
