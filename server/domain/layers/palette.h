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

// How a color is drawn, so that the content below stays visible, also in grayscale. Lines and dots
// have fixed positions in the picture; an outline is empty inside.
enum class Pattern { solid, hatch, dots, outline };

// Control points that map values to colors. `linear` interpolates between points, `step` holds the
// color of the last point at or below the value, `categorical` gives listed values their color and
// others a generated one. Values outside [min,max] take the color of the nearer end. With a
// `column`, values are those of the key's record: numbers, or texts that points name by `value`
// (categorical only; `at` then only orders them).
struct Palette {
  struct Point {
    double at = 0;
    Rgba color{};
    std::string label{};
    std::string value{};
    Pattern pattern = Pattern::solid;  // step and categorical
    double angle = 45;                 // degrees, of lines: 0 is to the right, 90 up
    // of lines and dots, at the distance of the model's center; 0: in pixels, as in a legend
    double spacing_mm = 0;
  };
  PaletteMode mode = PaletteMode::linear;
  double min = 0;
  double max = 1;
  std::vector<Point> points;  // ascending `at`, 1…4096 points (categorical: may be empty)
  std::string column;         // database layers: the coloring column (empty: the key)
  // categorical: color of unlisted values and, with a column, of records without a value
  std::optional<Rgba> others{};
};

// Whether its points list the layer's own values instead of those of records.
inline bool lists_values(const Palette& palette) {
  return palette.mode == PaletteMode::categorical && palette.column.empty();
}

constexpr double kWidestSpacing_mm = 60'000;  // of a pattern
// Default for records without a value in the coloring column.
constexpr Rgba kNoValueColor{154, 154, 154, 128};

// Returns `#rrggbb`, without the opacity.
std::string rgb_text(const Rgba& color);
// Accepts `#rrggbb` and `#rrggbbaa`.
Result<Rgba> parse_color(const nlohmann::json& json, const std::string& field);
Result<Palette> palette_from_json(const nlohmann::json& json, const std::string& field = "palette");
nlohmann::json to_json(const Palette& palette);

// Safe for color-blind people: viridis for measurements, Okabe-Ito colors for classes and keys.
Palette default_palette(ValueType type, bool categorical);

// Returns the color of a value that a categorical palette does not list, as the shader does.
Rgba generated_color(std::uint32_t key);
Rgba color_of(const Palette& palette, double value);
// Returns the point with a value's color in a step or categorical palette; null if no point has it,
// and for a linear palette.
const Palette::Point* point_of(const Palette& palette, double value);

}  // namespace strata
