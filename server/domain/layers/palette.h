#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "domain/layers/value_type.h"

namespace strata {

using Rgba = std::array<std::uint8_t, 4>;

enum class PaletteMode { linear, step, categorical };

// The pattern of a color. Patterns leave the content below visible, and are readable in grayscale.
// Lines and dots have fixed positions in the image. An outline is empty inside.
enum class Pattern { solid, hatch, dots, outline };

// Control points that map values to colors. `linear` interpolates between points. `step` uses the
// color of the last point at or below the value. `categorical` uses the colors of the points for
// listed values, and generated colors for other values. A value outside [min,max] gets the color of
// the nearer end. With a `column`, the palette uses the values in this column of the key's records:
// numbers or, in a categorical palette, texts. A point then has its text in `value`, and `at` only
// defines the order of the points.
struct Palette {
  struct Point {
    double at = 0;
    Rgba color{};
    std::string label{};
    std::string value{};
    Pattern pattern = Pattern::solid;  // in step and categorical palettes
    double angle = 45;  // of the lines, in degrees: 0 points to the right, 90 points up
    // The spacing of lines and dots, at the distance of the center of the model. 0 means a spacing
    // in pixels, as in a legend.
    double spacing_mm = 0;
  };
  PaletteMode mode = PaletteMode::linear;
  double min = 0;
  double max = 1;
  std::vector<Point> points;  // 1…4096 points with ascending `at`; may be empty if categorical
  std::string column;  // in database layers: the column that determines the colors (empty: the key)
  // In categorical palettes: the color of unlisted values and, with a column, of records without a
  // value.
  std::optional<Rgba> others{};
};

// Returns whether the points list values of the layer itself, and not of its records.
inline bool lists_values(const Palette& palette) {
  return palette.mode == PaletteMode::categorical && palette.column.empty();
}

constexpr double kWidestSpacing_mm = 60'000;  // of a pattern
// The default color for records that have no value in the coloring column.
constexpr Rgba kNoValueColor{154, 154, 154, 128};

// Returns `#rrggbb`, without the opacity of the color.
std::string rgb_text(const Rgba& color);
// Accepts `#rrggbb` and `#rrggbbaa`.
Result<Rgba> parse_color(const nlohmann::json& json, const std::string& field);
Result<Palette> palette_from_json(const nlohmann::json& json, const std::string& field = "palette");
nlohmann::json to_json(const Palette& palette);

// Returns colors that are safe for color-blind users: viridis for measurements, and Okabe-Ito
// colors for classes and keys.
Palette default_palette(ValueType type, bool categorical);

// Returns the color that the shader uses for a value that a categorical palette does not list.
Rgba generated_color(std::uint32_t key);
Rgba color_of(const Palette& palette, double value);
// Returns the point that determines the color of a value in a step or categorical palette. Returns
// null if there is no such point, and for a linear palette.
const Palette::Point* point_of(const Palette& palette, double value);

}  // namespace strata
