// The saved selections of the open model, in the server's list.

import { type Api, ifVersion } from "../net/api";
import { ApiError } from "../net/api-error";
import type {
  SavedSelection,
  SavedSelectionCreate,
  SavedSelectionPatch,
  SelectionEvent,
} from "../core/protocol.gen";
import { FollowedItems } from "../net/followed-items";

export interface SavedSelectionsHost {
  user(): string;
  canCurate(): boolean;
  changed(): void;
}

export class SavedSelections {
  private readonly _known: FollowedItems<SavedSelection>;

  constructor(
    private readonly _api: Api,
    private readonly _modelId: string,
    private readonly _host: SavedSelectionsHost,
  ) {
    this._known = new FollowedItems({
      all: () =>
        _api.all("GET /models/{model}/selections", "selections", { path: { model: _modelId } }),
      one: (id) =>
        _api.json("GET /models/{model}/selections/{selection}", {
          path: { model: _modelId, selection: id },
        }),
      changed: () => _host.changed(),
    });
  }

  get loaded(): boolean {
    return this._known.loaded;
  }
  /** Whether the last request for the selections failed. */
  get failed(): boolean {
    return this._known.failed;
  }
  /** The selections in order of creation. */
  get all(): SavedSelection[] {
    return this._known.all;
  }
  find(id: number): SavedSelection | null {
    return this._known.find(id);
  }
  mayChange({ user }: SavedSelection): boolean {
    return user === this._host.user() || this._host.canCurate();
  }

  load(): Promise<void> {
    return this._known.load();
  }

  onEvent({ event, selection }: SelectionEvent): void {
    this._known.onEvent(event, selection);
  }

  /** `key` is the idempotency key, the same for all attempts to save one selection. */
  async create(selection: SavedSelectionCreate, key: string): Promise<void> {
    this._known.put(
      await this._api.json("POST /models/{model}/selections", {
        path: { model: this._modelId },
        body: selection,
        header: { "Idempotency-Key": key },
      }),
    );
  }

  /**
   * Changes a selection and returns its new version. If another user has changed it since this page
   * loaded it, throws an ApiError with status 412 and loads it again.
   */
  async change(
    { id, version }: SavedSelection,
    patch: SavedSelectionPatch,
  ): Promise<SavedSelection> {
    return this.newestAfter(id, async () => {
      const changed = await this._api.json("PATCH /models/{model}/selections/{selection}", {
        path: { model: this._modelId, selection: id },
        body: patch,
        header: ifVersion(version),
      });
      this._known.put(changed);
      return changed;
    });
  }

  /**
   * Deletes a selection. If another user has changed it since this page loaded it, throws the same
   * ApiError as change().
   */
  async remove({ id, version }: SavedSelection): Promise<void> {
    await this.newestAfter(id, () =>
      this._api.send("DELETE /models/{model}/selections/{selection}", {
        path: { model: this._modelId, selection: id },
        header: ifVersion(version),
      }),
    );
    this._known.drop(id);
  }

  private async newestAfter<T>(id: number, work: () => Promise<T>): Promise<T> {
    try {
      return await work();
    } catch (error) {
      if (error instanceof ApiError && [404, 412].includes(error.status))
        await this._known.read(id);
      throw error;
    }
  }
}
