#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "domain/layers/palette.h"
#include "media/picture.h"

namespace strata::query {

// Scanned maps whose colours stand for something. Colours are compared as CIELAB distances (ΔE of
// 1976, D65): 2 is hardly seen, 100 is black to white.

constexpr double kUsualTolerance = 12;
constexpr std::size_t kMaxColorKeys = 256;

struct ColorKey {
  Rgba color{};
  double value = 0;
};

// {"#c02020": 1, "#2040c0": 2}. Refused (invalid at `field`): no such object, no colours, more than
// kMaxColorKeys.
Result<std::vector<ColorKey>> parse_color_keys(std::string_view json, const std::string& field);

class ColorKeys {
 public:
  ColorKeys(const std::vector<ColorKey>& keys, double tolerance);
  // Of the nearest colour that is within the tolerance of this pixel.
  std::optional<double> value_of(const std::uint8_t* rgb) const;

 private:
  struct Place {
    float l, a, b;
    double value;
  };
  std::vector<Place> places_;
  float squared_tolerance_;
};

// The colours that cover a picture, by their share: what is within the tolerance of one counts to
// it. Those of less than half a percent, edges and noise, are left out.
struct FoundColor {
  Rgba color{};
  double share = 0;            // of the pixels that are at least half opaque
  bool is_background = false;  // the one that covers most of the picture's border
};
constexpr std::size_t kMaxFoundColors = 24;
std::vector<FoundColor> find_colors(const Picture& picture, double tolerance);

}  // namespace strata::query
