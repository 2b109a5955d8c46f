// <strata-report-logo>: the logo of a report: chooses, shows and removes it. The event "changed"
// contains the logo or null, and "refused" why a file cannot be a logo.

import { css, html, LitElement, type TemplateResult } from "lit";
import { customElement, property } from "lit/decorators.js";
import { kMostLogoBytes, logoType, type Logo } from "../../domain/reports";
import { icon } from "../../ui/icons";
import { sharedStyles } from "../../ui/styles";
import { texts } from "../../texts";
import "../../ui/file-choice";

const words = texts.report_dialog;

@customElement("strata-report-logo")
export class StrataReportLogo extends LitElement {
  @property({ attribute: false }) logo: Logo | null = null;

  static override styles = [
    sharedStyles,
    css`
      .shown {
        display: flex;
        align-items: center;
        gap: var(--space-3);
        min-width: 0;
      }
      img {
        flex: none;
        max-width: 8rem;
        max-height: 4rem;
        padding: var(--space-1);
        border: var(--edge) solid var(--line);
        border-radius: var(--radius-small);
        background: var(--mark-light); /* paper is white in every theme */
      }
      span {
        flex: 1;
        min-width: 0;
      }
    `,
  ];

  override render(): TemplateResult {
    const { logo } = this;
    if (!logo)
      return html`<strata-file-choice
        label=${words.logo}
        accept="image/png,image/jpeg"
        @files=${({ detail: [file] }: CustomEvent<File[]>) => void this.read(file!)}
      ></strata-file-choice>`;
    return html`<div class="shown">
      <img src="data:${logo.type};base64,${logo.data}" alt=${words.logo_alt(logo.name)} />
      <span class="ellipsis" title=${logo.name}>${logo.name}</span>
      <button type="button" class="icon quiet" aria-label=${words.logo_remove} title=${words.logo_remove} @click=${() => this.put(null)}>${icon("close")}</button>
    </div>`;
  }

  private async read(file: File): Promise<void> {
    if (file.size > kMostLogoBytes) return this.refuse(words.large_logo);
    const bytes = new Uint8Array(await file.arrayBuffer());
    const type = logoType(bytes);
    if (!type) return this.refuse(words.wrong_logo);
    // in parts, because a function call has a limited number of arguments
    let text = "";
    for (let at = 0; at < bytes.length; at += 0x8000)
      text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
    this.put({ name: file.name, type, data: btoa(text) });
  }

  private put(logo: Logo | null): void {
    this.dispatchEvent(new CustomEvent<Logo | null>("changed", { detail: logo }));
  }

  private refuse(text: string): void {
    this.dispatchEvent(new CustomEvent<string>("refused", { detail: text }));
  }
}
