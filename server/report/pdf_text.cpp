#include "report/pdf_text.h"

#include <algorithm>

namespace strata::report {
namespace {

// Liberation Sans has the widths of Arial, which the .docx files use. Pango takes missing letters
// from other fonts of the system.
constexpr const char* kTypefaces = "Liberation Sans, DejaVu Sans";

struct FreeFont {
  void operator()(PangoFontDescription* font) const { pango_font_description_free(font); }
};
struct FreeOptions {
  void operator()(cairo_font_options_t* options) const { cairo_font_options_destroy(options); }
};
struct UnrefAttributes {
  void operator()(PangoAttrList* list) const { pango_attr_list_unref(list); }
};
struct FreeIterator {
  void operator()(PangoLayoutIter* iterator) const { pango_layout_iter_free(iterator); }
};

double from_pango(int length) { return static_cast<double>(length) / PANGO_SCALE; }

PangoAlignment pango_alignment(Alignment alignment) {
  switch (alignment) {
    case Alignment::start: return PANGO_ALIGN_LEFT;
    case Alignment::middle: return PANGO_ALIGN_CENTER;
    case Alignment::end: return PANGO_ALIGN_RIGHT;
  }
  return PANGO_ALIGN_LEFT;
}

void insert(PangoAttrList* list, PangoAttribute* attribute, std::size_t begin, std::size_t end) {
  attribute->start_index = static_cast<guint>(begin);
  attribute->end_index = static_cast<guint>(end);
  pango_attr_list_insert(list, attribute);
}

}  // namespace

PdfText::PdfText(cairo_t* context, const std::vector<Run>& runs, const TextStyle& style,
                 const std::string& language, double width, Alignment alignment)
    : context_(context), color_(style.color), layout_(pango_cairo_create_layout(context)) {
  PangoLayout* layout = layout_.get();
  PangoContext* pango = pango_layout_get_context(layout);
  const std::unique_ptr<PangoFontDescription, FreeFont> font(pango_font_description_new());
  pango_font_description_set_family(font.get(), kTypefaces);
  pango_font_description_set_weight(font.get(),
                                    style.bold ? PANGO_WEIGHT_BOLD : PANGO_WEIGHT_NORMAL);
  pango_font_description_set_absolute_size(font.get(), style.size_pt * PANGO_SCALE);
  pango_layout_set_font_description(layout, font.get());
  // Disables hinting and rounding, which are for pixels.
  const std::unique_ptr<cairo_font_options_t, FreeOptions> options(cairo_font_options_create());
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  pango_cairo_context_set_font_options(pango, options.get());
  pango_context_set_round_glyph_positions(pango, FALSE);
  pango_context_set_language(pango, pango_language_from_string(language.c_str()));
  pango_layout_context_changed(layout);

  std::string text;
  const std::unique_ptr<PangoAttrList, UnrefAttributes> attributes(pango_attr_list_new());
  for (const Run& run : runs) {
    const std::size_t begin = text.size();
    text += run.text;
    if (run.bold)
      insert(attributes.get(), pango_attr_weight_new(PANGO_WEIGHT_BOLD), begin, text.size());
    if (run.italic)
      insert(attributes.get(), pango_attr_style_new(PANGO_STYLE_ITALIC), begin, text.size());
  }
  // A hyphen inside a long number or address would change it.
  insert(attributes.get(), pango_attr_insert_hyphens_new(FALSE), 0, text.size());
  pango_layout_set_attributes(layout, attributes.get());
  pango_layout_set_text(layout, text.data(), static_cast<int>(text.size()));
  pango_layout_set_width(layout, std::max(1, static_cast<int>(width * PANGO_SCALE)));
  pango_layout_set_wrap(layout, PANGO_WRAP_WORD_CHAR);
  pango_layout_set_alignment(layout, pango_alignment(alignment));
  pango_layout_set_line_spacing(layout, static_cast<float>(style.line_spacing));
  if (text.empty()) return;
  const std::unique_ptr<PangoLayoutIter, FreeIterator> iterator(pango_layout_get_iter(layout));
  do {
    PangoRectangle extents;
    pango_layout_iter_get_line_extents(iterator.get(), nullptr, &extents);
    int top = 0, bottom = 0;
    pango_layout_iter_get_line_yrange(iterator.get(), &top, &bottom);
    lines_.push_back({pango_layout_iter_get_line_readonly(iterator.get()), from_pango(extents.x),
                      from_pango(top), from_pango(bottom),
                      from_pango(pango_layout_iter_get_baseline(iterator.get()))});
  } while (pango_layout_iter_next_line(iterator.get()));
}

double PdfText::height_between(std::size_t begin, std::size_t end) const {
  return begin >= end ? 0 : lines_[end - 1].bottom - lines_[begin].top;
}

std::size_t PdfText::fitting(std::size_t begin, double height) const {
  std::size_t end = begin;
  while (end < lines_.size() && height_between(begin, end + 1) <= height) ++end;
  return end - begin;
}

void PdfText::draw(double x, double y, std::size_t begin, std::size_t end) const {
  cairo_set_source_rgb(context_, color_[0] / 255.0, color_[1] / 255.0, color_[2] / 255.0);
  for (std::size_t i = begin; i < end; ++i) {
    cairo_move_to(context_, x + lines_[i].x, y + lines_[i].baseline - lines_[begin].top);
    pango_cairo_show_layout_line(context_, lines_[i].line);
  }
}

}  // namespace strata::report
