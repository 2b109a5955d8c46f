#include "query/maps/key_names.h"

#include <algorithm>

namespace strata::query {

KeyNames::KeyNames(const Palette& palette, const std::set<double>& taken)
    : palette_(palette), taken_(taken) {
  for (const Palette::Point& point : palette.points) {
    points_[point.at] = point;
    if (!point.label.empty()) keys_.emplace(point.label, point.at);
    // No user chose the colors of the default legend, so a key that is not in use gets the color of
    // the map.
    if (!point.label.empty() || taken_.contains(point.at)) fixed_colors_.insert(point.at);
  }
}

Palette::Point& KeyNames::point(double key) {
  changed_ = true;
  auto [found, is_new] = points_.try_emplace(key);
  if (is_new)
    found->second = {
        key, generated_color(static_cast<std::uint32_t>(static_cast<std::int64_t>(key))), {}};
  return found->second;
}

double KeyNames::key_of(const std::string& name) {
  if (const auto known = keys_.find(name); known != keys_.end()) return known->second;
  for (;; ++next_) {
    const auto found = points_.find(next_);
    if (!taken_.contains(next_) && (found == points_.end() || found->second.label.empty())) break;
  }
  const double key = next_++;
  this->name(key, name);
  return key;
}

void KeyNames::name(double key, const std::string& name) {
  if (const auto found = points_.find(key); found != points_.end() && !found->second.label.empty())
    return;
  point(key).label = name;
  keys_.emplace(name, key);
  added_names_.push_back(name);
}

void KeyNames::color(double key, const Rgba& color) {
  if (!fixed_colors_.insert(key).second) return;
  if (const auto found = points_.find(key); found != points_.end() && found->second.color == color)
    return;
  point(key).color = color;
}

Palette KeyNames::extended() const {
  Palette palette = palette_;
  palette.points.clear();
  for (const auto& [key, point] : points_) palette.points.push_back(point);
  if (!palette.points.empty()) {
    palette.min = std::min(palette.min, palette.points.front().at);
    palette.max = std::max(palette.max, palette.points.back().at);
  }
  return palette;
}

}  // namespace strata::query
