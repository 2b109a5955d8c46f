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
  bool bare = false;  // lines or dots without tint and border: what waits for review
};

// A layer's: classes, or for numbers a ramp from `low` to `high`.
struct Legend {
  std::string title;
  std::vector<LegendEntry> entries;
  std::vector<Rgba> ramp;  // of equal steps
  std::string low, high;
};

// Its title is the layer's name in `language`, where it has one in it. A layer of keys whose
// colours are made up has none but its title. `there`: of a categorical palette of values the
// classes that are told; null: all.
Legend legend_of(const Layer& layer, const Palette& palette,
                 const std::set<double>* there = nullptr, const std::string& language = {});

}  // namespace strata::figure
