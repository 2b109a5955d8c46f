// Fuzzes the readers of bills of quantities. The first byte selects the reader: a formula of a hand
// measurement, or a GAEB file. A file that is read must pass the checks of bills after the groups
// are complete, and what is written must be read again with the same positions.
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "bill/check_bill.h"
#include "bill/formula.h"
#include "bill/gaeb.h"
#include "bill/items.h"
#include "core/text/utf8.h"

namespace {

using namespace strata;

void demand(bool holds) {
  if (!holds) std::abort();
}

void check_formula(std::string_view text) {
  const auto value = bill::compute_formula(text, "formula");
  if (value) demand(value->is_valid());
}

void check_file(std::string_view text) {
  const auto read = bill::read_gaeb(text);
  if (!read || !bill::check_bill(read->bill)) return;
  const auto items = bill::items_of(read->bill);
  std::vector<bill::Position> positions;
  for (const protocol::BillItem& item : items) {
    demand(is_utf8(item.short_text) && is_utf8(item.long_text) && is_utf8(item.unit));
    const auto position = bill::measure(item, {});
    if (!position) return;
    positions.push_back(*position);
  }
  const auto written = bill::write_gaeb(read->bill, positions, bill::GaebPhase::x83,
                                        {"P", "2026-01-01", "00:00:00"});
  if (!written) return;
  const auto again = bill::read_gaeb(*written);
  demand(again.has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  if (data[0] % 2 == 0)
    check_formula(text);
  else
    check_file(text);
  return 0;
}
