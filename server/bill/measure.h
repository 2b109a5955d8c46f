#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bill/exact_number.h"
#include "core/error.h"
#include "protocol/messages.h"

namespace strata::bill {

inline constexpr std::size_t kMaxLines = 20'000;  // of a bill

// An element of a rule: a record on a layer, or a class of a layer.
struct Element {
  std::string id;  // "layer 12 key 45"; names the element in the bill
  std::int64_t model = 0, layer = 0, table = 0, key = 0;  // 0: none
  std::string model_name, layer_name;
  std::string title;
  std::string link;      // path of the page that shows the element
  ExactNumber measured;  // in the unit of the position, without the factor
  ExactNumber size;      // in the unit of the size class
};

enum class Effect { billed, smallest, deducted, overmeasured, replaced };
std::string_view name(Effect effect);

// A line of the proof. A hand measurement has no rule.
struct Line {
  Element element;
  int rule = 0;  // from 1; 0: a hand measurement
  std::string figure;
  std::string formula, remark, user, time;  // of a hand measurement
  ExactNumber factor{1};
  ExactNumber billed;  // what the line adds to the sum
  Effect effect = Effect::billed;
};

struct Position {
  std::vector<Line> lines;
  ExactNumber quantity;
  std::optional<ExactNumber> total{};  // quantity times unit price, with 2 places
};

// Applies the size classes, deductions, rounding and hand measurements of a position.
// `elements[i]` are the elements of rule i. The bill must have passed check_bill. Returns an
// `invalid` error for a hand measurement that replaces an element that the position does not
// measure, and for numbers that are too large.
Result<Position> measure(const protocol::BillItem& item,
                         const std::vector<std::vector<Element>>& elements);

// Returns the rounding of a position as a short text: "sum, 2, half_up".
std::string rounding_text(const protocol::BillItem& item);

}  // namespace strata::bill
