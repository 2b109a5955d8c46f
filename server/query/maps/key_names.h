#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "domain/layers/palette.h"

namespace strata::query {

// Keys by their names, as a layer's legend has them and a map adds to them.
class KeyNames {
 public:
  // The names are the labels of a categorical palette. Keys in `taken` mean something already,
  // though they may have no name.
  KeyNames(const Palette& palette, const std::set<double>& taken);

  // The key of that name; a new name gets the lowest number from 1 that has no name and is not
  // taken.
  double key_of(const std::string& name);
  // Gives a key its name, and its colour where one is told; those that it has in the legend stay.
  void name(double key, const std::string& name);
  void color(double key, const Rgba& color);

  // What the legend lacks. Names alone, and all.
  const std::vector<std::string>& added_names() const { return added_names_; }
  bool has_changed() const { return changed_; }
  // The legend with it, points ascending.
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
