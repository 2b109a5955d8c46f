#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "domain/layers/palette.h"
#include "media/picture.h"

namespace strata::query {

// Values from the colors of scanned maps. Colors are compared by their CIELAB distance (ΔE of 1976,
// D65). A distance of 2 is hardly visible; the distance from black to white is 100.

constexpr double kUsualTolerance = 12;
constexpr std::size_t kMaxColorKeys = 256;

struct ColorKey {
  Rgba color{};
  double value = 0;
};

// Parses an object such as {"#c02020": 1, "#2040c0": 2}. Returns an `invalid` error at `field` for
// other JSON, for an object without colors, and for more than kMaxColorKeys colors.
Result<std::vector<ColorKey>> parse_color_keys(std::string_view json, const std::string& field);

class ColorKeys {
 public:
  ColorKeys(const std::vector<ColorKey>& keys, double tolerance);
  // Returns the value of the nearest color within the tolerance of this pixel.
  std::optional<double> value_of(const std::uint8_t* rgb) const;

 private:
  struct Place {
    float l, a, b;
    double value;
  };
  std::vector<Place> places_;
  float squared_tolerance_;
};

// A color of an image, with the share of pixels within the tolerance. Colors with less than half a
// percent of the pixels, such as edges and noise, are left out.
struct FoundColor {
  Rgba color{};
  double share = 0;            // share of the pixels that are at least half opaque
  bool is_background = false;  // it covers most of the border of the image
};
constexpr std::size_t kMaxFoundColors = 24;
std::vector<FoundColor> find_colors(const Picture& picture, double tolerance);

}  // namespace strata::query
