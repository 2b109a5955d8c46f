#include "domain/people/person_color.h"

#include <array>

namespace strata {
namespace {

// Computed colors. Any two of them differ by at least 14 in CIELAB, for normal and for red- or
// green-deficient vision. The first eight differ by at least 17.
constexpr std::array<std::string_view, 12> kColors = {"#aa3333", "#0066dd", "#117799", "#771155",
                                                      "#661199", "#995500", "#dd1166", "#337766",
                                                      "#334400", "#bb1188", "#663333", "#8855bb"};

}  // namespace

std::string_view person_color(PersonId account) {
  const auto count = static_cast<std::int64_t>(kColors.size());
  return kColors[static_cast<std::size_t>(((account.number() - 1) % count + count) % count)];
}

}  // namespace strata
