#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "domain/layers/palette.h"

namespace strata::query {

// Keys by their names, from a layer's legend and from an imported map.
class KeyNames {
 public:
  // The names are the labels of a categorical palette. Keys in `taken` are in use, even those
  // without a name.
  KeyNames(const Palette& palette, const std::set<double>& taken);

  // Returns the key with that name; a new name gets the lowest number from 1 that has no name and
  // is not in use.
  double key_of(const std::string& name);
  // Sets the name or the color of a key, unless the legend has one for it.
  void name(double key, const std::string& name);
  void color(double key, const Rgba& color);

  // The names that the legend lacks, and whether anything is new.
  const std::vector<std::string>& added_names() const { return added_names_; }
  bool has_changed() const { return changed_; }
  // The legend with the additions, points ascending.
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
