// The preview of a condition report: a PDF that the browser shows in another tab. The page's policy
// forbids frames with such content, and browsers of phones cannot show a PDF in a frame.

import { html, nothing, type TemplateResult } from "lit";
import { reportRequest, type Logo, type ReportInput } from "../../domain/reports";
import type { ReportRequest } from "../../core/protocol.gen";
import { texts } from "../../texts";

const words = texts.report_dialog;

/** The settings of a report. `layers` are the ids of its layers. */
export interface ReportSettings {
  input: ReportInput;
  layers: readonly number[];
  logo: Logo | null;
}

/** Returns the request for a preview, which is a PDF also if the report will be a DOCX. */
export function previewRequest({ input, layers, logo }: ReportSettings): ReportRequest {
  return reportRequest({ ...input, format: "pdf" }, layers, logo?.data ?? null);
}

export class ReportPreview {
  readonly address: string; // of the PDF, until release()
  private readonly _shown: string;

  /** `settings` are those that the preview shows. */
  constructor(
    pdf: Blob,
    private readonly _name: string,
    private readonly _settings: ReportSettings,
  ) {
    // with this type, the browser cannot show the content as a page of this site
    this.address = URL.createObjectURL(pdf.slice(0, pdf.size, "application/pdf"));
    this._shown = withoutLogo(_settings);
  }

  /** Whether the report with other settings would differ. */
  differs(settings: ReportSettings): boolean {
    return (
      settings.logo?.data !== this._settings.logo?.data || withoutLogo(settings) !== this._shown
    );
  }

  /** Releases the PDF. A tab that shows it keeps it. */
  release(): void {
    URL.revokeObjectURL(this.address);
  }

  /** Renders the link, for a dialog with these settings. */
  render(settings: ReportSettings): TemplateResult {
    // Browsers that cannot show a PDF save it, so the phone's own program opens it.
    const saves = navigator.pdfViewerEnabled === false;
    return html`${this.differs(settings) ? words.preview_stale : words.preview_ready}
      <a class="text" href=${this.address} target="_blank" rel="noopener" download=${saves ? this._name : nothing}>${saves ? words.preview_save : words.preview_open}</a>`;
  }
}

const withoutLogo = (settings: ReportSettings): string =>
  JSON.stringify(previewRequest({ ...settings, logo: null }));
