#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "domain/layers/palette.h"
#include "media/picture.h"

namespace strata::query {

// Scanned maps whose colors have a meaning. Colors are compared as CIELAB distances (ΔE of 1976,
// D65): 2 is hardly visible, 100 is black to white.

constexpr double kUsualTolerance = 12;
constexpr std::size_t kMaxColorKeys = 256;

struct ColorKey {
  Rgba color{};
  double value = 0;
};

// {"#c02020": 1, "#2040c0": 2}. Refused (invalid at `field`): no such object, no colors, more than
// kMaxColorKeys.
Result<std::vector<ColorKey>> parse_color_keys(std::string_view json, const std::string& field);

class ColorKeys {
 public:
  ColorKeys(const std::vector<ColorKey>& keys, double tolerance);
  // The value of the nearest color within the tolerance of this pixel.
  std::optional<double> value_of(const std::uint8_t* rgb) const;

 private:
  struct Place {
    float l, a, b;
    double value;
  };
  std::vector<Place> places_;
  float squared_tolerance_;
};

// The colors of a picture, by the share of pixels within the tolerance. Colors of less than half a
// percent, such as edges and noise, are left out.
struct FoundColor {
  Rgba color{};
  double share = 0;            // of the pixels that are at least half opaque
  bool is_background = false;  // it covers most of the picture's border
};
constexpr std::size_t kMaxFoundColors = 24;
std::vector<FoundColor> find_colors(const Picture& picture, double tolerance);

}  // namespace strata::query
