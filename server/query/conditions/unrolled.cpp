#include "query/conditions/unrolled.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "mesh/parallel.h"
#include "mesh/texels/surface_map.h"

namespace strata::query {
namespace {

using mesh::DevelopedSurface;
using mesh::kTurn;
using mesh::RolloutSheet;

class Unrolled {
 public:
  Unrolled(const mesh::SurfaceMap& map, const mesh::RolloutRays& rays, const glm::dvec3& origin,
           const mesh::SheetArea& area)
      : map_(map),
        rays_(rays),
        sheet_(rays.sheet()),
        origin_(origin),
        area_(area),
        half_((sheet_.to - sheet_.from) / 2 + mesh::kAngleRounding),
        beyond_cut_(sheet_.beyond_cut()) {}

  std::uint64_t texels_of(std::uint32_t slot) const {
    std::uint64_t texels = 0;
    if (map_.surface_mask[slot] == 0 || is_far(slot)) return texels;
    for (std::uint64_t left = map_.surface_mask[slot]; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      if (belongs(map_.position(slot, i))) texels |= std::uint64_t{1} << i;
    }
    return texels;
  }

 private:
  // Calls visit(point on the plane, distance in radians from the middle of the sheet) for a place
  // and for the same place one turn further in both directions, until a call returns true.
  template <class Visit>
  bool any_turn(const DevelopedSurface::Place& place, const Visit& visit) const {
    const double middle = sheet_.middle(),
                 from_middle = std::remainder(place.angle - middle, kTurn);
    for (const double turned : {from_middle, from_middle - kTurn, from_middle + kTurn})
      if (visit(sheet_.on_sheet({middle + turned, place.slant}), std::abs(turned))) return true;
    return false;
  }

  // Returns true only if no texel of the slot can be in the area.
  bool is_far(std::uint32_t slot) const {
    const mesh::BoundingSphere& ball = map_.bounds_of_slot[slot];
    const glm::dvec3 center = origin_ + glm::dvec3(ball.center);
    const DevelopedSurface& surface = sheet_.surface;
    const auto place = surface.place_of(center);
    const glm::dvec3 from_point = center - surface.point;
    const double to_axis =
        glm::length(from_point - glm::dot(from_point, surface.axis) * surface.axis);
    if (!(to_axis > ball.radius)) return false;
    // Within the ball, the slant differs by at most its radius, and the angle by at most this.
    const double angle = std::asin(ball.radius / to_axis);
    const double reach = (surface.max_stretch(place.slant) + ball.radius) * angle + ball.radius;
    const glm::dvec2 low = area_.low() - reach, high = area_.high() + reach;
    return !any_turn(place, [&](const glm::dvec2& point, double) {
      return point.x >= low.x && point.y >= low.y && point.x <= high.x && point.y <= high.y;
    });
  }

  bool belongs(const glm::vec3& position) const {
    const auto place = sheet_.surface.place_of(origin_ + glm::dvec3(position));
    if (place.slant < sheet_.slant_from || place.slant > sheet_.slant_to) return false;
    if (std::abs(std::remainder(place.angle - sheet_.middle(), kTurn)) > half_) return false;
    const bool is_inside = any_turn(place, [&](const glm::dvec2& point, double from_middle) {
      return from_middle <= half_ + beyond_cut_ && area_.contains(point);
    });
    return is_inside && rays_.sees(position, {place.angle, place.slant});
  }

  const mesh::SurfaceMap& map_;
  const mesh::RolloutRays& rays_;
  const RolloutSheet& sheet_;
  const glm::dvec3 origin_;
  const mesh::SheetArea& area_;
  const double half_, beyond_cut_;  // radians
};

}  // namespace

TexelSelection select_unrolled(const mesh::SurfaceMap& map, const mesh::RolloutRays& rays,
                               const glm::dvec3& origin, const mesh::SheetArea& area, int threads) {
  constexpr std::size_t kSlotsAtOnce = 256;
  const Unrolled unrolled(map, rays, origin, area);
  TexelSelection selection(map.block_of_slot.size(), 0);
  const auto parts = static_cast<int>((selection.size() + kSlotsAtOnce - 1) / kSlotsAtOnce);
  mesh::parallel_for(threads, parts, [&](int part) {
    const std::size_t first = static_cast<std::size_t>(part) * kSlotsAtOnce,
                      last = std::min(selection.size(), first + kSlotsAtOnce);
    for (std::size_t slot = first; slot < last; ++slot)
      selection[slot] = unrolled.texels_of(static_cast<std::uint32_t>(slot));
  });
  return selection;
}

}  // namespace strata::query
