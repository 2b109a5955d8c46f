#include "domain/people/person_color.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>

namespace strata {
namespace {

using Color = std::array<double, 3>;

// Returns the linear light of a color #rrggbb.
Color linear(std::string_view text) {
  Color color{};
  for (std::size_t i = 0; i < 3; ++i) {
    int byte = 0;
    std::from_chars(text.data() + 1 + 2 * i, text.data() + 3 + 2 * i, byte, 16);
    const double share = byte / 255.0;
    color[i] = share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
  }
  return color;
}

double contrast_with_white(std::string_view text) {
  const Color c = linear(text);
  return 1.05 / (0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2] + 0.05);
}

Color lab(const Color& c) {
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
  const double x = f((0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.95047);
  const double y = f(0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]);
  const double z = f((0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

// Returns the color as people without green cones perceive it (Machado, Oliveira, Fernandes 2009).
Color without_green(const Color& c) {
  const auto part = [&](double r, double g, double b) {
    return std::clamp(r * c[0] + g * c[1] + b * c[2], 0.0, 1.0);
  };
  return {part(0.367322, 0.860646, -0.227968), part(0.280085, 0.672501, 0.047413),
          part(-0.011820, 0.042940, 0.968881)};
}

double difference(const Color& a, const Color& b) {
  const Color x = lab(a), y = lab(b);
  return std::hypot(x[0] - y[0], x[1] - y[1], x[2] - y[2]);
}

TEST(PersonColor, white_letters_are_legible_on_each) {
  EXPECT_GE(contrast_with_white(kNobodysColor), 4.5);
  for (std::int64_t id = 1; id <= 12; ++id)
    EXPECT_GE(contrast_with_white(person_color(PersonId(id))), 4.5) << person_color(PersonId(id));
}

TEST(PersonColor, accounts_that_follow_each_other_differ) {
  for (std::int64_t a = 1; a <= 12; ++a)
    for (std::int64_t b = 1; b < a; ++b) {
      const Color x = linear(person_color(PersonId(a))), y = linear(person_color(PersonId(b)));
      EXPECT_GE(difference(x, y), 14)
          << person_color(PersonId(a)) << " " << person_color(PersonId(b));
      EXPECT_GE(difference(without_green(x), without_green(y)), 14)
          << person_color(PersonId(a)) << " " << person_color(PersonId(b));
    }
}

TEST(PersonColor, every_number_has_a_colour_always_the_same) {
  EXPECT_EQ(person_color(13), person_color(1));
  for (const std::int64_t id : {std::int64_t{0}, std::int64_t{-7}, INT64_MAX, INT64_MIN + 1})
    EXPECT_EQ(person_color(PersonId(id)).size(), 7U);
}

}  // namespace
}  // namespace strata
