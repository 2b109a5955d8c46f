#pragma once

#include <pango/pangocairo.h>

#include <memory>
#include <string>

namespace strata::figure {

struct Unref {
  void operator()(void* object) const { g_object_unref(object); }
};
using Layout = std::unique_ptr<PangoLayout, Unref>;

// Lays out one text in the sheet's typeface; a unit of the context is a millimeter.
Layout make_layout(cairo_t* context, const std::string& text, double size_mm, bool bold);

}  // namespace strata::figure
