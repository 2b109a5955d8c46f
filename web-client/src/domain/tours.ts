// A draft of a tour: the content of its fields, checks for missing content, and the field that a
// server error refers to.

import { readNumber, typedNumber } from "../core/locale";
import { problemOfTheme } from "./tour-theme";
import type {
  Tour,
  TourClasses,
  TourCreate,
  TourFile,
  TourMedium,
  TourRecords,
  TourStop,
  TourStopCreate,
  TourTheme,
  TourTransition,
} from "../core/protocol.gen";

export const kMostStops = 100;
export const kMostLanguages = 20;
export const kMostLayers = 20;
export const kMostRecordTables = 10;
export const kMostKeys = 100;
export const kMostMedia = 12; // per stop
export const kSeconds = { idle: [30, 3600], attract: [1, 600], transition: [0, 30] } as const;

/** Texts by language. They may be empty during editing. */
export type Words = Readonly<Record<string, string>>;

export interface MediumDraft {
  readonly file: number;
  readonly alt: Words;
  readonly caption: Words;
  readonly subtitles: Readonly<Record<string, number>>; // ids of files, by language
}

export interface StopDraft {
  /** An id that only the page uses. It does not change when the stop moves. */
  readonly id: number;
  /**
   * The slug of the view. It is empty if the view was deleted. The user must then choose another
   * view.
   */
  readonly view: string;
  readonly title: Words;
  readonly text: Words;
  /** The seconds as typed. */
  readonly attract_s: string;
  readonly transition: TourTransition;
  readonly transition_s: string;
  readonly layers: readonly string[];
  readonly records: readonly TourRecords[];
  readonly media: readonly MediumDraft[];
}

export interface TourDraft {
  readonly name: string;
  readonly text: string;
  readonly languages: readonly string[]; // the first is the default
  readonly idle_s: string;
  readonly stops: readonly StopDraft[];
  readonly theme: TourTheme;
  readonly classes: readonly TourClasses[];
  /** The files of the tour and newly uploaded files. */
  readonly files: readonly TourFile[];
}

let made = 0;

export const newStop = (
  view: { slug: string; name: string; text: string },
  language: string,
): StopDraft => ({
  id: ++made,
  view: view.slug,
  title: { [language]: view.name },
  text: view.text ? { [language]: view.text } : {},
  attract_s: typedNumber(10),
  transition: "move",
  transition_s: typedNumber(2),
  layers: [],
  records: [],
  media: [],
});

export const newMedium = (file: number): MediumDraft => ({
  file,
  alt: {},
  caption: {},
  subtitles: {},
});

const stopOf = (stop: TourStop): StopDraft => ({
  ...stop,
  id: ++made,
  view: stop.view ?? "",
  attract_s: typedNumber(stop.attract_s),
  transition_s: typedNumber(stop.transition_s),
  media: (stop.media ?? []).map((medium) => ({ ...newMedium(medium.file), ...medium })),
});

export const emptyTour = (language: string): TourDraft => ({
  name: "",
  text: "",
  languages: [language],
  idle_s: typedNumber(60),
  stops: [],
  theme: {},
  classes: [],
  files: [],
});

export const draftOf = ({
  name,
  text,
  languages,
  idle_s: idleS,
  stops,
  theme = {},
  classes = [],
  files = [],
}: Tour): TourDraft => ({
  name,
  text,
  languages,
  idle_s: typedNumber(idleS),
  stops: stops.map(stopOf),
  theme,
  classes,
  files,
});

/** Returns a copy in which the item at index `from` is at index `to`. */
export function moved<T>(all: readonly T[], from: number, to: number): T[] {
  const rest = all.filter((_, index) => index !== from);
  rest.splice(Math.max(0, Math.min(to, rest.length)), 0, all[from]!);
  return rest;
}

// ── languages ────────────────────────────────────────────────────────────────────────────────────

const without = <T>(words: Readonly<Record<string, T>>, language: string): Record<string, T> =>
  Object.fromEntries(Object.entries(words).filter(([tag]) => tag !== language));

/**
 * Removes a language and its texts, because the server accepts texts only in the tour's languages.
 */
export function withoutLanguage(draft: TourDraft, language: string): TourDraft {
  return {
    ...draft,
    languages: draft.languages.filter((each) => each !== language),
    classes: draft.classes.map(({ layer, classes }) => ({
      layer,
      classes: classes.map(({ value, names }) => ({ value, names: without(names, language) })),
    })),
    stops: draft.stops.map((stop) => ({
      ...stop,
      title: without(stop.title, language),
      text: without(stop.text, language),
      media: stop.media.map((medium) => ({
        file: medium.file,
        alt: without(medium.alt, language),
        caption: without(medium.caption, language),
        subtitles: without(medium.subtitles, language),
      })),
      records: stop.records.map((records) => ({
        ...records,
        columns: records.columns.map(({ column, labels }) => ({
          column,
          labels: without(labels ?? {}, language),
        })),
      })),
    })),
  };
}

const says = (words: Words, language: string): boolean => (words[language] ?? "").trim() !== "";

/** Whether the draft has any text in the language. */
export const writesIn = ({ stops, classes }: TourDraft, language: string): boolean =>
  classes.some((layer) => layer.classes.some(({ names }) => says(names, language))) ||
  stops.some(
    ({ title, text, records, media }) =>
      says(title, language) ||
      says(text, language) ||
      media.some(
        ({ alt, caption, subtitles }) =>
          says(alt, language) || says(caption, language) || subtitles[language] !== undefined,
      ) ||
      records.some(({ columns }) => columns.some(({ labels }) => says(labels ?? {}, language))),
  );

/**
 * Returns the languages in which the stop has no title, or no text although the first language has
 * a text.
 */
export const untranslated = ({ title, text }: StopDraft, languages: readonly string[]): string[] =>
  languages.filter(
    (language) =>
      !says(title, language) || (says(text, languages[0] ?? "") && !says(text, language)),
  );

// ── requests and checks ──────────────────────────────────────────────────────────────────────────

export type Wrong =
  | "name_missing"
  | "language_missing"
  | "stops_missing"
  | "view_missing"
  | "title_missing"
  | "seconds"
  | "contrast";

export interface DraftProblem {
  /** The server's name of the field, such as `stops[2].title.fr`. */
  field: string;
  wrong: Wrong;
  /** The minimum and maximum, for fields in seconds. */
  range?: readonly [number, number];
}

/**
 * Returns the first problem for which the server would refuse the draft. Some checks are possible
 * only on the server and are not included.
 */
export function problemOf(draft: TourDraft): DraftProblem | null {
  const [first] = draft.languages;
  const seconds = (
    field: string,
    typed: string,
    range: readonly [number, number],
    whole = false,
  ): DraftProblem | null => {
    const value = readNumber(typed);
    const fits = value >= range[0] && value <= range[1] && (!whole || Number.isInteger(value));
    return fits ? null : { field, wrong: "seconds", range };
  };
  if (draft.name.trim() === "") return { field: "name", wrong: "name_missing" };
  if (first === undefined) return { field: "languages", wrong: "language_missing" };
  const idle = seconds("idle_s", draft.idle_s, kSeconds.idle, true);
  if (idle) return idle;
  const theme = problemOfTheme(draft.theme);
  if (theme) return { field: `theme.${theme.field}`, wrong: "contrast" };
  if (draft.stops.length === 0) return { field: "stops", wrong: "stops_missing" };
  for (const [index, stop] of draft.stops.entries()) {
    const at = `stops[${index}]`;
    if (stop.view === "") return { field: `${at}.view`, wrong: "view_missing" };
    if (!says(stop.title, first)) return { field: `${at}.title.${first}`, wrong: "title_missing" };
    const wrong =
      seconds(`${at}.attract_s`, stop.attract_s, kSeconds.attract) ??
      (stop.transition === "cut"
        ? null
        : seconds(`${at}.transition_s`, stop.transition_s, kSeconds.transition));
    if (wrong) return wrong;
  }
  return null;
}

/** Returns the texts without blank ones, sorted by language tag. */
const written = (words: Words): Record<string, string> =>
  Object.fromEntries(
    Object.entries(words)
      .map(([tag, text]) => [tag, text.trim()] as const)
      .filter(([, text]) => text !== "")
      .sort(([a], [b]) => (a < b ? -1 : 1)),
  );

function bodyOfMedium({ file, alt, caption, subtitles }: MediumDraft): TourMedium {
  const [ownAlt, ownCaption] = [written(alt), written(caption)];
  const has = (words: object): boolean => Object.keys(words).length > 0;
  return {
    file,
    ...(has(ownAlt) ? { alt: ownAlt } : {}),
    ...(has(ownCaption) ? { caption: ownCaption } : {}),
    ...(has(subtitles) ? { subtitles: { ...subtitles } } : {}),
  };
}

/** Returns the layers and classes that have names. */
const bodyOfClasses = (all: readonly TourClasses[]): TourClasses[] =>
  all
    .map(({ layer, classes }) => ({
      layer,
      classes: classes
        .map(({ value, names }) => ({ value, names: written(names) }))
        .filter(({ names }) => Object.keys(names).length > 0),
    }))
    .filter(({ classes }) => classes.length > 0);

function bodyOfStop(stop: StopDraft): TourStopCreate {
  // A cut does not use the duration, which may then have any value.
  const heldS = readNumber(stop.transition_s);
  return {
    view: stop.view,
    title: written(stop.title),
    text: written(stop.text),
    attract_s: readNumber(stop.attract_s),
    transition: stop.transition,
    ...(Number.isNaN(heldS)
      ? {}
      : {
          transition_s: Math.min(kSeconds.transition[1], Math.max(kSeconds.transition[0], heldS)),
        }),
    layers: [...stop.layers],
    records: stop.records.map(({ table, keys, columns }) => ({
      table,
      keys,
      columns: columns.map(({ column, labels }) => {
        const own = written(labels ?? {});
        return Object.keys(own).length === 0 ? { column } : { column, labels: own };
      }),
    })),
    media: stop.media.map(bodyOfMedium),
  };
}

/** Builds the request body. The draft must have no problem in problemOf(). */
export const bodyOf = ({
  name,
  text,
  languages,
  idle_s: idleS,
  stops,
  theme,
  classes,
}: TourDraft): Required<TourCreate> => ({
  name: name.trim(),
  text: text.trim(),
  languages: [...languages],
  idle_s: readNumber(idleS),
  stops: stops.map(bodyOfStop),
  theme: Object.fromEntries(
    Object.entries(theme)
      .filter(([, value]) => value !== undefined && value !== "")
      .sort(([a], [b]) => (a < b ? -1 : 1)),
  ),
  classes: bodyOfClasses(classes),
});

/** Whether two drafts differ. */
export const differs = (a: TourDraft, b: TourDraft): boolean =>
  JSON.stringify(bodyOf(a)) !== JSON.stringify(bodyOf(b));

/**
 * Parses a field name from the server into the stop and the field within the stop. The stop is null
 * for a field of the tour itself.
 */
export function placeOf(field: string): { stop: number | null; within: string } {
  const found = /^stops\[(\d+)\]\.?(.*)$/.exec(field);
  return found ? { stop: Number(found[1]), within: found[2]! } : { stop: null, within: field };
}

/** Whether a problem with the field `within` concerns `field` or a part of it. */
export const isAbout = (within: string, field: string): boolean =>
  within === field || within.startsWith(`${field}.`) || within.startsWith(`${field}[`);

/**
 * Returns the language in a field name, such as `title.fr`, `text.fr`, `media[0].alt.fr` or
 * `records[0].columns[1].labels.fr`.
 */
export const languageOfField = (within: string): string | null =>
  /^(?:title|text|.*\.(?:labels|alt|caption|subtitles))\.([A-Za-z0-9-]+)$/.exec(within)?.[1] ??
  null;
