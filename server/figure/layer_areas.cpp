#include "figure/layer_areas.h"

#include "core/text/number_text.h"
#include "figure/pattern.h"

namespace strata::figure {
namespace {

// The widths of render/view/drawn_features.h.
constexpr double kLine_mm = 3 * kPatternPixel, kPoint_mm = 10 * kPatternPixel,
                 kCasing_mm = 1.25 * kPatternPixel;

}  // namespace

Group area_group(const LayerVectors& layer) {
  Group group;
  group.id = "areas-" + layer.id;
  group.name = layer.name;
  group.opacity = layer.opacity;
  for (const ClassArea& of_class : layer.areas) {
    Area area{{}, of_class.color, of_class.pattern, of_class.angle, of_class.spacing_mm};
    for (const OutlinePolygon& polygon : of_class.polygons)
      area.rings.insert(area.rings.end(), polygon.rings.begin(), polygon.rings.end());
    Group& part = group.parts.emplace_back();
    part.id = group.id + "-" + short_number(of_class.value);
    part.name = of_class.name;
    part.areas.push_back(std::move(area));
  }
  return group;
}

Group mark_group(const LayerVectors& layer) {
  Group group;
  group.id = "marks-" + layer.id;
  group.name = layer.name;
  group.opacity = layer.opacity;
  for (const RecordMark& mark : layer.marks)
    group.marks.push_back(
        {mark.points, mark.color, mark.points.size() > 1 ? kLine_mm : kPoint_mm, kCasing_mm});
  return group;
}

}  // namespace strata::figure
