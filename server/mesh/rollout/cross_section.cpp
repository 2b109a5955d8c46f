#include "mesh/rollout/cross_section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace strata::mesh {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

}  // namespace

CrossSection::CrossSection(std::vector<double> radii) : radii_(std::move(radii)) {
  const std::size_t count = radii_.size();
  arcs_.assign(count + 1, 0);
  min_stretch_ = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 from = corner(i), to = corner(i + 1);
    const double side = glm::distance(from, to);
    arcs_[i + 1] = arcs_[i] + side;
    // On a line at the distance h from the axis, the length per radian is r² / h.
    const double h = cross(from, to) / side;
    const auto [nearer, farther] = std::minmax(radii_[i], radii_[(i + 1) % count]);
    const bool has_foot = glm::dot(from, to - from) < 0 && glm::dot(to, to - from) > 0;
    min_stretch_ = std::min(min_stretch_, has_foot ? h : nearer * nearer / h);
    max_stretch_ = std::max(max_stretch_, farther * farther / h);
  }
}

glm::dvec2 CrossSection::corner(std::size_t i) const {
  i %= radii_.size();
  const double angle = kTurn * static_cast<double>(i) / static_cast<double>(radii_.size());
  return radii_[i] * glm::dvec2(std::cos(angle), std::sin(angle));
}

CrossSection::OnSide CrossSection::at(double angle) const {
  const auto count = static_cast<double>(radii_.size());
  const double turns = std::floor(angle / kTurn), rest = angle - turns * kTurn;
  const double place = std::clamp(rest / kTurn * count, 0.0, count * (1 - 1e-15));
  const auto i = std::min(static_cast<std::size_t>(place), radii_.size() - 1);
  // The ray meets the line from this corner to the next one.
  const glm::dvec2 from = corner(i), side = corner(i + 1) - from,
                   ray(std::cos(rest), std::sin(rest));
  const double share = std::clamp(-cross(ray, from) / cross(ray, side), 0.0, 1.0);
  return {i, share, turns};
}

double CrossSection::radius(double angle) const {
  const OnSide place = at(angle);
  const glm::dvec2 from = corner(place.corner);
  return glm::length(from + place.share * (corner(place.corner + 1) - from));
}

double CrossSection::arc(double angle) const {
  const OnSide place = at(angle);
  return place.turns * length() +
         std::lerp(arcs_[place.corner], arcs_[place.corner + 1], place.share);
}

double CrossSection::angle_at(double arc) const {
  const double turns = std::floor(arc / length()), rest = arc - turns * length();
  const auto next = std::upper_bound(arcs_.begin(), arcs_.end() - 1, rest);
  const auto i = static_cast<std::size_t>(next - arcs_.begin()) - 1;
  const std::size_t side = std::min(i, radii_.size() - 1);
  const double share = std::clamp((rest - arcs_[side]) / (arcs_[side + 1] - arcs_[side]), 0.0, 1.0);
  const glm::dvec2 from = corner(side), place = from + share * (corner(side + 1) - from);
  const double first = kTurn * static_cast<double>(side) / static_cast<double>(radii_.size());
  // The angle between the corner and the place is less than half a turn.
  const double beyond = std::atan2(cross(from, place), glm::dot(from, place));
  return turns * kTurn + first + beyond;
}

glm::dvec2 CrossSection::corner_tangent(std::size_t i) const {
  // The corners of a scan contain noise, so the direction is that between farther corners.
  constexpr std::size_t kCorners = 2;
  return glm::normalize(corner(i + kCorners) - corner(i + radii_.size() - kCorners));
}

glm::dvec2 CrossSection::tangent(double angle) const {
  const OnSide place = at(angle);
  return glm::normalize(
      glm::mix(corner_tangent(place.corner), corner_tangent(place.corner + 1), place.share));
}

}  // namespace strata::mesh
