#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace strata::test {

using Lab = std::array<double, 3>;

// Returns CIE L*a*b* (D65) of an sRGB color with channels 0…255.
inline Lab lab_of(const std::array<double, 3>& rgb) {
  std::array<double, 3> linear{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = rgb[i] / 255;
    linear[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  const auto f = [](double t) {
    return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  };
  const auto [r, g, b] = linear;
  const double x = f((0.4124564 * r + 0.3575761 * g + 0.1804375 * b) / 0.95047),
               y = f(0.2126729 * r + 0.7151522 * g + 0.0721750 * b),
               z = f((0.0193339 * r + 0.1191920 * g + 0.9503041 * b) / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

// Source: Sharma, Wu and Dalal: The CIEDE2000 color-difference formula, 2005.
inline double ciede2000(const Lab& one, const Lab& other) {
  const auto [l1, a1, b1] = one;
  const auto [l2, a2, b2] = other;
  constexpr double kPi = 3.14159265358979323846, kDegree = kPi / 180;
  const auto seventh = [](double c) {
    return std::sqrt(std::pow(c, 7) / (std::pow(c, 7) + std::pow(25.0, 7)));
  };
  const double g = 0.5 * (1 - seventh((std::hypot(a1, b1) + std::hypot(a2, b2)) / 2));
  const double x1 = (1 + g) * a1, x2 = (1 + g) * a2, c1 = std::hypot(x1, b1),
               c2 = std::hypot(x2, b2);
  const auto hue = [](double y, double x) {
    const double angle = x == 0 && y == 0 ? 0 : std::atan2(y, x);
    return angle < 0 ? angle + 2 * kPi : angle;
  };
  const double h1 = hue(b1, x1), h2 = hue(b2, x2);
  double turn = c1 * c2 == 0 ? 0 : h2 - h1;
  if (turn > kPi) turn -= 2 * kPi;
  if (turn < -kPi) turn += 2 * kPi;
  double mean_hue = h1 + h2;
  if (c1 * c2 != 0) {
    mean_hue /= 2;
    if (std::abs(h1 - h2) > kPi) mean_hue += h1 + h2 < 2 * kPi ? kPi : -kPi;
  }
  const double ml = (l1 + l2) / 2, mc = (c1 + c2) / 2;
  const double t = 1 - 0.17 * std::cos(mean_hue - 30 * kDegree) + 0.24 * std::cos(2 * mean_hue) +
                   0.32 * std::cos(3 * mean_hue + 6 * kDegree) -
                   0.20 * std::cos(4 * mean_hue - 63 * kDegree);
  const double l = (l2 - l1) /
                   (1 + 0.015 * (ml - 50) * (ml - 50) / std::sqrt(20 + (ml - 50) * (ml - 50))),
               c = (c2 - c1) / (1 + 0.045 * mc),
               h = 2 * std::sqrt(c1 * c2) * std::sin(turn / 2) / (1 + 0.015 * mc * t);
  const double around = (mean_hue / kDegree - 275) / 25;
  const double rt = -2 * seventh(mc) * std::sin(60 * kDegree * std::exp(-around * around));
  return std::sqrt(l * l + c * c + h * h + rt * c * h);
}

inline double color_difference(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return ciede2000(lab_of(a), lab_of(b));
}

}  // namespace strata::test
