// The kiosk's link to its server. It signs in with the link's secret. At intervals, it then checks
// whether the link is valid, whether the tour has changed, and whether to reload the page. If the
// server is unreachable, the kiosk retries without limit, at increasing intervals. If the server
// does not accept the link, the kiosk retries every five minutes, because the tour may be restored
// from the trash.

import type { Api } from "../net/api";
import { ApiError } from "../net/api-error";
import type { KioskSelf } from "../core/protocol.gen";

const kHeartbeatS = 30;
const kFirstRetryS = 1;
const kWorthlessS = 300;

export interface LinkHost {
  told(self: KioskSelf): void;
  /** The server sent no response, or an invalid one. */
  missed(): void;
  /**
   * The link was revoked, has expired, or its tour is in the trash. Called after each such
   * response. If the link becomes valid again, the page is reloaded.
   */
  worthless(): void;
  reload(): void;
}

export class KioskLink {
  private _signedIn = false;
  private _ended = false;
  private _worthless = false;
  private _asking = false;
  private _failures = 0;
  private _timer: ReturnType<typeof setTimeout> | null = null;

  constructor(
    private readonly _api: Api,
    private readonly _secret: string,
    private readonly _host: LinkHost,
  ) {}

  /** Sends the next request immediately. */
  ask(): void {
    if (this._ended || this._asking) return;
    if (this._timer) clearTimeout(this._timer);
    this._timer = null;
    void this.turn();
  }

  stop(): void {
    this._ended = true;
    if (this._timer) clearTimeout(this._timer);
    this._timer = null;
  }

  private async turn(): Promise<void> {
    this._asking = true;
    try {
      await this.askOnce();
      this._failures = 0;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._failures += 1;
      if (!this._ended) this._host.missed();
    } finally {
      this._asking = false;
    }
    if (this._ended) return;
    const waitS = this._worthless
      ? kWorthlessS
      : this._failures === 0
        ? kHeartbeatS
        : Math.min(kHeartbeatS, kFirstRetryS * 2 ** (this._failures - 1));
    this._timer = setTimeout(() => void this.turn(), waitS * 1000);
  }

  private async askOnce(): Promise<void> {
    const self = this._signedIn ? await this.unlessForgotten(this._api.json("GET /kiosk")) : null;
    if (self?.wants_reload) {
      this.stop();
      this._host.reload();
    } else this.take(self ?? (await this.signIn()));
  }

  /**
   * Returns null if the server does not recognize this browser, for example because the cookie was
   * lost.
   */
  private async unlessForgotten(asked: Promise<KioskSelf>): Promise<KioskSelf | null> {
    try {
      return await asked;
    } catch (error) {
      if (error instanceof ApiError && [401, 403, 404].includes(error.status)) return null;
      throw error;
    }
  }

  private async signIn(): Promise<KioskSelf | null> {
    this._signedIn = false;
    try {
      const self = await this._api.json("POST /auth/kiosk", { body: { link: this._secret } });
      this._signedIn = true;
      return self;
    } catch (error) {
      // 404: the tour was deleted. 422: the format of the secret is invalid.
      if (!(error instanceof ApiError) || ![401, 404, 422].includes(error.status)) throw error;
      return null;
    }
  }

  private take(self: KioskSelf | null): void {
    if (this._ended) return;
    if (!self) {
      this._worthless = true;
      this._host.worthless();
    } else if (this._worthless) {
      this.stop();
      this._host.reload();
    } else this._host.told(self);
  }
}
