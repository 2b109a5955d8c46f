#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "domain/layers/key_numbers.h"
#include "expression/expression.h"

namespace strata::query {

// A part of a formula that has the same value for all texels with the same key. It reads only the
// record of one layer's key, and is as large as possible. The database evaluates it once per
// record, and each texel looks up the result.
struct RecordPart {
  std::string layer;      // slug of the layer
  Expression expression;  // over columns (Names::columns); a number or a condition
  bool operator==(const RecordPart&) const = default;
};
struct SplitExpression {
  Expression expression;          // has Op::record_number and record_truth in place of the parts
  std::vector<RecordPart> parts;  // by the `index` in the expression
};
// Returns an `invalid` error at `field` if the text or time of a column is combined with anything
// except its own record, and for a function along the surface (separate_surface_functions).
Result<SplitExpression> split_records(const Expression& expression, const std::string& field);

// Numbers by key. Supports millions of look-ups.
class RecordNumbers {
 public:
  RecordNumbers() = default;
  explicit RecordNumbers(const std::vector<KeyNumber>& numbers);
  // Returns NaN if the number is unknown.
  double of(std::uint32_t key) const {
    if (key < dense_.size()) return dense_[key];
    return sparse_.empty() ? kUnknown : look_up(key);
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  double look_up(std::uint32_t key) const;
  std::vector<double> dense_;      // by key, from key 0
  std::vector<KeyNumber> sparse_;  // higher keys, ascending
};

}  // namespace strata::query
