#include "figure/cairo_sheet.h"

#include "figure/pango_layout.h"
#include "figure/text.h"

namespace strata::figure {
namespace {

void set_color(cairo_t* context, const Rgba& color) {
  cairo_set_source_rgba(context, color[0] / 255.0, color[1] / 255.0, color[2] / 255.0,
                        color[3] / 255.0);
}

void draw(cairo_t* context, const Path& path) {
  if (path.points.empty()) return;
  cairo_move_to(context, path.points[0].x, path.points[0].y);
  for (std::size_t i = 1; i < path.points.size(); ++i)
    cairo_line_to(context, path.points[i].x, path.points[i].y);
  if (path.closed) cairo_close_path(context);
  if (path.fill) {
    set_color(context, *path.fill);
    cairo_fill_preserve(context);
  }
  if (path.stroke_mm > 0) {
    set_color(context, {0, 0, 0, 255});
    cairo_set_line_width(context, path.stroke_mm);
    cairo_stroke_preserve(context);
  }
  cairo_new_path(context);
}

void draw(cairo_t* context, const Words& words) {
  const Layout layout = make_layout(context, words.text, words.size_mm, words.bold);
  int width = 0, height = 0;
  pango_layout_get_size(layout.get(), &width, &height);
  const double share = words.anchor == Anchor::start ? 0 : words.anchor == Anchor::middle ? 0.5 : 1;
  const double x = words.at.x - share * width / PANGO_SCALE;
  const double y =
      words.at.y - static_cast<double>(pango_layout_get_baseline(layout.get())) / PANGO_SCALE;
  if (words.halo) {
    cairo_move_to(context, x, y);
    pango_cairo_layout_path(context, layout.get());
    set_color(context, {255, 255, 255, 255});
    cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_width(context, words.size_mm * 0.3);
    cairo_stroke(context);
    cairo_set_line_join(context, CAIRO_LINE_JOIN_MITER);
  }
  set_color(context, {0, 0, 0, 255});
  cairo_move_to(context, x, y);
  // On a raster surface, cairo rounds the position of each letter to whole pixels, which is visible
  // in small text. Paths have exact positions.
  if (cairo_surface_get_type(cairo_get_target(context)) == CAIRO_SURFACE_TYPE_IMAGE) {
    pango_cairo_layout_path(context, layout.get());
    cairo_fill(context);
  } else {
    pango_cairo_show_layout(context, layout.get());
  }
}

}  // namespace

void draw_groups(cairo_t* context, const Sheet& sheet) {
  for (const Group& group : sheet.groups)
    for (const Item& item : group.items)
      std::visit([&](const auto& each) { draw(context, each); }, item);
}

}  // namespace strata::figure
