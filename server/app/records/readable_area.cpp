#include "app/records/readable_area.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace strata::app {

AreaUnit readable_area(double largest_m2) {
  if (largest_m2 < 1e-4) return {"mm²", 1e6};
  return largest_m2 < 0.1 ? AreaUnit{"cm²", 1e4} : AreaUnit{"m²", 1};
}

std::string number_format(double largest) {
  constexpr int kDigits = 4, kMaxDecimals = 12;
  const int decimals =
      largest > 0 ? kDigits - 1 - static_cast<int>(std::floor(std::log10(largest))) : 0;
  return "#,##0." +
         std::string(static_cast<std::size_t>(std::clamp(decimals, 2, kMaxDecimals)), '0');
}

std::string readable_head(const std::string& head, const AreaUnit& unit) {
  constexpr std::string_view kUnit = "_m2";
  return head.substr(0, head.size() - (head.ends_with(kUnit) ? kUnit.size() : 0)) + " (" +
         unit.name + ")";
}

}  // namespace strata::app
