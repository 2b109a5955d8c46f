// <strata-reset-demo-dialog>: asks whether to reset the demo, and shows the progress.
// askToResetDemo() opens the dialog.

import { html, LitElement, nothing, type TemplateResult } from "lit";
import { customElement, property, query, state } from "lit/decorators.js";
import { ApiError } from "../../net/api-error";
import type { Api } from "../../net/api";
import { followJob } from "../../net/follow-job";
import "../../ui/dialog";
import type { StrataDialog } from "../../ui/dialog";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";

const words = texts.demo;

export const kDemoProject = "demo"; // the slug of the demo project

@customElement("strata-reset-demo-dialog")
class StrataResetDemoDialog extends LitElement {
  @property({ attribute: false }) api!: Api;
  answer: (isReset: boolean) => void = () => {};

  @state() private _progress: number | null = null; // 0 to 1; null before the start
  @state() private _problem = "";
  @query("strata-dialog") private _dialog!: StrataDialog;
  private _answered = false;

  static override styles = sharedStyles;

  override render(): TemplateResult {
    const { _progress: progress } = this;
    return html`<strata-dialog heading=${words.title} way_out=${texts.cancel} @closed=${() => this.finish()}>
      <p>${words.lead}</p>
      ${
        progress === null
          ? nothing
          : html`<progress max="1" .value=${progress} aria-label=${words.making}></progress>
            <p class="hint" role="status">${words.making}</p>`
      }
      <p class="error" role="alert" ?hidden=${!this._problem}>${this._problem}</p>
      <button slot="actions" class="danger" ?disabled=${progress !== null} @click=${() => void this.reset()}>${words.reset}</button>
    </strata-dialog>`;
  }

  private async reset(): Promise<void> {
    this._problem = "";
    this._progress = 0;
    try {
      const begun = await this.api.json("POST /demo/reset", {});
      const job = await followJob(this.api, begun, (now) => (this._progress = now.progress));
      if (job.state !== "done") {
        this._problem = job.problem?.detail ?? words.failed;
        return;
      }
      this._answered = true;
      this._dialog.close();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this._problem = error.message;
    } finally {
      this._progress = null;
    }
  }

  private finish(): void {
    this.answer(this._answered);
    this.remove();
  }
}

/** Resolves to true if the demo is reset. */
export function askToResetDemo(api: Api): Promise<boolean> {
  return new Promise((resolve) => {
    const element = new StrataResetDemoDialog();
    Object.assign(element, { api, answer: resolve });
    document.body.append(element);
  });
}
