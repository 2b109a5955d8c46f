// The kiosk's link to its server: signs in with the link's secret, and asks from time to time
// whether it is still good, the tour still the same, and whether the page is to be loaded anew. A
// server that is away is asked again for ever, ever more seldom; and so is, every five minutes, one
// that knows no such link: what was in the Bin may be restored.

import { ApiError } from "../net/api";
import type { KioskSelf } from "../core/protocol.gen";

const kHeartbeat_s = 30;
const kFirstRetry_s = 1;
const kWorthless_s = 300;

export interface LinkServer {
  sign_in_kiosk(link: string): Promise<KioskSelf>;
  kiosk_self(): Promise<KioskSelf>;
}

export interface LinkHost {
  told(self: KioskSelf): void;
  /** No answer, or none that says anything. */
  missed(): void;
  /**
   * It was revoked, is over, or its tour is in the Bin. Told each time. If it is good again, the
   * page is loaded anew.
   */
  worthless(): void;
  reload(): void;
}

export class KioskLink {
  private signed_in_ = false;
  private ended_ = false;
  private worthless_ = false;
  private asking_ = false;
  private failures_ = 0;
  private timer_: ReturnType<typeof setTimeout> | null = null;

  constructor(
    private readonly server_: LinkServer,
    private readonly secret_: string,
    private readonly host_: LinkHost,
  ) {}

  /** Now, whenever the next time would have been. */
  ask(): void {
    if (this.ended_ || this.asking_) return;
    if (this.timer_) clearTimeout(this.timer_);
    this.timer_ = null;
    void this.turn();
  }

  stop(): void {
    this.ended_ = true;
    if (this.timer_) clearTimeout(this.timer_);
    this.timer_ = null;
  }

  private async turn(): Promise<void> {
    this.asking_ = true;
    try {
      await this.ask_once();
      this.failures_ = 0;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.failures_ += 1;
      if (!this.ended_) this.host_.missed();
    } finally {
      this.asking_ = false;
    }
    if (this.ended_) return;
    const wait_s = this.worthless_
      ? kWorthless_s
      : this.failures_ === 0
        ? kHeartbeat_s
        : Math.min(kHeartbeat_s, kFirstRetry_s * 2 ** (this.failures_ - 1));
    this.timer_ = setTimeout(() => void this.turn(), wait_s * 1000);
  }

  private async ask_once(): Promise<void> {
    const self = this.signed_in_ ? await this.unless_forgotten(this.server_.kiosk_self()) : null;
    if (self?.wants_reload) {
      this.stop();
      this.host_.reload();
    } else this.take(self ?? (await this.sign_in()));
  }

  /** Null: the server no longer knows this browser, which may only have lost its cookie. */
  private async unless_forgotten(asked: Promise<KioskSelf>): Promise<KioskSelf | null> {
    try {
      return await asked;
    } catch (error) {
      if (error instanceof ApiError && [401, 403, 404].includes(error.status)) return null;
      throw error;
    }
  }

  private async sign_in(): Promise<KioskSelf | null> {
    this.signed_in_ = false;
    try {
      const self = await this.server_.sign_in_kiosk(this.secret_);
      this.signed_in_ = true;
      return self;
    } catch (error) {
      // 404: its tour is gone. 422: no such secret could have been given.
      if (!(error instanceof ApiError) || ![401, 404, 422].includes(error.status)) throw error;
      return null;
    }
  }

  private take(self: KioskSelf | null): void {
    if (this.ended_) return;
    if (!self) {
      this.worthless_ = true;
      this.host_.worthless();
    } else if (this.worthless_) {
      this.stop();
      this.host_.reload();
    } else this.host_.told(self);
  }
}
