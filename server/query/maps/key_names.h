#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "domain/layers/palette.h"

namespace strata::query {

// Assigns keys to the names in the legend of a layer and in an imported map.
class KeyNames {
 public:
  // The names are the labels of a categorical palette. Keys in `taken` are in use, even if they
  // have no name.
  KeyNames(const Palette& palette, const std::set<double>& taken);

  // Returns the key with that name. A new name gets the lowest key, starting at 1, that has no name
  // and is not in use.
  double key_of(const std::string& name);
  // Set the name or the color of a key, unless the legend already has one.
  void name(double key, const std::string& name);
  void color(double key, const Rgba& color);

  // Return the names that the legend did not have, and whether the legend has changed.
  const std::vector<std::string>& added_names() const { return added_names_; }
  bool has_changed() const { return changed_; }
  // Returns the legend with the additions. Its points are ascending.
  Palette extended() const;

 private:
  Palette::Point& point(double key);

  Palette palette_;
  std::map<double, Palette::Point> points_;
  std::map<std::string, double> keys_;
  std::set<double> taken_, fixed_colors_;
  std::vector<std::string> added_names_;
  double next_ = 1;
  bool changed_ = false;
};

}  // namespace strata::query
