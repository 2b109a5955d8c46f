#include "figure/text.h"

#include <algorithm>

#include "figure/cairo_owners.h"
#include "figure/pango_layout.h"

namespace strata::figure {
namespace {

// Letters are enlarged by this factor for measuring. Pango rounds to its units, 1024 per point, so
// large letters reduce the error.
constexpr double kMeasured = 100;
constexpr const char* kCut = " …";  // at the end of a text that was cut

// Makes a context that is used for measuring only.
CairoContext measuring_context() {
  const CairoSurface surface(cairo_recording_surface_create(CAIRO_CONTENT_COLOR, nullptr));
  return CairoContext(cairo_create(surface.get()));
}

}  // namespace

Layout make_layout(cairo_t* context, const std::string& text, double size_mm, bool bold) {
  Layout layout(pango_cairo_create_layout(context));
  std::unique_ptr<PangoFontDescription, decltype(&pango_font_description_free)> font(
      pango_font_description_new(), pango_font_description_free);
  pango_font_description_set_family(font.get(), kTypeface);
  pango_font_description_set_weight(font.get(), bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
  pango_font_description_set_absolute_size(font.get(), size_mm * PANGO_SCALE);
  pango_layout_set_font_description(layout.get(), font.get());
  // Disables hinting, which is for pixels.
  std::unique_ptr<cairo_font_options_t, decltype(&cairo_font_options_destroy)> options(
      cairo_font_options_create(), cairo_font_options_destroy);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  pango_cairo_context_set_font_options(pango_layout_get_context(layout.get()), options.get());
  // Disables the rounding of letter positions to whole units, which are millimeters here.
  pango_context_set_round_glyph_positions(pango_layout_get_context(layout.get()), FALSE);
  pango_layout_context_changed(layout.get());
  pango_layout_set_text(layout.get(), text.data(), static_cast<int>(text.size()));
  return layout;
}

double width_mm(const std::string& text, double size_mm, bool bold) {
  const auto context = measuring_context();
  const Layout layout = make_layout(context.get(), text, size_mm * kMeasured, bold);
  int width = 0, height = 0;
  pango_layout_get_size(layout.get(), &width, &height);
  return static_cast<double>(width) / PANGO_SCALE / kMeasured;
}

std::vector<std::string> wrapped(const std::string& text, double size_mm, bool bold,
                                 double width_mm, int most_lines) {
  std::vector<std::string> lines;
  if (text.empty() || most_lines < 1) return lines;
  const auto context = measuring_context();
  const Layout layout = make_layout(context.get(), text, size_mm * kMeasured, bold);
  pango_layout_set_width(layout.get(), static_cast<int>(width_mm * kMeasured * PANGO_SCALE));
  pango_layout_set_wrap(layout.get(), PANGO_WRAP_WORD_CHAR);
  const int count = pango_layout_get_line_count(layout.get());
  for (int i = 0; i < count && i < most_lines; ++i) {
    const PangoLayoutLine* line = pango_layout_get_line_readonly(layout.get(), i);
    std::string words = text.substr(static_cast<std::size_t>(line->start_index),
                                    static_cast<std::size_t>(line->length));
    while (!words.empty() && (words.back() == ' ' || words.back() == '\n' || words.back() == '\r'))
      words.pop_back();
    lines.push_back(std::move(words));
  }
  if (count > most_lines) lines.back() += kCut;
  return lines;
}

std::vector<std::string> fitted(const std::string& text, double size_mm, bool bold, double width_mm,
                                int most_lines) {
  auto lines = wrapped(text, size_mm, bold, width_mm, most_lines);
  if (lines.empty() || figure::width_mm(lines.back(), size_mm, bold) <= width_mm) return lines;
  const double room_mm = width_mm - figure::width_mm(kCut, size_mm, bold);
  lines.back() = wrapped(lines.back(), size_mm, bold, std::max(1.0, room_mm), 1).front();
  return lines;
}

}  // namespace strata::figure
