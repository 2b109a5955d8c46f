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
  double angle = 45;  // degrees, of lines
  bool bare = false;  // lines or dots without tint and border: unreviewed edits
};

// The legend of a layer: classes, or for numbers a ramp from `low` to `high`.
struct Legend {
  std::string title;
  std::vector<LegendEntry> entries;
  std::vector<Rgba> ramp;  // of equal steps
  std::string low, high;
};

// The title is the layer's name in `language`, if it has one. A layer of keys with generated colors
// has only a title. `there`: the listed classes of a categorical palette of values; null: all.
Legend legend_of(const Layer& layer, const Palette& palette,
                 const std::set<double>* there = nullptr, const std::string& language = {});

}  // namespace strata::figure
