// Fuzzes a period as EDTF. Its days must be in order, and a trailing qualifier must not change
// them.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/text/edtf.h"
#include "core/text/utf8.h"

namespace {

void demand(bool holds) {
  if (!holds) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace strata;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const auto period = parse_edtf(text);
  if (!period) {
    demand(period.error().code == ErrorCode::invalid && is_utf8(period.error().detail));
    return 0;
  }
  demand(text.size() <= kMaxPeriod && is_utf8(text));
  demand(period->first_day || period->last_day);
  if (period->first_day && period->last_day) demand(*period->first_day <= *period->last_day);
  const bool marked = text.find_last_of("?~%") == text.size() - 1;
  if (marked || text.ends_with('/') || text.ends_with("..") || text.size() == kMaxPeriod) return 0;
  const auto unsure = parse_edtf(text + "%");
  demand(unsure && unsure->approximate && unsure->uncertain);
  demand(unsure->first_day == period->first_day && unsure->last_day == period->last_day);
  return 0;
}
