#include "figure/legend.h"

#include "core/text/number_text.h"
#include "domain/tables/label_text.h"

namespace strata::figure {

Legend legend_of(const Layer& layer, const Palette& palette, const std::set<double>* there,
                 const std::string& language) {
  Legend legend;
  legend.title = label_or(layer.labels, language, layer.name);
  if (!layer.unit.empty()) legend.title += " [" + layer.unit + "]";
  if (palette.mode == PaletteMode::linear) {
    constexpr int kSteps = 64;
    for (int i = 0; i < kSteps; ++i)
      legend.ramp.push_back(
          color_of(palette, palette.min + (palette.max - palette.min) * (i + 0.5) / kSteps));
    legend.low = short_number(palette.min);
    legend.high = short_number(palette.max);
    return legend;
  }
  for (const Palette::Point& point : palette.points) {
    if (there && lists_values(palette) && !there->contains(point.at)) continue;
    std::string label = !point.label.empty()                ? point.label
                        : !point.value.empty()              ? point.value
                        : palette.mode == PaletteMode::step ? "≥ " + short_number(point.at)
                                                            : short_number(point.at);
    legend.entries.push_back({std::move(label), point.color, point.pattern, point.angle});
  }
  return legend;
}

}  // namespace strata::figure
