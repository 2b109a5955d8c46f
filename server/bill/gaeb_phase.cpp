#include "bill/gaeb.h"

namespace strata::bill {

std::optional<GaebPhase> parse_gaeb_phase(std::string_view name) {
  if (name == "x31") return GaebPhase::x31;
  if (name == "x83") return GaebPhase::x83;
  if (name == "x84") return GaebPhase::x84;
  if (name == "x86") return GaebPhase::x86;
  return std::nullopt;
}

std::string_view number_of(GaebPhase phase) {
  switch (phase) {
    case GaebPhase::x31: return "31";
    case GaebPhase::x83: return "83";
    case GaebPhase::x84: return "84";
    case GaebPhase::x86: return "86";
  }
  return "";
}

}  // namespace strata::bill
