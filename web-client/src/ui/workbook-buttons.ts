// Commands for a table of numbers, which copy it for a spreadsheet or save it as a file.

import { html, type TemplateResult } from "lit";
import { csvSeparator, pageLocale } from "../core/locale";
import type { WorkbookQuery } from "../domain/workbooks";
import { copyText } from "./copy-field";
import { icon } from "./icons";
import { notices } from "./notices";
import { texts } from "../texts";

export const workbookQuery = (f: WorkbookQuery["f"]): WorkbookQuery => ({
  f,
  lang: pageLocale(),
  separator: csvSeparator(),
});

/**
 * Converts rows of texts to a text that can be pasted into a spreadsheet. Tabs and line breaks in
 * cells are replaced, because they would split the cells.
 */
export const asPasted = (rows: readonly (readonly string[])[]): string =>
  rows.map((row) => row.map((cell) => cell.replaceAll(/[\t\r\n]+/g, " ")).join("\t")).join("\n");

async function copy(rows: readonly (readonly string[])[], holder: HTMLElement): Promise<void> {
  const text = asPasted(rows);
  const copied = await copyText(text, () => {
    const field = document.createElement("textarea");
    field.value = text;
    field.style.position = "fixed";
    field.style.opacity = "0";
    holder.after(field); // inside the dialog, because text outside it cannot be selected
    field.select();
    return () => field.remove();
  });
  notices.show(
    copied ? "success" : "problem",
    copied ? texts.statistics.copied : texts.statistics.not_copied,
  );
}

interface CopiedTable {
  what: string;
  rows: () => readonly (readonly string[])[];
}

export const copyButton = ({ what, rows }: CopiedTable): TemplateResult =>
  html`<button type="button" aria-label="${texts.statistics.copy}: ${what}" @click=${(event: Event) => void copy(rows(), event.currentTarget as HTMLElement)}>${icon("copy")}${texts.statistics.copy}</button>`;

export function workbookButtons(
  of: CopiedTable & { save: (f: WorkbookQuery["f"]) => void },
): TemplateResult {
  const words = texts.statistics;
  const files: WorkbookQuery["f"][] = ["csv", "xlsx"];
  return html`${copyButton(of)}
    ${files.map((f) => html`<button type="button" aria-label="${f.toUpperCase()}: ${of.what}" title=${words.save[f]} @click=${() => of.save(f)}>${icon("import")}${f.toUpperCase()}</button>`)}`;
}
