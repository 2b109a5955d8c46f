#pragma once

#include <span>

#include "protocol/messages.h"

namespace strata::bill {

inline std::span<const protocol::BillItem> items_of(const protocol::BillWrite& bill) {
  return bill.items ? std::span(*bill.items) : std::span<const protocol::BillItem>{};
}
inline std::span<const protocol::BillRule> rules_of(const protocol::BillItem& item) {
  return item.rules ? std::span(*item.rules) : std::span<const protocol::BillRule>{};
}
inline std::span<const protocol::HandMeasurement> measurements_of(const protocol::BillItem& item) {
  return item.measurements ? std::span(*item.measurements)
                           : std::span<const protocol::HandMeasurement>{};
}

}  // namespace strata::bill
