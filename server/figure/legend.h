#pragma once

#include <set>
#include <string>
#include <vector>

#include "domain/layers/layer.h"
#include "domain/layers/palette.h"

namespace strata::figure {

struct LegendEntry {
  std::string label;
  Rgba color{};
  Pattern pattern = Pattern::solid;
  double angle = 45;  // of the lines, in degrees
  bool bare = false;  // lines or dots without tint and border, for unreviewed edits
};

// The legend of a layer: its classes, or for numbers a color ramp from `low` to `high`.
struct Legend {
  std::string title;
  std::vector<LegendEntry> entries;
  std::vector<Rgba> ramp;  // colors of equal steps
  std::string low, high;
};

// Makes the legend of a layer. The title is the layer's name, in `language` if possible. A layer of
// keys with generated colors has only a title. `there` selects the classes of a categorical palette
// of values. Null: all classes.
Legend legend_of(const Layer& layer, const Palette& palette,
                 const std::set<double>* there = nullptr, const std::string& language = {});

}  // namespace strata::figure
