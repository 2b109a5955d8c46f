// The export of a bill as a file, which can take minutes.

import { nothing, type ReactiveController, type ReactiveControllerHost, html } from "lit";
import { pageLocale } from "../../core/locale";
import type { Api } from "../../net/api";
import { ApiError } from "../../net/api-error";
import { saveBlob } from "../../ui/save-from";
import { texts } from "../../texts";

const words = texts.bills;

export const kBillFormats = ["xlsx", "x31", "x83", "x84", "x86"] as const;
export type BillFormat = (typeof kBillFormats)[number];

export class BillFiles implements ReactiveController {
  problem = "";
  private _request: AbortController | null = null;

  constructor(private readonly _host: ReactiveControllerHost) {
    _host.addController(this);
  }

  hostDisconnected(): void {
    this._request?.abort();
  }

  get isBusy(): boolean {
    return this._request !== null;
  }

  /** Makes the file and saves it. `name` is the name of the bill. */
  async save(
    api: Api,
    path: { project: string; bill: number },
    name: string,
    format: BillFormat,
  ): Promise<void> {
    if (this._request) return;
    const request = new AbortController();
    this._request = request;
    this.problem = "";
    this._host.requestUpdate();
    try {
      const file = await api.blob("GET /projects/{project}/bills/{bill}/file", {
        path,
        query: { f: format, lang: pageLocale() },
        signal: request.signal,
      });
      saveBlob(file, `${fileNameOf(name)}.${format}`);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (!request.signal.aborted) this.problem = error.message;
    } finally {
      this._request = null;
      this._host.requestUpdate();
    }
  }

  /** The commands of a menu. */
  items(save: (format: BillFormat) => void): unknown {
    return kBillFormats.map(
      (format) =>
        html`<button class="quiet" role="menuitem" ?disabled=${this.isBusy} @click=${() => save(format)}>${words.formats[format]}</button>`,
    );
  }

  /** The progress, or the problem of the last export. */
  state(): unknown {
    if (this._request)
      return html`<p class="row" role="status"><span class="hint grow">${words.exporting}</span>
        <button type="button" @click=${() => this._request?.abort()}>${texts.cancel}</button></p>`;
    return this.problem ? html`<p class="error" role="alert">${this.problem}</p>` : nothing;
  }
}

/** Replaces characters that file systems do not allow. */
export const fileNameOf = (name: string): string =>
  // eslint-disable-next-line no-control-regex
  name.replaceAll(/[\u0000-\u001f"*/:<>?\\|]+/g, "_").replace(/^\.+/, "_") || "bill";
