#include "figure/layer_areas.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>

#include "figure/pattern.h"

namespace strata::figure {
namespace {

// The widths of render/view/drawn_features.h.
constexpr double kLine_mm = 3 * kPatternPixel, kPoint_mm = 10 * kPatternPixel,
                 kCasing_mm = 1.25 * kPatternPixel;

// Returns the number with all its digits and without an exponent, because ids must be unique.
std::string plain_number(double value) {
  std::array<char, 400> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  return {digits.data(), end.ptr};
}

Group group_of(const char* content, const LayerVectors& layer, const Box& drawing) {
  Group group;
  group.id = content + ("-" + layer.id);
  group.name = layer.name;
  group.opacity = layer.opacity;
  group.clip = drawing;
  return group;
}

}  // namespace

Group area_group(LayerVectors layer, const Box& drawing) {
  Group group = group_of("areas", layer, drawing);
  for (ClassArea& of_class : layer.areas) {
    Area area{{}, of_class.color, of_class.pattern, of_class.angle, of_class.spacing_mm};
    for (OutlinePolygon& polygon : of_class.polygons)
      std::ranges::move(polygon.rings, std::back_inserter(area.rings));
    Group& part = group.parts.emplace_back();
    part.id = group.id + "-" + plain_number(of_class.value);
    part.name = std::move(of_class.name);
    part.areas.push_back(std::move(area));
  }
  return group;
}

Group mark_group(LayerVectors layer, const Box& drawing) {
  Group group = group_of("marks", layer, drawing);
  for (RecordMark& mark : layer.marks) {
    const double width = mark.points.size() > 1 ? kLine_mm : kPoint_mm;
    group.marks.push_back({std::move(mark.points), mark.color, width, kCasing_mm});
  }
  return group;
}

}  // namespace strata::figure
