#pragma once

#include <string>

namespace strata::app {

// The languages of reports. The order is that of the API.
enum class ReportLanguage { en, de, es };

// The words that a report adds to the user's texts. A number or name replaces "{}".
struct ReportWords {
  const char *tag, *decimal;  // BCP 47, and the decimal point or comma
  const char *report, *provisional, *reduced;
  // Headings of the sections.
  const char *object, *condition, *figures, *quantities, *findings, *measures, *methods,
      *provenance;
  // Title block and object.
  const char *author, *date, *inventory_number, *owner, *creator, *captured, *method, *accuracy,
      *processing, *survey_date, *coordinates, *dimensions, *surface, *triangles, *credit, *license,
      *unverified;
  // Directions of figures.
  const char *top, *bottom, *front, *back, *left, *right;
  // Quantities.
  const char *class_name, *pieces, *area, *share, *total, *largest_classes, *nothing_painted,
      *from_to, *from, *below, *all_values;
  // Findings.
  const char *record, *length, *points, *place, *omitted, *not_shown, *yes, *no;
  // Methods.
  const char *method_text, *layer, *resolution, *texel, *origin, *painted, *computed, *from_shape,
      *analysis, *edited_by_hand;
  // Provenance.
  const char *state_text, *file, *bytes, *sha256, *repairs, *last_edit;
};

const ReportWords& words_in(ReportLanguage language);

// Replaces the first "{}" of a text.
std::string filled(const char* text, const std::string& part);
std::string filled(const char* text, const std::string& first, const std::string& second);

// Formats a number without an exponent, in the language. Rounds it to four significant digits, but
// not to less than a whole number.
std::string number_in(const ReportWords& words, double value);
// Formats an area in the unit of `readable_area`.
std::string area_in(const ReportWords& words, double area_m2);
// Formats a length in mm, cm or m.
std::string length_in(const ReportWords& words, double length_m);

}  // namespace strata::app
