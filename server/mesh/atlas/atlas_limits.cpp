#include "mesh/atlas/atlas_limits.h"

#include <algorithm>
#include <cmath>

namespace strata::mesh {
namespace {

// as a share of the atlas side; a chart at least this long keeps the other charts small
constexpr double kNearlyAll = 0.9;
constexpr double kThin = 0.25;  // width over length
constexpr double kMuch = 0.15;  // share of the atlas

}  // namespace

std::vector<AtlasReport::Limit> limits_of_packing(std::span<const Outline> outlines,
                                                  const Packing& packing, int side, int gap,
                                                  double coverage) {
  if (coverage >= kPromisedCoverage) return {};
  bool is_long = false;
  double boxes = 0, margins = 0;
  for (const Outline& outline : outlines) {
    const glm::dvec2 size = glm::dvec2(outline.size) * packing.texels_per_unit;
    const auto [narrow, wide] = std::minmax(size.x, size.y);
    is_long |= wide >= kNearlyAll * side && narrow <= kThin * wide;
    boxes += size.x * size.y;
    margins += gap * (size.x + size.y + gap);
  }
  const double atlas = double(side) * side, hollow = std::max(0.0, boxes / atlas - coverage),
               lost = margins / atlas;
  const auto percent = [](double share) { return std::to_string(std::lround(100 * share)) + " %"; };
  const AtlasReport::Limit too_long{
      "long_triangles",
      "The longest part is as long as the texture is wide. It sets the scale of all "
      "other parts. Long triangles cannot be cut."};
  const AtlasReport::Limit many{"many_charts", "The surface consists of " +
                                                   std::to_string(outlines.size()) +
                                                   " parts. The margins around them take " +
                                                   percent(lost) + " of the texture."};
  const AtlasReport::Limit empty{"hollow_charts",
                                 "Parts with holes, bays or slanted rims leave " + percent(hollow) +
                                     " of the texture empty inside the rectangles around them."};
  std::vector<AtlasReport::Limit> limits;
  if (is_long) limits.push_back(too_long);
  const bool margins_first = lost >= hollow;
  if (std::max(lost, hollow) >= kMuch || limits.empty())
    limits.push_back(margins_first ? many : empty);
  if (std::min(lost, hollow) >= kMuch) limits.push_back(margins_first ? empty : many);
  return limits;
}

std::vector<AtlasReport::Limit> limits_of_file(double coverage) {
  if (coverage >= kPromisedCoverage) return {};
  return {{"file_coordinates",
           "The texture coordinates of the file were kept. They leave part of the texture empty."}};
}

}  // namespace strata::mesh
