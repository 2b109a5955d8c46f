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

// How the colour is laid on, so that what lies below stays legible, also in greyscale. Lines and
// dots stay where they are on the picture's plane; an outline has nothing inside.
enum class Pattern { solid, hatch, dots, outline };

// Control points that turn values into colours. `linear` interpolates between points, `step` holds
// the colour of the last point at or below the value, `categorical` gives listed values their
// colour and others a generated one. Values outside [min,max] take the colour of the nearer end.
// With a `column`, values are those of the record behind a key: numbers, or texts that points name
// by `value` (categorical only; `at` then only orders them).
struct Palette {
  struct Point {
    double at = 0;
    Rgba color{};
    std::string label{};
    std::string value{};
    Pattern pattern = Pattern::solid;  // step and categorical
    double angle = 45;                 // degrees, of lines: 0 runs to the right, 90 up
    // of lines and dots, at the distance of the model's middle; 0: as a legend has them, in pixels
    double spacing_mm = 0;
  };
  PaletteMode mode = PaletteMode::linear;
  double min = 0;
  double max = 1;
  std::vector<Point> points;  // ascending `at`, 1…4096 of them (categorical: may be none)
  std::string column;         // database layers: column of the table that colours (empty: the key)
  // categorical: of what no point lists. With a column: of records that have no value there, too
  std::optional<Rgba> others{};
};

// Whether its points are a legend of the values themselves, and not of what records hold.
inline bool lists_values(const Palette& palette) {
  return palette.mode == PaletteMode::categorical && palette.column.empty();
}

constexpr double kWidestSpacing_mm = 60'000;  // of a pattern
// Of records that have no value in the column that colours, where the palette says nothing.
constexpr Rgba kNoValueColor{154, 154, 154, 128};

// `#rrggbb`, without the opacity.
std::string rgb_text(const Rgba& color);
// Either `#rrggbb` or `#rrggbbaa`.
Result<Rgba> parse_color(const nlohmann::json& json, const std::string& field);
Result<Palette> palette_from_json(const nlohmann::json& json, const std::string& field = "palette");
nlohmann::json to_json(const Palette& palette);

// Colour-blind-safe: viridis for measurements, Okabe-Ito colours for classes and keys.
Palette default_palette(ValueType type, bool categorical);

// The colour of a value that a categorical palette does not list; the shader computes the same.
Rgba generated_color(std::uint32_t key);
Rgba color_of(const Palette& palette, double value);
// The point whose colour a value has in a step or categorical palette; null: none, and in a linear
// palette.
const Palette::Point* point_of(const Palette& palette, double value);

}  // namespace strata
