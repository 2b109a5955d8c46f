// Sends the camera to the server. It sends at most one camera for each repaint of the page, always
// the latest one.

import type { CameraMessage } from "../math/camera";
import type { ClientMessage } from "../core/protocol.gen";

export interface CameraHost {
  maySend(): boolean;
  /** Whether so much data is unsent that cameras must wait. */
  isBusy(): boolean;
  send(message: ClientMessage): void;
  /** Calls back before the next repaint. */
  nextFrame(callback: () => void): void;
}

export class CameraSender {
  /** The number of the last sent camera. The server returns it in frames. */
  seq = 0;
  private _newest: { camera: CameraMessage; moving: boolean } | null = null;
  private _sent = ""; // the camera of the last message
  private _sentSince = 0; // the number of the first message with this camera
  private _isScheduled = false;

  constructor(private readonly _host: CameraHost) {}

  set(camera: CameraMessage, moving: boolean): void {
    this._newest = { camera, moving };
    this.schedule();
  }

  /**
   * Returns the number of the first message with the current camera. Returns null if a frame with
   * the number `seq` shows an older camera. A message with an unchanged camera causes no new frame.
   */
  numberOf(seq: number): number | null {
    const isSent = JSON.stringify(this._newest?.camera) === this._sent;
    return isSent && seq >= this._sentSince ? this._sentSince : null;
  }

  forget(): void {
    this._newest = null;
  }

  /** Sends the latest camera again, for example after a reconnection. */
  sendNow(): void {
    if (!this._newest) return;
    const { camera, moving } = this._newest;
    this._newest = { camera, moving: false }; // after a reconnection, the camera is not moving
    this.seq += 1;
    const sent = JSON.stringify(camera);
    if (sent !== this._sent) [this._sent, this._sentSince] = [sent, this.seq];
    this._host.send({ op: "camera", seq: this.seq, ...camera, moving });
  }

  private schedule(): void {
    if (this._isScheduled || !this._newest) return;
    this._isScheduled = true;
    this._host.nextFrame(() => {
      this._isScheduled = false;
      if (!this._host.maySend()) return;
      if (this._host.isBusy()) this.schedule();
      else this.sendNow();
    });
  }
}
