#include "bill/units.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <utility>

namespace strata::bill {

std::optional<protocol::BillRuleMeasure> measure_of_unit(std::string_view unit) {
  using Measure = protocol::BillRuleMeasure;
  static constexpr std::array<std::pair<std::string_view, Measure>, 18> kUnits{{
      {"m2", Measure::area},
      {"m²", Measure::area},
      {"qm", Measure::area},
      {"m", Measure::length},
      {"lfm", Measure::length},
      {"lm", Measure::length},
      {"lfdm", Measure::length},
      {"m3", Measure::volume},
      {"m³", Measure::volume},
      {"cbm", Measure::volume},
      {"st", Measure::count},
      {"stk", Measure::count},
      {"stck", Measure::count},
      {"stück", Measure::count},
      {"pcs", Measure::count},
      {"pc", Measure::count},
      {"ud", Measure::count},
      {"u", Measure::count},
  }};
  std::string name(unit);
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.ends_with('.')) name.pop_back();
  const auto found = std::ranges::find(kUnits, name, &std::pair<std::string_view, Measure>::first);
  return found == kUnits.end() ? std::nullopt : std::optional(found->second);
}

std::string_view usual_unit(protocol::BillRuleMeasure measure) {
  using Measure = protocol::BillRuleMeasure;
  switch (measure) {
    case Measure::area: return "m2";
    case Measure::length: return "m";
    case Measure::volume: return "m3";
    default: return "St";
  }
}

std::optional<double> metres_of_unit(std::string_view unit) {
  if (unit == "mm") return 0.001;
  if (unit == "cm") return 0.01;
  if (unit == "m") return 1.0;
  return std::nullopt;
}

}  // namespace strata::bill
