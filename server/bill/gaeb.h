#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bill/measure.h"
#include "core/error.h"
#include "protocol/messages.h"

// GAEB DA XML 3.3 (edition 2021-05), the German exchange format for bills of quantities. A bill in
// it is a tree of groups (`BoQCtgy`) and positions (`Item`), whose ordinal number consists of the
// `RNoPart` of each level.
namespace strata::bill {

inline constexpr std::size_t kMaxGaebBytes = std::size_t{16} << 20;

struct GaebBill {
  protocol::BillWrite bill;
  std::string phase;                   // "83"
  std::vector<std::string> remarks{};  // what was left out or changed, for the user
};

// Reads the bill in a file of the phases X80 to X86 of GAEB DA XML 3.0 to 3.3: numbers, short and
// long texts, units, quantities and unit prices. The texts lose their formatting but not their
// paragraphs. Returns an `unsupported` error with what to do for GAEB 90, GAEB 2000 and other
// phases, and an `invalid` or `malformed` error for damaged files.
Result<GaebBill> read_gaeb(std::string_view bytes);

enum class GaebPhase {
  x31,  // quantities with the proof lines, as REB 23.003 rows
  x83,  // tender: quantities without prices
  x84,  // bid: the prices of the tender
  x86,  // contract: measured quantities with prices
};
std::optional<GaebPhase> parse_gaeb_phase(std::string_view name);  // "x83"
std::string_view number_of(GaebPhase phase);                       // "83"

struct GaebFacts {
  std::string project;
  std::string date, time;  // "2026-12-01", "09:30:00"
};

// Writes a bill. `positions` has an entry for each item; those of groups are empty. X83 and X84
// contain the tendered quantities, or the measured ones of positions without them. Returns an
// `invalid` error for a bill that the format does not allow: positions on different levels, without
// a unit, or without a price in X84 and X86, and numbers that are too large.
Result<std::string> write_gaeb(const protocol::BillWrite& bill, std::span<const Position> positions,
                               GaebPhase phase, const GaebFacts& facts);

}  // namespace strata::bill
