// Surveys of objects: their dates, the cards of the model list, and the settings that two surveys of
// an object share.

import { pageLocale } from "../core/locale";
import type { SurveyedObject } from "../core/protocol.gen";
import type { Model } from "../core/types";
import { placeOf, type OrbitCamera, type Place } from "../math/camera";
import { scale } from "../math/vector";
import { metresPer } from "./measure";

/** Formats the date of a survey: "2019", "May 2019" or "1 May 2019". */
export function toldSurveyDate(date: string): string {
  const [year, month, day] = date.split("-").map(Number);
  if (month === undefined) return date;
  const at = new Date(0);
  at.setUTCFullYear(year!, month - 1, day ?? 1);
  return at.toLocaleDateString(pageLocale(), {
    timeZone: "UTC",
    year: "numeric",
    month: "short",
    ...(day === undefined ? {} : { day: "numeric" }),
  });
}

/** Whether a text is the date of a survey: an existing year, month or day. */
export function isSurveyDate(text: string): boolean {
  if (!/^\d{4}(-\d{2}){0,2}$/.test(text)) return false;
  const [year, month = 1, day = 1] = text.split("-").map(Number);
  const at = new Date(0);
  at.setUTCFullYear(year!, month - 1, day);
  return at.getUTCMonth() === month - 1 && at.getUTCDate() === day;
}

/** A card of the model list: a model, or an object with the models of its surveys, by date. */
export type ModelCard = { model: Model } | { object: SurveyedObject; models: Model[] };

/**
 * Puts the models of each object on one card, at the position of the first of them. Models of
 * unknown objects keep their own cards.
 */
export function cardsOf(models: readonly Model[], objects: readonly SurveyedObject[]): ModelCard[] {
  const known = new Map(objects.map((object) => [object.id, object]));
  const cards: ModelCard[] = [];
  const ofObjects = new Map<number, Model[]>();
  for (const model of models) {
    const object = known.get(model.object ?? 0);
    const others = object && ofObjects.get(object.id);
    if (!object) cards.push({ model });
    else if (others) others.push(model);
    else {
      const own = [model];
      ofObjects.set(object.id, own);
      cards.push({ object, models: own });
    }
  }
  for (const own of ofObjects.values()) own.sort(byDate);
  return cards;
}

const dateOf = (model: Model): string => model.survey_date ?? "";
const byDate = (a: Model, b: Model): number =>
  dateOf(a) < dateOf(b) ? -1 : dateOf(a) > dateOf(b) ? 1 : a.id - b.id;

/** How a user sees the layers of a model, by the names of the layers. */
export type LayersSeen = ReadonlyMap<string, { visible: boolean; opacity: number }>;

/** Returns the settings that show these layers like layers with the same names. */
export const seenAlike = (
  seen: LayersSeen,
  layers: readonly { id: number; name: string }[],
): { layer: number; visible: boolean; opacity: number }[] =>
  layers.flatMap(({ id, name }) => {
    const shown = seen.get(name);
    return shown ? [{ layer: id, ...shown }] : [];
  });

type Unit = Model["unit"];

/** Converts a position of the camera from one unit of lengths to another. */
export function placeInUnit(place: Place, from: Unit, to: Unit): Place {
  const factor = metresPer(from) / metresPer(to);
  return { ...place, target: scale(place.target, factor), distance: place.distance * factor };
}

/**
 * Moves `other`, a camera in another unit, to the position and the window of `own`. Its bounds
 * remain those of its own model.
 */
export function standAlike(other: OrbitCamera, own: OrbitCamera, from: Unit, to: Unit): void {
  const factor = metresPer(from) / metresPer(to);
  other.resize(own.width, own.height);
  Object.assign(other, placeInUnit(placeOf(own), from, to));
  other.section = own.section.map(([a, b, c, d]) => [a, b, c, d * factor]);
}
