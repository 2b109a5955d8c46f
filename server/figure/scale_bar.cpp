#include "figure/scale_bar.h"

#include <algorithm>
#include <cmath>

#include "core/text/number_text.h"

namespace strata::figure {
namespace {

constexpr double kText = 2.8, kSmall = 2.2;  // letter heights
constexpr double kThin = 0.12;               // line width
constexpr double kNarrowestStep = 3.9;       // with a number at each step

}  // namespace

std::string scale_text(double scale) {
  // Groups the digits of large whole numbers by three. short_number has only six digits.
  const auto number = [](double value) {
    if (value < 10'000 || value != std::floor(value)) return short_number(value);
    std::string digits = std::to_string(static_cast<std::int64_t>(value));
    for (auto at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3)
      digits.insert(static_cast<std::size_t>(at), "\u202f");
    return digits;
  };
  return scale >= 1 ? "1 : " + number(scale) : number(1 / scale) + " : 1";
}

ScaleBar scale_bar(double scale, double widest_mm) {
  // The length of the bar is 1, 2 or 5 times a power of ten, in millimeters in the world. The
  // longest bar that fits is used.
  const double most = widest_mm * scale;
  const double decade = std::pow(10, std::floor(std::log10(most)));
  const int digit = most >= 5 * decade ? 5 : most >= 2 * decade ? 2 : 1;
  const double length = digit * decade;
  ScaleBar bar;
  bar.length_mm = length / scale;
  bar.steps = digit == 1 ? 4 : digit == 2 ? 4 : 5;
  const bool km = length >= 2e6, m = length >= 2e3, cm = length >= 20;
  bar.unit = km ? "km" : m ? "m" : cm ? "cm" : "mm";
  bar.step = length / bar.steps / (km ? 1e6 : m ? 1e3 : cm ? 10 : 1);
  return bar;
}

Group bar_group(std::string id, const ScaleBar& bar, double scale, const glm::dvec2& left_bottom) {
  Group group{std::move(id), {}};
  constexpr double kBar = 2;
  const glm::dvec2 left(left_bottom.x, left_bottom.y - kBar - kSmall - 1);
  const double step_mm = bar.length_mm / bar.steps;
  for (int i = 0; i < bar.steps; ++i) {
    Path step = outline_of({left + glm::dvec2(i * step_mm, 0), {step_mm, kBar}}, kThin);
    step.fill = i % 2 == 0 ? Rgba{0, 0, 0, 255} : Rgba{255, 255, 255, 255};
    group.items.push_back(std::move(step));
  }
  for (int i = 0; i <= bar.steps; ++i) {
    if (step_mm < kNarrowestStep && i > 0 && i < bar.steps) continue;
    std::string text = short_number(i * bar.step);
    if (i == bar.steps) text += " " + bar.unit;
    group.items.push_back(Words{
        {left.x + i * step_mm, left_bottom.y}, std::move(text), kSmall, false, Anchor::middle});
  }
  group.items.push_back(Words{
      {left.x + bar.length_mm / 2, left.y - 1.4}, scale_text(scale), kText, true, Anchor::middle});
  return group;
}

Group arrow_group(std::string id, const glm::dvec2& north, const glm::dvec2& middle,
                  double length_mm) {
  constexpr double kWhole = 11;  // the length at which the letter has the height kText
  const double share = length_mm / kWhole, half_width = 2.2 * share;
  const glm::dvec2 tip = middle + north * (length_mm / 2), tail = middle - north * (length_mm / 2);
  const glm::dvec2 side(-north.y * half_width, north.x * half_width),
      notch = tail + north * half_width;
  Path dark{{tip, tail + side, notch}, true, Rgba{0, 0, 0, 255}, kThin};
  Path light{{tip, tail - side, notch}, true, Rgba{255, 255, 255, 255}, kThin};
  const double letters = std::max(kSmall, kText * share);
  const glm::dvec2 letter = tip + north * (2.2 / kText * letters) + glm::dvec2(0, letters * 0.36);
  return {std::move(id), {dark, light, Words{letter, "N", letters, true, Anchor::middle}}};
}

}  // namespace strata::figure
