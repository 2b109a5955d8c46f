#pragma once

#include <pango/pangocairo.h>

#include <memory>
#include <string>

namespace strata::figure {

struct Unref {
  void operator()(void* object) const { g_object_unref(object); }
};
using Layout = std::unique_ptr<PangoLayout, Unref>;

// Lays out one text in the typeface of the sheet. The unit of the context must be a millimeter.
Layout make_layout(cairo_t* context, const std::string& text, double size_mm, bool bold);

}  // namespace strata::figure
