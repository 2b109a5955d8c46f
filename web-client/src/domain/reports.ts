// Condition reports: the options of a report, and the request to the server.

import { kPageLanguages, typedNumber, readNumber } from "../core/locale";
import type {
  FigureDirection,
  ReportFigure,
  ReportFormat,
  ReportLanguage,
  ReportPart,
  ReportRequest,
} from "../core/protocol.gen";
import { isScale, kDirections, readScale, scaleText } from "./figures";

export const kReportFormats: readonly ReportFormat[] = ["docx", "pdf"];
export const kReportLanguages: readonly ReportLanguage[] = kPageLanguages;
export const kReportParts: readonly ReportPart[] = [
  "object",
  "condition",
  "figures",
  "quantities",
  "findings",
  "measures",
  "methods",
  "provenance",
];
export const kMostFields = 20;
export const kMostFigures = 24;
export const kMostText = 20_000; // characters of a section
export const kRecordRange = { least: 0, most: 1000 };
export const kMostLogoBytes = 500_000;

/** A row of the title block. `id` identifies the row in the dialog. */
export interface FieldInput {
  id: number;
  label: string;
  value: string;
}

export interface SectionInput {
  part: ReportPart;
  on: boolean;
  heading: string;
  text: string;
}

/** `of` is a direction or keyOfView(). `scale` is the text as typed. If empty, the server chooses. */
export interface FigureInput {
  of: string;
  scale: string;
}

/** The input of the dialog. If a text is empty, the server uses its default. */
export interface ReportInput {
  format: ReportFormat;
  language: ReportLanguage;
  title: string;
  subject: string;
  author: string;
  fields: readonly FieldInput[];
  sections: readonly SectionInput[];
  layers: readonly number[] | null; // null for the layers that the user sees
  figures: readonly FigureInput[];
  records: string; // the largest number of records, as typed
  recordPictures: boolean;
}

export const keyOfView = ({ id }: { id: number }): string => `view:${id}`;

const figureOf = (direction: FigureDirection): FigureInput => ({ of: direction, scale: "" });

/** Returns the input before the first report. */
export const usualReport = (language: ReportLanguage): ReportInput => ({
  format: "docx",
  language,
  title: "",
  subject: "",
  author: "",
  fields: [],
  sections: kReportParts.map((part) => ({ part, on: true, heading: "", text: "" })),
  layers: null,
  figures: (["front", "right", "back", "left"] as const).map(figureOf),
  records: typedNumber(100),
  recordPictures: true,
});

/** The choices that are kept for reports of other models. */
export interface KeptReport {
  format: ReportFormat;
  language: ReportLanguage;
  author: string;
  labels: string[]; // of the title block
  sections: { part: ReportPart; on: boolean; heading: string }[];
  figures: { direction: FigureDirection; scale: number | null }[];
  records: number;
  recordPictures: boolean;
}

/** Returns the part of the input that does not belong to one model. */
export function keptReport(input: ReportInput): KeptReport {
  const records = readNumber(input.records);
  return {
    format: input.format,
    language: input.language,
    author: input.author,
    labels: input.fields.map(({ label }) => label.trim()).filter((label) => label !== ""),
    sections: input.sections.map(({ part, on, heading }) => ({ part, on, heading })),
    figures: input.figures.flatMap(({ of, scale }) => {
      const direction = kDirections.find((each) => each === of);
      const read = readScale(scale);
      return direction ? [{ direction, scale: isScale(read) ? read : null }] : [];
    }),
    records: isRecordLimit(records) ? records : 100,
    recordPictures: input.recordPictures,
  };
}

type Unknown = Record<string, unknown>;
const objectOf = (value: unknown): Unknown =>
  typeof value === "object" && value !== null ? (value as Unknown) : {};
const listOf = (value: unknown): unknown[] => (Array.isArray(value) ? value : []);
const textOf = (value: unknown, most: number): string =>
  typeof value === "string" ? value.slice(0, most) : "";

export const isRecordLimit = (value: unknown): value is number =>
  Number.isInteger(value) &&
  (value as number) >= kRecordRange.least &&
  (value as number) <= kRecordRange.most;

/**
 * Makes the input for a new model from the choices in the browser's storage. They may be invalid or
 * from another version of the page. The default replaces an invalid choice.
 */
export function reportInput(stored: unknown, language: ReportLanguage): ReportInput {
  const usual = usualReport(language);
  const kept = objectOf(stored);
  const oneOf = <T>(value: unknown, choices: readonly T[], otherwise: T): T =>
    choices.includes(value as T) ? (value as T) : otherwise;
  return {
    ...usual,
    format: oneOf(kept["format"], kReportFormats, usual.format),
    language: oneOf(kept["language"], kReportLanguages, usual.language),
    author: textOf(kept["author"], 200),
    fields: listOf(kept["labels"])
      .slice(0, kMostFields)
      .map((label, id) => ({ id, label: textOf(label, 100), value: "" })),
    sections: sectionsFrom(kept["sections"], usual.sections),
    figures: figuresFrom(kept["figures"]) ?? usual.figures,
    records: isRecordLimit(kept["records"]) ? typedNumber(kept["records"]) : usual.records,
    recordPictures: oneOf(kept["recordPictures"], [true, false], usual.recordPictures),
  };
}

/** Returns each section once, in the stored order. Sections that are not stored are at the end. */
function sectionsFrom(stored: unknown, usual: readonly SectionInput[]): SectionInput[] {
  const known = listOf(stored).flatMap((each): SectionInput[] => {
    const { part, on, heading } = objectOf(each);
    const section = usual.find((one) => one.part === part);
    return section ? [{ ...section, on: on !== false, heading: textOf(heading, 200) }] : [];
  });
  const all = [...known, ...usual];
  return all.filter(({ part }, at) => all.findIndex((each) => each.part === part) === at);
}

function figuresFrom(stored: unknown): FigureInput[] | null {
  if (!Array.isArray(stored)) return null;
  const all = stored.flatMap((each: unknown): FigureInput[] => {
    const { direction, scale } = objectOf(each);
    const known = kDirections.find((one) => one === direction);
    return known ? [{ of: known, scale: isScale(scale) ? scaleText(scale) : "" }] : [];
  });
  return all.filter(({ of }, at) => all.findIndex((each) => each.of === of) === at);
}

// ── the request ──────────────────────────────────────────────────────────────────────────────────

/** Returns the rows of the title block that the request contains. */
export const sentFields = ({ fields }: ReportInput): FieldInput[] =>
  fields.filter(({ label, value }) => label.trim() !== "" || value.trim() !== "");

/** Returns the sections that the request contains. */
export const sentSections = ({ sections }: ReportInput): SectionInput[] =>
  sections.filter(({ on }) => on);

/** Whether the report has a section. */
export const hasPart = (input: ReportInput, part: ReportPart): boolean =>
  sentSections(input).some((each) => each.part === part);

/**
 * Builds the request from valid input. `visible` are the ids of the layers that the user sees.
 * `logo` is the file in base64.
 */
export function reportRequest(
  input: ReportInput,
  visible: readonly number[],
  logo: string | null,
): ReportRequest {
  const written = <Name extends string>(name: Name, text: string): { [Key in Name]?: string } =>
    text.trim() === "" ? {} : ({ [name]: text.trim() } as { [Key in Name]?: string });
  return {
    format: input.format,
    language: input.language,
    ...written("title", input.title),
    ...written("subject", input.subject),
    ...written("author", input.author),
    fields: sentFields(input).map(({ label, value }) => ({
      label: label.trim(),
      value: value.trim(),
    })),
    ...(logo === null ? {} : { logo }),
    sections: sentSections(input).map(({ part, heading, text }) => ({
      part,
      ...written("heading", heading),
      ...written("text", text),
    })),
    layers: [...(input.layers ?? visible)],
    ...(hasPart(input, "figures") ? { figures: input.figures.map(requestedFigure) } : {}),
    ...(hasPart(input, "findings")
      ? { max_records: readNumber(input.records), record_pictures: input.recordPictures }
      : {}),
  };
}

function requestedFigure({ of, scale }: FigureInput): ReportFigure {
  const direction = kDirections.find((each) => each === of);
  return {
    ...(direction ? { direction } : { view: of.replace("view:", "") }),
    ...(scale.trim() === "" ? {} : { scale: readScale(scale) }),
  };
}

// ── the logo ─────────────────────────────────────────────────────────────────────────────────────

/** A picture file. `data` is its content in base64. */
export interface Logo {
  name: string;
  type: "image/png" | "image/jpeg";
  data: string;
}

/** Returns the type of a picture by its first bytes, or null if the server cannot use it. */
export function logoType(bytes: Uint8Array): Logo["type"] | null {
  const startsWith = (...start: number[]): boolean => start.every((byte, at) => bytes[at] === byte);
  if (startsWith(0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a)) return "image/png";
  return startsWith(0xff, 0xd8, 0xff) ? "image/jpeg" : null;
}

/** Reads the logo from the browser's storage. Returns null if it is not a logo. */
export function keptLogo(stored: unknown): Logo | null {
  const { name, type, data } = objectOf(stored);
  return typeof name === "string" &&
    (type === "image/png" || type === "image/jpeg") &&
    typeof data === "string" &&
    /^[A-Za-z0-9+/]+={0,2}$/.test(data)
    ? { name, type, data }
    : null;
}
