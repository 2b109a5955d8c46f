#include "app/reports/report_words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/records/readable_area.h"

namespace strata::app {
namespace {

constexpr ReportWords kEnglish{
    .tag = "en",
    .decimal = ".",
    .report = "Condition report",
    .provisional = "Provisional",
    .reduced = "Reduced to {percent} % of its size.",
    .object = "Object",
    .condition = "Condition",
    .figures = "Measured drawings",
    .quantities = "Legend and quantities",
    .findings = "Findings",
    .measures = "Recommended measures",
    .methods = "Methods",
    .provenance = "Provenance of the data",
    .author = "Author",
    .date = "Date",
    .inventory_number = "Inventory number",
    .owner = "Owner",
    .creator = "Scan made by",
    .captured = "Scan made on",
    .method = "Method of the scan",
    .accuracy = "Accuracy",
    .processing = "Processing",
    .survey_date = "Survey",
    .coordinates = "Coordinate system",
    .dimensions = "Size (x × y × z)",
    .surface = "Surface",
    .triangles = "Triangles of the mesh",
    .credit = "Credit",
    .license = "Rights",
    .unverified = "The size of the model has not been confirmed. Lengths and areas can be wrong.",
    .top = "Top",
    .bottom = "Bottom",
    .front = "Front",
    .back = "Back",
    .left = "Left",
    .right = "Right",
    .class_name = "Class",
    .pieces = "Pieces",
    .area = "Area",
    .share = "Share of the surface",
    .total = "Total",
    .largest_classes = "The {} largest of {} classes. The total includes all classes.",
    .nothing_painted = "Nothing is painted on this layer.",
    .from_to = "from {} to {}",
    .from = "from {}",
    .below = "below {}",
    .all_values = "all values",
    .record = "Record {}",
    .length = "Length",
    .points = "Points",
    .place = "Place on the surface",
    .omitted = "{} of {} records are shown.",
    .not_shown = "{} (this picture cannot be shown)",
    .yes = "yes",
    .no = "no",
    .method_text =
        "The mappings are drawn on the surface of the three-dimensional model. Areas are those of "
        "the surface, and not of a projection. Drawings are without perspective and to scale.",
    .layer = "Layer",
    .resolution = "Resolution",
    .texel = "Mean area of a texel",
    .origin = "Origin",
    .painted = "painted",
    .computed = "computed: {}",
    .from_shape = "computed from the shape of the model",
    .analysis = "analysis “{}”",
    .edited_by_hand = "edited by hand afterwards",
    .state_text = "State of the layers: edit {} of the model, {}.",
    .file = "File of the scan",
    .bytes = "Bytes",
    .sha256 = "SHA-256",
    .repairs = "Repairs at the import",
    .last_edit = "Last edit",
};

constexpr ReportWords kGerman{
    .tag = "de",
    .decimal = ",",
    .report = "Zustandsbericht",
    .provisional = "Vorläufig",
    .reduced = "Auf {percent} % der Größe verkleinert.",
    .object = "Objekt",
    .condition = "Zustand",
    .figures = "Maßstäbliche Zeichnungen",
    .quantities = "Legende und Mengen",
    .findings = "Befunde",
    .measures = "Empfohlene Maßnahmen",
    .methods = "Methoden",
    .provenance = "Herkunft der Daten",
    .author = "Bearbeitung",
    .date = "Datum",
    .inventory_number = "Inventarnummer",
    .owner = "Eigentum",
    .creator = "Scan von",
    .captured = "Scan vom",
    .method = "Aufnahmeverfahren",
    .accuracy = "Genauigkeit",
    .processing = "Verarbeitung",
    .survey_date = "Aufnahme",
    .coordinates = "Koordinatensystem",
    .dimensions = "Größe (x × y × z)",
    .surface = "Oberfläche",
    .triangles = "Dreiecke des Netzes",
    .credit = "Nachweis",
    .license = "Rechte",
    .unverified =
        "Die Größe des Modells wurde nicht bestätigt. Längen und Flächen können falsch sein.",
    .top = "Oben",
    .bottom = "Unten",
    .front = "Vorderseite",
    .back = "Rückseite",
    .left = "Links",
    .right = "Rechts",
    .class_name = "Klasse",
    .pieces = "Stücke",
    .area = "Fläche",
    .share = "Anteil an der Oberfläche",
    .total = "Summe",
    .largest_classes = "Die {} größten von {} Klassen. Die Summe enthält alle Klassen.",
    .nothing_painted = "Auf dieser Ebene ist nichts gemalt.",
    .from_to = "von {} bis {}",
    .from = "ab {}",
    .below = "unter {}",
    .all_values = "alle Werte",
    .record = "Datensatz {}",
    .length = "Länge",
    .points = "Punkte",
    .place = "Ort auf der Oberfläche",
    .omitted = "{} von {} Datensätzen sind dargestellt.",
    .not_shown = "{} (dieses Bild kann nicht gezeigt werden)",
    .yes = "ja",
    .no = "nein",
    .method_text =
        "Die Kartierungen sind auf die Oberfläche des dreidimensionalen Modells gezeichnet. "
        "Flächen sind die der Oberfläche und nicht die einer Projektion. Die Zeichnungen sind "
        "ohne Perspektive und maßstäblich.",
    .layer = "Ebene",
    .resolution = "Auflösung",
    .texel = "Mittlere Fläche eines Texels",
    .origin = "Herkunft",
    .painted = "gemalt",
    .computed = "berechnet: {}",
    .from_shape = "aus der Form des Modells berechnet",
    .analysis = "Auswertung „{}“",
    .edited_by_hand = "danach von Hand bearbeitet",
    .state_text = "Stand der Ebenen: Bearbeitung {} des Modells, {}.",
    .file = "Datei des Scans",
    .bytes = "Bytes",
    .sha256 = "SHA-256",
    .repairs = "Korrekturen beim Import",
    .last_edit = "Letzte Bearbeitung",
};

constexpr ReportWords kSpanish{
    .tag = "es",
    .decimal = ",",
    .report = "Informe de estado de conservación",
    .provisional = "Provisional",
    .reduced = "Reducido al {percent} % de su tamaño.",
    .object = "Objeto",
    .condition = "Estado de conservación",
    .figures = "Dibujos a escala",
    .quantities = "Leyenda y cantidades",
    .findings = "Hallazgos",
    .measures = "Medidas recomendadas",
    .methods = "Métodos",
    .provenance = "Procedencia de los datos",
    .author = "Autoría",
    .date = "Fecha",
    .inventory_number = "Número de inventario",
    .owner = "Propiedad",
    .creator = "Escaneo realizado por",
    .captured = "Fecha del escaneo",
    .method = "Método de escaneo",
    .accuracy = "Precisión",
    .processing = "Procesamiento",
    .survey_date = "Levantamiento",
    .coordinates = "Sistema de coordenadas",
    .dimensions = "Tamaño (x × y × z)",
    .surface = "Superficie",
    .triangles = "Triángulos de la malla",
    .credit = "Crédito",
    .license = "Derechos",
    .unverified =
        "El tamaño del modelo no se ha confirmado. Las longitudes y áreas pueden ser erróneas.",
    .top = "Arriba",
    .bottom = "Abajo",
    .front = "Frente",
    .back = "Parte trasera",
    .left = "Izquierda",
    .right = "Derecha",
    .class_name = "Clase",
    .pieces = "Piezas",
    .area = "Área",
    .share = "Parte de la superficie",
    .total = "Total",
    .largest_classes = "Las {} clases mayores de {}. El total incluye todas las clases.",
    .nothing_painted = "No hay nada pintado en esta capa.",
    .from_to = "de {} a {}",
    .from = "desde {}",
    .below = "menos de {}",
    .all_values = "todos los valores",
    .record = "Registro {}",
    .length = "Longitud",
    .points = "Puntos",
    .place = "Lugar en la superficie",
    .omitted = "Se muestran {} de {} registros.",
    .not_shown = "{} (esta imagen no se puede mostrar)",
    .yes = "sí",
    .no = "no",
    .method_text =
        "Los mapeos están dibujados sobre la superficie del modelo tridimensional. Las áreas son "
        "las de la superficie y no las de una proyección. Los dibujos están a escala y sin "
        "perspectiva.",
    .layer = "Capa",
    .resolution = "Resolución",
    .texel = "Área media de un téxel",
    .origin = "Origen",
    .painted = "pintada",
    .computed = "calculada: {}",
    .from_shape = "calculada a partir de la forma del modelo",
    .analysis = "análisis «{}»",
    .edited_by_hand = "editada después a mano",
    .state_text = "Estado de las capas: edición {} del modelo, {}.",
    .file = "Archivo del escaneo",
    .bytes = "Bytes",
    .sha256 = "SHA-256",
    .repairs = "Correcciones al importar",
    .last_edit = "Última edición",
};

}  // namespace

const ReportWords& words_in(ReportLanguage language) {
  switch (language) {
    case ReportLanguage::en: return kEnglish;
    case ReportLanguage::de: return kGerman;
    case ReportLanguage::es: return kSpanish;
  }
  return kEnglish;
}

std::string filled(const char* text, const std::string& part) {
  std::string whole = text;
  if (const auto at = whole.find("{}"); at != std::string::npos) whole.replace(at, 2, part);
  return whole;
}

std::string filled(const char* text, const std::string& first, const std::string& second) {
  const std::string whole = text;
  const auto at = whole.find("{}") + 2;
  return filled(whole.substr(0, at).c_str(), first) + filled(whole.substr(at).c_str(), second);
}

std::string number_in(const ReportWords& words, double value) {
  constexpr int kDigits = 4, kMostDecimals = 9;
  const int before = value == 0 ? 1 : static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  const int decimals = std::clamp(kDigits - before, 0, kMostDecimals);
  char text[512];  // the largest numbers have 309 digits
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  std::string number = text;
  if (number.find('.') != std::string::npos) {
    number.erase(number.find_last_not_of('0') + 1);
    if (number.back() == '.') number.pop_back();
  }
  if (const auto point = number.find('.'); point != std::string::npos)
    number.replace(point, 1, words.decimal);
  return number;
}

std::string area_in(const ReportWords& words, double area_m2) {
  const AreaUnit unit = readable_area(area_m2);
  return number_in(words, area_m2 * unit.per_m2) + " " + unit.name;
}

std::string length_in(const ReportWords& words, double length_m) {
  const double size = std::abs(length_m);
  if (size < 0.1) return number_in(words, length_m * 1000) + " mm";
  return size < 1 ? number_in(words, length_m * 100) + " cm" : number_in(words, length_m) + " m";
}

}  // namespace strata::app
