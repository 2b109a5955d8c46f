#include "query/regions/reading_order.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace strata::query {
namespace {

constexpr int kRows = 10;

// The least and the greatest coordinate of the places along an axis.
std::pair<double, double> range_along(std::span<const glm::dvec3> places, const glm::dvec3& axis) {
  const auto along = [&](const glm::dvec3& place) { return glm::dot(place, axis); };
  const auto [least, most] = std::ranges::minmax(places, {}, along);
  return {along(least), along(most)};
}

}  // namespace

std::vector<std::uint32_t> reading_order(std::span<const glm::dvec3> places, const UpFrame& frame) {
  std::vector<std::uint32_t> order(places.size());
  std::iota(order.begin(), order.end(), 0u);
  if (places.empty()) return order;
  const auto [low, high] = range_along(places, frame.up);
  const auto [near, far] = range_along(places, frame.into);
  const bool on_floor = high - low < 0.1 * (far - near);
  const glm::dvec3 vertical = on_floor ? frame.into : frame.up;
  const double top = on_floor ? far : high, height = on_floor ? far - near : high - low;
  const auto row = [&](const glm::dvec3& place) {
    if (!(height > 0)) return 0;
    const double below = (top - glm::dot(place, vertical)) / height;
    return std::clamp(static_cast<int>(below * kRows), 0, kRows - 1);
  };
  std::ranges::stable_sort(order, {}, [&](std::uint32_t number) {
    return std::pair(row(places[number]), glm::dot(places[number], frame.right));
  });
  return order;
}

}  // namespace strata::query
