#include "mesh/repair/scale_proposal.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/io/file_comments.h"
#include "mesh/repair/resting_pose.h"

namespace strata::mesh {
namespace {

// Usual objects of heritage scans, with the range of the longest side and an approximate share.
struct SizeClass {
  double from_m, to_m;
  double share;
};
constexpr SizeClass kSizes[] = {
    {0.005, 0.05, 0.15},  // coins, beads, seals, flakes
    {0.05, 0.6, 0.45},    // vessels, sherds, tablets, masks, busts
    {0.6, 3, 0.20},       // statues, slabs, sarcophagi
    {3, 60, 0.12},        // rooms, façades, buildings, trenches
    {60, 20000, 0.08},    // sites and terrain
};
constexpr double kAnySize = 1e-3;  // per factor of ten outside of these sizes

// Structured light and laser scanners use millimeters, and photogrammetry uses meters.
struct UnitShare {
  Unit unit;
  double share;
};
constexpr UnitShare kUnits[] = {{Unit::mm, 0.45}, {Unit::m, 0.45}, {Unit::cm, 0.10}};

// Returns the probability density of a size over its decimal logarithm.
double plausibility(double size_m) {
  for (const SizeClass& size : kSizes)
    if (size_m >= size.from_m && size_m < size.to_m)
      return size.share / std::log10(size.to_m / size.from_m);
  return kAnySize;
}

struct Box {
  glm::dvec3 low, high;
};
Box box_of(const TriangleMesh& mesh) {
  Box box{glm::dvec3(std::numeric_limits<double>::infinity()),
          glm::dvec3(-std::numeric_limits<double>::infinity())};
  for (const glm::dvec3& position : mesh.positions) {
    box.low = glm::min(box.low, position);
    box.high = glm::max(box.high, position);
  }
  return box;
}

// Returns true for map coordinates. Scans of objects do not have their origin so far away.
bool is_surveyed(const Box& box) {
  constexpr double kFar = 10'000, kFarForItsSize = 5;
  const double away = glm::length((box.low + box.high) / 2.0);
  return away > kFar && away > kFarForItsSize * glm::length(box.high - box.low);
}

void propose_by_size(const Box& box, ScaleProposal& proposal) {
  const glm::dvec3 size = box.high - box.low;
  const double longest = std::max({size.x, size.y, size.z});
  double sum = 0, best = 0;
  for (const UnitShare& each : kUnits) {
    const double likely = each.share * plausibility(longest * metres_per(each.unit));
    sum += likely;
    if (likely <= best) continue;
    best = likely;
    proposal.unit = each.unit;
  }
  proposal.unit_reason = ScaleReason::size;
  proposal.unit_confidence = best / sum;
}

}  // namespace

ScaleProposal propose_scale(const LoadedMesh& loaded, const std::string& crs) {
  constexpr double kSurveyed = 0.95;  // confidence for map coordinates
  ScaleProposal proposal;
  const auto unit = stated_unit(loaded.comments);
  const auto up = stated_up(loaded.comments);
  const Box box = box_of(loaded.mesh);
  const bool surveyed = !crs.empty() || is_surveyed(box);
  // The coordinates of parts are in `loaded.unit`, although files may state others.
  if (unit && (loaded.parts.empty() || loaded.unit == unit->value)) {
    proposal.unit = unit->value;
    proposal.unit_reason = ScaleReason::comment;
    proposal.unit_comment = unit->comment;
  } else if (loaded.unit) {
    proposal.unit = *loaded.unit;
    proposal.unit_reason = ScaleReason::format;
  } else if (surveyed) {
    proposal.unit = Unit::m;
    proposal.unit_reason = ScaleReason::coordinates;
    proposal.unit_confidence = kSurveyed;
  } else {
    propose_by_size(box, proposal);
  }
  if (up) {
    proposal.up = up->value;
    proposal.up_reason = ScaleReason::comment;
    proposal.up_comment = up->comment;
  } else if (!loaded.up.empty()) {
    proposal.up = loaded.up;
    proposal.up_reason = ScaleReason::format;
  } else if (surveyed || !loaded.parts.empty()) {
    proposal.up = "z";
    proposal.up_reason = surveyed ? ScaleReason::coordinates : ScaleReason::parts;
    proposal.up_confidence = kSurveyed;
  } else {
    const auto shares = up_shares(loaded.mesh);
    const auto best = std::ranges::max_element(shares);
    proposal.up = kUpDirections[static_cast<std::size_t>(best - shares.begin())];
    proposal.up_reason = ScaleReason::shape;
    proposal.up_confidence = *best;
  }
  return proposal;
}

}  // namespace strata::mesh
