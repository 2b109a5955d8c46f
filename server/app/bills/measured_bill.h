#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "app/bills/bill_elements.h"
#include "bill/measure.h"

namespace strata::app {

struct MeasuredBill {
  protocol::BillWrite bill;
  std::vector<bill::Position> positions;  // one for each item; empty for groups
  bill::ExactNumber total;                // of the totals of the positions
};

// Measures all positions of a bill in the newest state of the models. Errors name the item and the
// member: "items[3].rules[0].table". Returns an `invalid` error for a bill with more than
// bill::kMaxLines lines. Blocks, and checks the current question.
Result<MeasuredBill> measured_bill(const Services& services, const BillSource& source,
                                   protocol::BillWrite bill);

// Returns the positions and the total as in the contract (BillQuantities), without the id and
// version of the bill.
nlohmann::json to_json(const MeasuredBill& bill);

}  // namespace strata::app
