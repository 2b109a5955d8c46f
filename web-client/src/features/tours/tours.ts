// The tours of the open model, for those who make them. Nobody tells this page what others do to
// them, so they are read again where that matters.

import { ApiError, type Api } from "../../net/api";
import type { Tour, TourCreate, TourEntry } from "../../core/protocol.gen";
import { KnownItems } from "../../net/known-items";

export class Tours {
  private readonly known_ = new KnownItems<TourEntry>();

  constructor(
    private readonly api_: Api,
    private readonly model_id_: string,
    private readonly changed_: () => void,
  ) {}

  get loaded(): boolean {
    return this.known_.loaded;
  }
  /** They could not be read. */
  get failed(): boolean {
    return this.known_.failed;
  }
  /** In the order in which they were made. */
  get all(): TourEntry[] {
    return this.known_.all.sort((a, b) => a.id - b.id);
  }

  async load(): Promise<void> {
    if (await this.known_.load(() => this.api_.tours(this.model_id_))) this.changed_();
  }

  /** With its stops, as it is now. */
  async read(id: number): Promise<Tour> {
    try {
      return this.put(await this.api_.tour(this.model_id_, id));
    } catch (error) {
      if (error instanceof ApiError && error.status === 404) this.drop(id);
      throw error;
    }
  }

  /** `key`: the same for each attempt at one tour. */
  async make(tour: TourCreate, key: string): Promise<Tour> {
    return this.put(await this.api_.create_tour(this.model_id_, tour, key));
  }
  /** Of what was read: another's change in between is an ApiError of status 412. */
  async change(
    { id, version }: { id: number; version: number },
    change: TourCreate,
  ): Promise<Tour> {
    return this.put(await this.api_.change_tour(this.model_id_, id, change, version));
  }
  /** The same about changes in between. */
  async remove({ id, version }: TourEntry): Promise<void> {
    try {
      await this.api_.delete_tour(this.model_id_, id, version);
    } catch (error) {
      if (error instanceof ApiError && error.status === 412) await this.load();
      if (!(error instanceof ApiError && error.status === 404)) throw error;
    }
    this.drop(id);
  }

  private put(tour: Tour): Tour {
    const { stops, idle_s: _, ...entry } = tour;
    if (this.known_.put({ ...entry, stop_count: stops.length })) this.changed_();
    return tour;
  }
  private drop(id: number): void {
    this.known_.drop(id);
    this.changed_();
  }
}
