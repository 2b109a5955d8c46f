// The snapshots of the open model: named states, in the server's list.

import { type Api, ifVersion } from "../../net/api";
import { ApiError } from "../../net/api-error";
import type { Snapshot } from "../../core/protocol.gen";
import { KnownItems } from "../../net/known-items";

export interface SnapshotsHost {
  user(): string;
  canCurate(): boolean;
  changed(): void;
}

export class Snapshots {
  private readonly _known = new KnownItems<Snapshot>();

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _host: SnapshotsHost,
  ) {}

  get loaded(): boolean {
    return this._known.loaded;
  }
  get failed(): boolean {
    return this._known.failed;
  }
  /**
   * The snapshots by state, with the earliest first. Snapshots of the same state are in order of
   * creation.
   */
  get all(): Snapshot[] {
    return this._known.all.sort((a, b) => a.sequence - b.sequence || a.id - b.id);
  }
  mayChange({ user }: Snapshot): boolean {
    return user === this._host.user() || this._host.canCurate();
  }

  async load(): Promise<void> {
    const read = (): Promise<Snapshot[]> =>
      this._api.all("GET /models/{model}/snapshots", "snapshots", {
        path: { model: this._modelId },
      });
    if (await this._known.load(read)) this._host.changed();
  }

  /**
   * Creates a snapshot. A null `at` means the newest state. `key` is the same for all attempts to
   * create one snapshot.
   */
  async create(
    called: { name: string; text: string },
    at: number | null,
    key: string,
  ): Promise<void> {
    this.put(
      await this._api.json("POST /models/{model}/snapshots", {
        path: { model: this._modelId },
        body: { ...called, ...(at === null ? {} : { at }) },
        header: { "Idempotency-Key": key },
      }),
    );
  }

  /**
   * Changes a snapshot. If another user has changed it since this page loaded it, throws an
   * ApiError with status 412 and reloads the list.
   */
  async rename({ id, version }: Snapshot, called: { name: string; text: string }): Promise<void> {
    await this.newestAfter(async () =>
      this.put(
        await this._api.json("PATCH /models/{model}/snapshots/{snapshot}", {
          path: { model: this._modelId, snapshot: id },
          body: called,
          header: ifVersion(version),
        }),
      ),
    );
  }
  /**
   * Deletes a snapshot. If another user has changed it since this page loaded it, throws the same
   * ApiError as rename().
   */
  async remove({ id, version }: Snapshot): Promise<void> {
    await this.newestAfter(() =>
      this._api.send("DELETE /models/{model}/snapshots/{snapshot}", {
        path: { model: this._modelId, snapshot: id },
        header: ifVersion(version),
      }),
    );
    this._known.drop(id);
    this._host.changed();
  }

  private put(snapshot: Snapshot): void {
    if (this._known.put(snapshot)) this._host.changed();
  }

  private async newestAfter(work: () => Promise<void>): Promise<void> {
    try {
      await work();
    } catch (error) {
      if (error instanceof ApiError && [404, 412].includes(error.status)) await this.load();
      throw error;
    }
  }
}
