// The rows of the help in German.

import type { HelpTexts } from "./shape";

export const help: HelpTexts = {
  key_names:
    "Strg · Umschalt · Enter · Esc · Rücktaste · Entf · Tab · Leertaste · Pfeile · Pfeiltasten · Auf · Ab · Links · Rechts · Bild · Pos1 · Ende · F2",
  mouse: "Maus",
  touch: "Touch",
  mouse_rows: [
    ["Links ziehen", "aktives Werkzeug anwenden"],
    [
      "Zeiger ruhen lassen (Drehen, Verschieben)",
      "Vorschau des Datensatzes an dieser Stelle; Esc schließt sie",
    ],
    ["Klicken (Drehen, Verschieben)", "Datensatz an dieser Stelle öffnen"],
    ["Rechts ziehen oder Leertaste + links", "drehen"],
    ["Mitte ziehen oder Umschalt + rechts", "verschieben"],
    ["Mausrad", "am Zeiger zoomen"],
  ],
  touch_rows: [
    ["Ein Finger", "aktives Werkzeug anwenden"],
    ["Tippen (Drehen, Verschieben)", "Datensatz an dieser Stelle öffnen"],
    ["Zwei Finger", "ziehen: verschieben; spreizen: zoomen; drehen: im Bild drehen"],
    ["Tippen mit Messen", "Punkt setzen; ziehen dreht das Modell"],
    [
      "Stift",
      "aktives Werkzeug anwenden; Hand und Finger werden ignoriert, solange der Stift in der Nähe ist",
    ],
    ["Ein Finger nach Verwendung eines Stifts", "drehen, auch mit Mal- oder Zeichenwerkzeug"],
  ],
  tool_keys: "Während ein Werkzeug aktiv ist",
  tool_rows: [
    ["Enter · Rücktaste · Esc", "Polygon oder Linie beenden · letzte Ecke entfernen · abbrechen"],
    [
      "Umschalt + A",
      "Polygon oder Linie an Kanten und Rissen ausrichten oder nicht mehr; jeder Klick legt den gezeigten Verlauf fest",
    ],
    [
      "Umschalt + L, dann Striche",
      "Fläche mit Strichen darin und, mit Alt, außerhalb auswählen; Umschalt + L: andere Seite; Strg + Z: Strich zurücknehmen; Enter: Fläche übernehmen",
    ],
    [
      "Polygon, Lasso oder Zauberstab mit Umschalt · Alt",
      "zur Auswahl hinzufügen · von ihr abziehen; beide: Schnittmenge; Rücktaste entfernt den letzten Teil, Enter füllt, Esc verwirft",
    ],
    ["C, dann klicken", "dort kommentieren; Enter: in der Mitte der Ansicht"],
    ["Strg + Enter · Esc", "Kommentar senden · schließen und den Entwurf behalten"],
    [
      "M, dann klicken",
      "Längen, Flächen und Profile messen; erneut M: Punkt in der Mitte; Enter beendet, Esc löscht alle",
    ],
    [
      "I, dann klicken",
      "auf einer Ebene mit Datensätzen: Datensatz an dieser Stelle öffnen und damit malen",
    ],
  ],
  table: "In der Tabelle der Datensätze",
  table_rows: [
    ["Pfeile · Bild · Pos1 · Ende", "zwischen Zellen wechseln; mit Strg: erste, letzte"],
    [
      "Enter, F2 oder erneut klicken",
      "Zelle bearbeiten; auf dem Schlüssel: Formular des Datensatzes öffnen",
    ],
    [
      "Buchstaben und Ziffern",
      "schreiben in Textzellen, Ziffern auch in Zahlen, Datum und Uhrzeit; in anderen Zellen sind sie Tastenkürzel der Seite wie T, D und V; nach Esc immer",
    ],
    [
      "Trichter einer Spalte",
      "nach Werten, Bereich, Text oder fehlenden Werten filtern; das Filterfeld zeigt die Bedingung",
    ],
    [
      "Enter · Tab · Esc",
      "beim Bearbeiten: nach unten · nächste Zelle · abbrechen; Umschalt + Enter: neue Zeile",
    ],
    ["Entf", "Zelle leeren"],
    [
      "Leertaste oder Klick auf einen Schlüssel",
      "Zeile auswählen; mit Strg: weitere, mit Umschalt: einen Bereich",
    ],
    [
      "Strg + Z · Strg + Umschalt + Z",
      "eigene Tabellenänderungen rückgängig machen · wiederherstellen",
    ],
    [
      "⋯ einer Spalte → Ändern",
      "umbenennen, auch in anderen Sprachen; alle sehen den Namen in der Sprache ihres Browsers",
    ],
    ["CSV ablegen", "Vorschau der Änderungen, dann importieren; auf einer Begriffsliste auch SKOS"],
  ],
  brush: "Pinseloptionen",
  brush_rows: [
    [
      "Form",
      "rund, quadratisch oder ein Bild: + wählen oder ein PNG oder JPEG neben den Formen ablegen; alle auf dem Server teilen sie",
    ],
    [
      "Schräge Flächen auslassen ab",
      "lässt Flächen aus, die in flachem Winkel zum Blick liegen; zum Bemalen das Modell drehen",
    ],
    ["Auch verdeckte Flächen bemalen", "malt durch das Objekt hindurch bis zur Rückseite"],
  ],
  terms: "In einer Begriffsliste",
  terms_rows: [
    ["Tippen", "Begriffe nach Namen suchen, in allen Sprachen"],
    ["Auf · Ab · Bild", "zwischen Begriffen wechseln"],
    ["Rechts · Links", "aufklappen · zuklappen"],
    ["Enter", "mit dem Begriff malen"],
    ["Esc", "ganze Liste anzeigen; noch einmal: zurück zum Modell"],
  ],
  layers: "Ebenen ohne Pinsel",
  layer_rows: [
    [
      "Ebenen ⋯ → Aus Vorlage",
      "Begriffslisten, Tabellen und Ebenen für Stein, Wandmalerei, Grabung und Maßnahmen",
    ],
    [
      "Ebenen ⋯ → Begriffsliste importieren",
      "CSV oder SKOS (Turtle, RDF/XML) mit Vorschau; Liste aktualisieren und exportieren im ⋯ ihrer Tabelle",
    ],
    [
      "⋯ einer Ebene → Aus Datei malen",
      "Messwerte, Karten, Shapefiles, GeoTIFF und gescannte Karten; Zahlen für die Eckpunkte des Scans",
    ],
    [
      "Ansicht → Oberflächenbilder → Orthofoto hinzufügen",
      "ein Bild auf die Oberfläche projizieren",
    ],
    [
      "⋯ einer Ebene → Flächen",
      "Flächen der Klassen; bei Messwerten ein Histogramm, das den Farbbereich festlegt",
    ],
    [
      "Neue Ebene → Aus einem Ausdruck",
      "Werte, berechnet aus anderen Ebenen, deren Datensätzen und der Oberfläche",
    ],
    [
      "Neue Ebene → Aus der Geometrie",
      "Werte, berechnet aus dem Netz: Krümmung, Neigung, Abstände",
    ],
    [
      "Ebenen ⋯ → Ebenen übertragen",
      "Kartierung eines früheren Scans des Objekts, mit einem Bericht über Verluste",
    ],
    [
      "Ansicht → Führungen",
      "gespeicherte Ansichten mit Texten in mehreren Sprachen, für einen Bildschirm in einer Ausstellung; Kiosk-Links im ⋯ einer Führung",
    ],
    [
      "Ansicht → Abrechnung",
      "Positionen, die Flächen, Längen und Datensätze nach Regeln zählen; Hoch · Runter bewegen, Rechts · Links öffnen und schließen Gruppen, Enter ändert, Einfg ergänzt, Entf entfernt",
    ],
    [
      "Teile, über der 3D-Ansicht",
      "die Scans eines Modells zeigen und ausblenden, das aus mehreren importiert wurde",
    ],
  ],
};
