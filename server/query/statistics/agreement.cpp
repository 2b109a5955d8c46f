#include "query/statistics/agreement.h"

#include <algorithm>
#include <limits>
#include <map>
#include <string>

#include "core/compensated_sum.h"
#include "core/text/ascii.h"
#include "core/text/search_text.h"
#include "domain/layers/layer.h"

namespace strata::query {
namespace {

struct Sums {
  CompensatedSum both, first, second;
};

// Sorts "not painted" after all keys.
struct KeyOrder {
  bool operator()(const CrossTable::Key& a, const CrossTable::Key& b) const {
    constexpr double kLast = std::numeric_limits<double>::infinity();
    return a.value_or(kLast) < b.value_or(kLast);
  }
};

std::string comparable_name(const Palette::Point& point) {
  return search_text(trimmed(point.label));
}

}  // namespace

double ClassAgreement::iou() const {
  return std::min(1.0, both_m2 / (first_m2 + (second_m2 - both_m2)));
}

double ClassAgreement::f1() const { return std::min(1.0, 2 * both_m2 / (first_m2 + second_m2)); }

bool share_classes(const Layer& first, const Layer& second) {
  if (first.kind != second.kind || first.table != second.table) return false;
  if (first.table) return true;
  if (!lists_values(first.palette) || !lists_values(second.palette)) return false;
  std::map<double, const Palette::Point*> listed;
  for (const Palette::Point& point : first.palette.points) listed.emplace(point.at, &point);
  bool has_common_key = listed.empty() || second.palette.points.empty();
  for (const Palette::Point& point : second.palette.points) {
    const auto same_key = listed.find(point.at);
    if (same_key == listed.end()) continue;
    has_common_key = true;
    const std::string name = comparable_name(*same_key->second), other = comparable_name(point);
    if (!name.empty() && !other.empty() && name != other) return false;
  }
  return has_common_key;
}

std::optional<Agreement> measure_agreement(const CrossTable& table) {
  std::map<CrossTable::Key, Sums, KeyOrder> sums;
  CompensatedSum agreed_painted, apart;
  const auto add = [&](const CrossTable::Key& row, const CrossTable::Key& column, double area_m2) {
    if (area_m2 <= 0) return;
    if (row == column) {
      sums[row].both += area_m2;
      if (row) agreed_painted += area_m2;
    } else {
      apart += area_m2;
    }
    sums[row].first += area_m2;
    sums[column].second += area_m2;
  };
  for (std::size_t row = 0; row < table.rows.size(); ++row)
    for (std::size_t column = 0; column < table.columns.size(); ++column)
      add(table.rows[row], table.columns[column], table.area_m2[row][column]);
  add({}, {}, table.neither_m2);
  if (sums.empty()) return std::nullopt;

  const double painted_m2 = agreed_painted.value() + apart.value();
  Agreement agreement;
  agreement.area_m2 = painted_m2 + table.neither_m2;
  agreement.observed = (agreed_painted.value() + table.neither_m2) / agreement.area_m2;
  if (painted_m2 > 0) agreement.observed_painted = agreed_painted.value() / painted_m2;
  // The expected disagreement is summed from pairs of different classes. If nearly everything has
  // the same class, `1 - expected` would lose most of its digits.
  CompensatedSum expected_apart;
  double first_before = 0, second_before = 0;
  for (const auto& [key, of_class] : sums) {
    const ClassAgreement found{key, of_class.both.value(), of_class.first.value(),
                               of_class.second.value()};
    const double first = found.first_m2 / agreement.area_m2,
                 second = found.second_m2 / agreement.area_m2;
    expected_apart += first * second_before + second * first_before;
    first_before += first;
    second_before += second;
    agreement.classes.push_back(found);
  }
  agreement.expected = std::clamp(1 - expected_apart.value(), 0.0, 1.0);
  if (expected_apart.value() > 0)
    agreement.kappa =
        std::max(-1.0, 1 - apart.value() / agreement.area_m2 / expected_apart.value());
  return agreement;
}

}  // namespace strata::query
