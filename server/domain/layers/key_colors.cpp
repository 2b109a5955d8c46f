#include "domain/layers/key_colors.h"

#include <algorithm>
#include <unordered_map>

namespace strata {
namespace {

constexpr Rgba kDimmed{128, 128, 128, 72}, kNothing{0, 0, 0, 0};

Palette by_key_of(const Palette& palette) {
  Palette made{PaletteMode::categorical, 0, 1, {}, {}};
  made.others = palette.others.value_or(kNoValueColor);
  return made;
}

Palette::Point drawn_as(const Palette::Point& point, std::uint32_t key, const Rgba& color) {
  Palette::Point made{double(key), color};
  made.pattern = point.pattern;
  made.angle = point.angle;
  made.spacing_mm = point.spacing_mm;
  return made;
}

}  // namespace

Palette colors_of_numbers(const Palette& palette, std::span<const KeyNumber> numbers) {
  Palette made = by_key_of(palette);
  for (const KeyNumber& known : numbers) {
    const Palette::Point* point = point_of(palette, known.number);
    if (!point && palette.mode == PaletteMode::categorical) continue;
    made.points.push_back(
        drawn_as(point ? *point : Palette::Point{}, known.key, color_of(palette, known.number)));
  }
  std::ranges::sort(made.points, {}, &Palette::Point::at);
  return made;
}

Palette colors_of_texts(const Palette& palette, std::span<const KeyText> texts) {
  Palette made = by_key_of(palette);
  std::unordered_map<std::string_view, const Palette::Point*> points;
  for (const Palette::Point& point : palette.points) points.emplace(point.value, &point);
  for (const KeyText& known : texts)
    if (const auto point = points.find(known.text); point != points.end())
      made.points.push_back(drawn_as(*point->second, known.key, point->second->color));
  std::ranges::sort(made.points, {}, &Palette::Point::at);
  return made;
}

Palette highlighted_colors(const Palette& by_key, std::span<const std::uint32_t> keys,
                           bool isolate) {
  Palette made{PaletteMode::categorical, 0, 1, {}, {}};
  made.others = isolate ? kNothing : kDimmed;
  made.points.reserve(keys.size());
  for (const std::uint32_t key : keys) {
    const Palette::Point* point = point_of(by_key, key);
    Rgba color = color_of(by_key, key);
    color[3] = 255;  // a highlighted record must be visible
    made.points.push_back(drawn_as(point ? *point : Palette::Point{}, key, color));
  }
  return made;
}

}  // namespace strata
