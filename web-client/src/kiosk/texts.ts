// The words of the kiosk's own buttons and signs. What the stops say comes with the tour, in
// languages of which this page may have no words of its own.

import { pageLanguage, type PageLanguage } from "../core/locale";

const en = {
  begin: "Touch to begin",
  still_there: "Are you still there?",
  begins_anew: (seconds: number) =>
    `The tour restarts in ${seconds} ${seconds === 1 ? "second" : "seconds"}.`,
  here: "I am still here",
  previous: "Previous",
  next: "Next",
  stop: (number: number, count: number) => `Stop ${number} of ${count}`,
  languages: "Language",
  layers: "Layers",
  as_kept: "Overview",
  records: "More about",
  record: (key: number) => `No. ${key}`,
  close: "Close",
  enlarge: (name: string) => `Enlarge: ${name}`,
  yes: "yes",
  no: "no",
  stage:
    "The object in 3D. Use one finger to turn it, two fingers to move, zoom and tilt it. Tap a place to learn more.",
  hint: "Turn with one finger, zoom with two. Tap a place to learn more.",
  stored: "Still pictures for a moment",
  waiting: "One moment …",
  worthless: "This screen no longer has a tour",
  worthless_detail: "Its link was revoked or has expired. Create a new link in Strata.",
  nothing: "This tour has nothing to show yet",
  nothing_detail: "Add views to its stops in Strata. This screen then starts automatically.",
};
export type KioskTexts = typeof en;

const de: KioskTexts = {
  begin: "Zum Beginnen berühren",
  still_there: "Sind Sie noch da?",
  begins_anew: (seconds) =>
    `Der Rundgang beginnt in ${seconds} ${seconds === 1 ? "Sekunde" : "Sekunden"} von vorn.`,
  here: "Ich bin noch da",
  previous: "Zurück",
  next: "Weiter",
  stop: (number, count) => `Station ${number} von ${count}`,
  languages: "Sprache",
  layers: "Was gezeigt wird",
  as_kept: "Überblick",
  records: "Mehr über",
  record: (key) => `Nr. ${key}`,
  close: "Schließen",
  enlarge: (name) => `Vergrößern: ${name}`,
  yes: "ja",
  no: "nein",
  stage:
    "Das Objekt in 3D. Ein Finger dreht es; zwei Finger verschieben, vergrößern und neigen es; ein Tippen erzählt mehr über eine Stelle.",
  hint: "Mit einem Finger drehen, mit zweien vergrößern. Tippen Sie auf eine Stelle, um mehr zu erfahren.",
  stored: "Für einen Moment stehende Bilder",
  waiting: "Einen Moment …",
  worthless: "Dieser Bildschirm hat keinen Rundgang mehr",
  worthless_detail:
    "Sein Link wurde zurückgezogen oder ist abgelaufen. Wer den Bildschirm betreut, kann in Strata einen neuen anlegen.",
  nothing: "Dieser Rundgang hat noch nichts zu zeigen",
  nothing_detail:
    "Wer ihn betreut, kann seinen Stationen in Strata Ansichten geben. Dieser Bildschirm beginnt dann von selbst.",
};

const es: KioskTexts = {
  begin: "Toque para comenzar",
  still_there: "¿Sigue ahí?",
  begins_anew: (seconds) =>
    `El recorrido vuelve a empezar en ${seconds} ${seconds === 1 ? "segundo" : "segundos"}.`,
  here: "Sigo aquí",
  previous: "Anterior",
  next: "Siguiente",
  stop: (number, count) => `Parada ${number} de ${count}`,
  languages: "Idioma",
  layers: "Qué se muestra",
  as_kept: "Vista general",
  records: "Más sobre",
  record: (key) => `N.º ${key}`,
  close: "Cerrar",
  enlarge: (name) => `Ampliar: ${name}`,
  yes: "sí",
  no: "no",
  stage:
    "El objeto en 3D. Con un dedo se gira; con dos se mueve, se amplía y se inclina; un toque cuenta más sobre un lugar.",
  hint: "Gire con un dedo, amplíe con dos. Toque un lugar para saber más.",
  stored: "Imágenes fijas por un momento",
  waiting: "Un momento…",
  worthless: "Esta pantalla ya no tiene recorrido",
  worthless_detail:
    "Su enlace se retiró o ha caducado. Quien cuida la pantalla puede crear otro en Strata.",
  nothing: "Este recorrido aún no tiene nada que mostrar",
  nothing_detail:
    "Quien lo cuida puede dar vistas a sus paradas en Strata. Esta pantalla empezará entonces por sí sola.",
};

const all: Record<PageLanguage, KioskTexts> = { en, de, es };

/**
 * In the language of the tour that was chosen, or else in the first of the tour's that this page is
 * written in, or English.
 */
export const textsIn = (language: string, languages: readonly string[]): KioskTexts =>
  all[pageLanguage(language, languages)];
