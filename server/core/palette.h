#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "core/value_type.h"

namespace strata {

using Rgba = std::array<std::uint8_t, 4>;

enum class PaletteMode { linear, step, categorical };

// Control points that turn values into colours. `linear` interpolates between points, `step` holds the colour of the
// last point at or below the value, `categorical` gives listed values their colour and others a generated one.
// Values outside [min,max] take the colour of the nearer end.
struct Palette {
  struct Point {
    double at = 0;
    Rgba color{};
    std::string label;
  };
  PaletteMode mode = PaletteMode::linear;
  double min = 0;
  double max = 1;
  std::vector<Point> points;  // ascending `at`, 1…4096 of them (categorical: may be none)
  std::string column;         // database layers: column of the table that colours (empty: the key)
};

Result<Palette> palette_from_json(const nlohmann::json& json, const std::string& field = "palette");
nlohmann::json to_json(const Palette& palette);

// Colour-blind-safe: viridis for measurements, Okabe-Ito colours for classes and keys.
Palette default_palette(ValueType type, bool categorical);

// The colour of a value that a categorical palette does not list; the shader computes the same.
Rgba generated_color(std::uint32_t key);
Rgba color_of(const Palette& palette, double value);

}  // namespace strata
