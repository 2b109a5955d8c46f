#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "domain/layers/key_numbers.h"
#include "expression/expression.h"

namespace strata::query {

// A part of a formula that has the same value for all texels with one key: a largest part that
// reads only the record of one layer's key. The database evaluates it once per record, and each
// texel looks up the result.
struct RecordPart {
  std::string layer;      // slug
  Expression expression;  // over columns (Names::columns): a number or a condition
  bool operator==(const RecordPart&) const = default;
};
struct SplitExpression {
  Expression expression;          // with Op::record_number and record_truth instead of the parts
  std::vector<RecordPart> parts;  // by their `index`
};
// Refused (invalid at `field`): texts and times of columns that are combined with anything except
// their own record.
Result<SplitExpression> split_records(const Expression& expression, const std::string& field);

// Numbers by key, for millions of look-ups.
class RecordNumbers {
 public:
  RecordNumbers() = default;
  explicit RecordNumbers(const std::vector<KeyNumber>& numbers);
  // NaN: unknown.
  double of(std::uint32_t key) const {
    if (key < dense_.size()) return dense_[key];
    return sparse_.empty() ? kUnknown : look_up(key);
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  double look_up(std::uint32_t key) const;
  std::vector<double> dense_;      // of the keys from 0 on
  std::vector<KeyNumber> sparse_;  // of higher keys, ascending
};

}  // namespace strata::query
