#include "net/serialization/tour_theme.h"

#include <cstdio>
#include <string>

#include "domain/scene/contrast.h"

namespace strata::net {
namespace {

// Keep these values equal to those in web-client/src/domain/tour-theme.ts.
struct ModeColors {
  const char *ink, *background, *accent;
};
constexpr ModeColors kLight{"#20292a", "#dedad3", "#2c6a63"},
    kDark{"#ebe6da", "#14181a", "#7fc0b5"};
constexpr double kMinTextContrast = 7, kMinAccentContrast = 3;

// Rounds down to one decimal, so the text of an insufficient contrast always differs from the text
// of the required contrast.
std::string ratio(double contrast) {
  char text[16];
  std::snprintf(text, sizeof text, "%.1f:1", static_cast<int>(contrast * 10) / 10.0);
  return text;
}

}  // namespace

Result<void> check_theme_colors(const protocol::TourTheme& theme) {
  const bool dark = theme.mode == protocol::TourMode::dark;
  const ModeColors& mode = dark ? kDark : kLight;
  const auto color = [](const std::string& text, const char* field) {
    return parse_color(nlohmann::json(text), field);
  };
  const std::string background_text = theme.background.value_or(mode.background);
  const auto ink = STRATA_TRY(color(mode.ink, "theme"));
  const auto background = STRATA_TRY(color(background_text, "theme.background"));
  const auto accent = STRATA_TRY(color(theme.accent.value_or(mode.accent), "theme.accent"));
  if (const double now = contrast(ink, background); now < kMinTextContrast)
    return fail(ErrorCode::invalid, "Contrast too low",
                "Text on " + background_text + " has a contrast of " + ratio(now) +
                    ", but requires " + ratio(kMinTextContrast) + ". Choose a " +
                    (dark ? "darker background, or the mode `light`."
                          : "lighter background, or the mode `dark`."),
                "theme.background");
  if (const double now = contrast(accent, background); now < kMinAccentContrast)
    return fail(ErrorCode::invalid, "Contrast too low",
                "The accent color has a contrast of " + ratio(now) +
                    " with the background, but requires " + ratio(kMinAccentContrast) +
                    ". Choose a " + (dark ? "lighter" : "darker") + " accent color.",
                theme.accent ? "theme.accent" : "theme.background");
  return {};
}

}  // namespace strata::net
