// Texts of the kiosk's own buttons and signs. The tour contains the texts of the stops, in
// languages that this page may not support.

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
  media: "Pictures, sound and video",
  play: "Play",
  pause: "Pause",
  position: "Position",
  play_of: (name: string) => `Play: ${name}`,
  not_playable: "This is not available at the moment.",
  phone: "On your phone",
  phone_code: "QR code: this tour on your phone",
  yes: "yes",
  no: "no",
  stage:
    "The object in 3D. Use one finger to turn it, two fingers to move, zoom and tilt it. Tap a place to learn more.",
  hint: "Turn with one finger, zoom with two. Tap a place to learn more.",
  stored: "Only still pictures at the moment",
  waiting: "One moment …",
  worthless: "This screen no longer has a tour",
  worthless_detail: "Its link was revoked or has expired. Create a new link in Strata.",
  nothing: "This tour has nothing to show yet",
  nothing_detail: "Add views to its stops in Strata. This screen then starts automatically.",
};
export type KioskTexts = typeof en;

const de: KioskTexts = {
  begin: "Zum Starten berühren",
  still_there: "Sind Sie noch da?",
  begins_anew: (seconds) =>
    `Die Führung beginnt in ${seconds} ${seconds === 1 ? "Sekunde" : "Sekunden"} von vorn.`,
  here: "Ich bin noch da",
  previous: "Zurück",
  next: "Weiter",
  stop: (number, count) => `Station ${number} von ${count}`,
  languages: "Sprache",
  layers: "Ebenen",
  as_kept: "Überblick",
  records: "Mehr über",
  record: (key) => `Nr. ${key}`,
  close: "Schließen",
  enlarge: (name) => `Vergrößern: ${name}`,
  media: "Bilder, Ton und Video",
  play: "Abspielen",
  pause: "Pause",
  position: "Position",
  play_of: (name) => `Abspielen: ${name}`,
  not_playable: "Das ist im Moment nicht verfügbar.",
  phone: "Auf Ihrem Telefon",
  phone_code: "QR-Code: diese Führung auf Ihrem Telefon",
  yes: "ja",
  no: "nein",
  stage:
    "Das Objekt in 3D. Ein Finger dreht es, zwei Finger verschieben, vergrößern und neigen es. Tippen Sie auf eine Stelle, um mehr zu erfahren.",
  hint: "Mit einem Finger drehen, mit zwei Fingern vergrößern. Tippen Sie auf eine Stelle, um mehr zu erfahren.",
  stored: "Vorübergehend nur Standbilder",
  waiting: "Einen Moment …",
  worthless: "Dieser Bildschirm hat keine Führung mehr",
  worthless_detail:
    "Sein Link wurde widerrufen oder ist abgelaufen. Erstellen Sie in Strata einen neuen Link.",
  nothing: "Diese Führung hat noch nichts zu zeigen",
  nothing_detail:
    "Fügen Sie den Stationen in Strata Ansichten hinzu. Dieser Bildschirm startet dann automatisch.",
};

const es: KioskTexts = {
  begin: "Toque para empezar",
  still_there: "¿Sigue ahí?",
  begins_anew: (seconds) =>
    `El recorrido se reiniciará en ${seconds} ${seconds === 1 ? "segundo" : "segundos"}.`,
  here: "Sigo aquí",
  previous: "Anterior",
  next: "Siguiente",
  stop: (number, count) => `Parada ${number} de ${count}`,
  languages: "Idioma",
  layers: "Capas",
  as_kept: "Vista general",
  records: "Más sobre",
  record: (key) => `N.º ${key}`,
  close: "Cerrar",
  enlarge: (name) => `Ampliar: ${name}`,
  media: "Imágenes, sonido y vídeo",
  play: "Reproducir",
  pause: "Pausa",
  position: "Posición",
  play_of: (name) => `Reproducir: ${name}`,
  not_playable: "No está disponible en este momento.",
  phone: "En su teléfono",
  phone_code: "Código QR: este recorrido en su teléfono",
  yes: "sí",
  no: "no",
  stage:
    "El objeto en 3D. Use un dedo para girarlo y dos para moverlo, ampliarlo e inclinarlo. Toque un lugar para saber más.",
  hint: "Gire con un dedo, amplíe con dos. Toque un lugar para saber más.",
  stored: "Imágenes fijas por un momento",
  waiting: "Un momento…",
  worthless: "Esta pantalla ya no tiene recorrido",
  worthless_detail: "Su enlace se ha revocado o ha caducado. Cree un enlace nuevo en Strata.",
  nothing: "Este recorrido todavía no tiene nada que mostrar",
  nothing_detail:
    "Añada vistas a sus paradas en Strata. Esta pantalla empezará entonces automáticamente.",
};

const all: Record<PageLanguage, KioskTexts> = { en, de, es };

/**
 * Returns the texts in the chosen language. If this page does not support it, returns the texts in
 * the first of the tour's languages that this page supports, or in English.
 */
export const textsIn = (language: string, languages: readonly string[]): KioskTexts =>
  all[pageLanguage(language, languages)];
