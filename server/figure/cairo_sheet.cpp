#include "figure/cairo_sheet.h"

#include "figure/area_pattern.h"
#include "figure/pango_layout.h"
#include "figure/pattern.h"
#include "figure/text.h"

namespace strata::figure {
namespace {

constexpr double kFullTurn = 6.283185307179586;

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
  const double x = -share * width / PANGO_SCALE;  // relative to the point on the baseline
  const double y = -static_cast<double>(pango_layout_get_baseline(layout.get())) / PANGO_SCALE;
  cairo_save(context);
  cairo_translate(context, words.at.x, words.at.y);
  cairo_rotate(context, -words.angle / 360 * kFullTurn);
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
  cairo_restore(context);
}

void add_rings(cairo_t* context, const Area& area) {
  cairo_new_path(context);
  for (const auto& ring : area.rings) {
    cairo_new_sub_path(context);
    for (const glm::dvec2& point : ring) cairo_line_to(context, point.x, point.y);
    cairo_close_path(context);
  }
}

// Draws the color of the area, the ground between its lines and its border in the opaque color of
// the area.
void draw_pattern(cairo_t* context, const Area& area) {
  const auto set_ink = [&](double opacity) {
    cairo_set_source_rgba(context, area.color[0] / 255.0, area.color[1] / 255.0,
                          area.color[2] / 255.0, opacity);
  };
  cairo_save(context);
  cairo_set_fill_rule(context, CAIRO_FILL_RULE_EVEN_ODD);
  add_rings(context, area);
  cairo_clip_preserve(context);
  const AreaPattern pattern = pattern_of(area);
  if (area.pattern != Pattern::outline) {
    set_ink(kGround);
    cairo_fill(context);
  }
  set_ink(1);
  cairo_new_path(context);
  for (const auto& [from, to] : pattern.lines) {
    cairo_move_to(context, from.x, from.y);
    cairo_line_to(context, to.x, to.y);
  }
  cairo_set_line_width(context, pattern.width_mm);
  cairo_stroke(context);
  for (const glm::dvec2& dot : pattern.dots) {
    cairo_new_sub_path(context);
    cairo_arc(context, dot.x, dot.y, pattern.radius_mm, 0, kFullTurn);
  }
  cairo_fill(context);
  // The outer half of the line is outside the area.
  add_rings(context, area);
  cairo_set_line_width(context, 2 * kBorder);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  cairo_stroke(context);
  cairo_restore(context);
}

void draw(cairo_t* context, const Area& area) {
  if (area.rings.empty()) return;
  if (area.pattern == Pattern::solid) {
    cairo_save(context);
    cairo_set_fill_rule(context, CAIRO_FILL_RULE_EVEN_ODD);
    add_rings(context, area);
    set_color(context, area.color);
    cairo_fill_preserve(context);
    if (area.color[3] == 255) {
      cairo_set_line_width(context, kTrap_mm);
      cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
      cairo_stroke(context);
    }
    cairo_restore(context);
    cairo_new_path(context);
    return;
  }
  if (area.color[3] < 255) cairo_push_group(context);
  draw_pattern(context, area);
  if (area.color[3] == 255) return;
  cairo_pop_group_to_source(context);
  cairo_paint_with_alpha(context, area.color[3] / 255.0);
}

void draw(cairo_t* context, const Mark& mark) {
  cairo_save(context);
  cairo_set_line_cap(context, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  cairo_new_path(context);
  for (const glm::dvec2& point : mark.points) cairo_line_to(context, point.x, point.y);
  if (mark.points.size() == 1)  // a dot, because of the round cap
    cairo_line_to(context, mark.points[0].x, mark.points[0].y);
  set_color(context, {255, 255, 255, mark.color[3]});
  cairo_set_line_width(context, mark.width_mm + 2 * mark.casing_mm);
  cairo_stroke_preserve(context);
  set_color(context, mark.color);
  cairo_set_line_width(context, mark.width_mm);
  cairo_stroke(context);
  cairo_restore(context);
}

void draw_group(cairo_t* context, const Group& group) {
  cairo_save(context);
  if (group.clip) {
    const auto& [corner, size] = *group.clip;
    cairo_new_path(context);
    cairo_rectangle(context, corner.x, corner.y, size.x, size.y);
    cairo_clip(context);
  }
  if (group.opacity < 1) cairo_push_group(context);
  for (const Item& item : group.items)
    std::visit([&](const auto& each) { draw(context, each); }, item);
  for (const Area& area : group.areas) draw(context, area);
  for (const Mark& mark : group.marks) draw(context, mark);
  for (const Group& part : group.parts) draw_group(context, part);
  if (group.opacity < 1) {
    cairo_pop_group_to_source(context);
    cairo_paint_with_alpha(context, group.opacity);
  }
  cairo_restore(context);
}

}  // namespace

void draw_groups(cairo_t* context, const Sheet& sheet) {
  for (const Group& group : sheet.groups) draw_group(context, group);
}

}  // namespace strata::figure
