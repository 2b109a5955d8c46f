// Problems of a condition report, and the dialog's fields that show them. The fields are the
// members of the dialog's input. `field:3:label` is the label of the title block's row with the
// id 3, `section:methods:text` the text of a section, and `figure:front` one of the figures.

import { formatCount, readNumber } from "../../core/locale";
import type { ProblemBody } from "../../core/types";
import {
  hasPart,
  isRecordLimit,
  keyOfView,
  kMostText,
  kRecordRange,
  sentFields,
  sentSections,
  type ReportInput,
} from "../../domain/reports";
import { readScale } from "../../domain/figures";
import { texts } from "../../texts";

const words = texts.report_dialog;
const kMostLayers = 100;

/** The messages by field. Problems without a field have the key "". */
export type Problems = ReadonlyMap<string, string>;

/** Checks the input. `views` are the saved views of the model. */
export function problemsIn(input: ReportInput, views: readonly { id: number }[]): Problems {
  const found = new Map<string, string>();
  for (const { id, label } of sentFields(input))
    if (label.trim() === "") found.set(`field:${id}:label`, words.wrong_label);
  if (sentSections(input).length === 0) found.set("sections", words.no_sections);
  for (const { part, text } of sentSections(input)) {
    const { length } = [...text.trim()];
    if (length > kMostText)
      found.set(
        `section:${part}:text`,
        words.long_text(formatCount(length), formatCount(kMostText)),
      );
  }
  if ((input.layers?.length ?? 0) > kMostLayers)
    found.set("layers", words.many_layers(kMostLayers));
  if (hasPart(input, "figures"))
    for (const { of, scale } of input.figures) {
      if (of.startsWith("view:") && !views.some((view) => keyOfView(view) === of))
        found.set(`figure:${of}`, words.no_view);
      else if (scale.trim() !== "" && Number.isNaN(readScale(scale)))
        found.set(`figure:${of}`, texts.figures.wrong_scale);
    }
  if (hasPart(input, "findings") && !isRecordLimit(readNumber(input.records)))
    found.set("records", words.wrong_records(kRecordRange.least, formatCount(kRecordRange.most)));
  return found;
}

const kPlain: readonly string[] = ["format", "language", "title", "subject", "author", "logo"];

/**
 * Returns the field for a problem that the server reported. `sent` is the input of the request, and
 * `now` the current input, which may lack the field.
 */
export function fieldOf({ field = "" }: ProblemBody, sent: ReportInput, now: ReportInput): string {
  const [, member = "", index = "", within = ""] =
    /^(\w+)(?:\[(\d+)\])?(?:\.(\w+))?/.exec(field) ?? [];
  const at = Number(index);
  switch (member) {
    case "fields": {
      const row = index === "" ? undefined : sentFields(sent)[at];
      if (!row || !now.fields.some(({ id }) => id === row.id)) return "fields";
      return `field:${row.id}:${within === "value" ? "value" : "label"}`;
    }
    case "sections": {
      const section = index === "" ? undefined : sentSections(sent)[at];
      if (!section) return "sections";
      return `section:${section.part}${within === "heading" || within === "text" ? `:${within}` : ""}`;
    }
    case "figures": {
      const figure = index === "" ? undefined : sent.figures[at];
      return figure && now.figures.some(({ of }) => of === figure.of)
        ? `figure:${figure.of}`
        : "figures";
    }
    case "layers":
      return "layers";
    case "max_records":
    case "record_pictures":
      return "records";
    default:
      return kPlain.includes(member) ? member : "";
  }
}

/** Returns the section of the dialog that contains a field, or null. */
export function partOf(field: string): string | null {
  if (field.startsWith("section:")) return field.split(":")[1]!;
  if (field.startsWith("figure")) return "figures";
  return field === "records" ? "findings" : null;
}

/** Returns the problems except those of the fields that start with one of the names. */
export function without(problems: Problems, names: readonly string[]): Problems {
  const rest = [...problems].filter(
    ([field]) =>
      field !== "" && !names.some((name) => field === name || field.startsWith(`${name}:`)),
  );
  return new Map(rest);
}
