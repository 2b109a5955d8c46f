#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "domain/layers/key_numbers.h"
#include "expression/expression.h"

namespace strata::query {

// What is the same for all texels that hold one key: the largest parts of a formula over layers
// that read nothing but the record behind one layer's key. They are answered once a record, by the
// database, and looked up at each texel.
struct RecordPart {
  std::string layer;      // slug
  Expression expression;  // over columns (Names::columns): a number or a condition
  bool operator==(const RecordPart&) const = default;
};
struct SplitExpression {
  Expression expression;          // with Op::record_number and record_truth in place of the parts
  std::vector<RecordPart> parts;  // by their `index`
};
// Refused (invalid at `field`): texts and times of columns that are set beside something else than
// their own record.
Result<SplitExpression> split_records(const Expression& expression, const std::string& field);

// Numbers by key, for millions of questions.
class RecordNumbers {
 public:
  RecordNumbers() = default;
  explicit RecordNumbers(const std::vector<KeyNumber>& numbers);
  // NaN where nothing is known of the key.
  double of(std::uint32_t key) const {
    if (key < dense_.size()) return dense_[key];
    return sparse_.empty() ? kUnknown : look_up(key);
  }

 private:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  double look_up(std::uint32_t key) const;
  std::vector<double> dense_;      // of the keys from 0 on
  std::vector<KeyNumber> sparse_;  // of those beyond, ascending
};

}  // namespace strata::query
