#include "domain/layers/classification.h"

#include <algorithm>
#include <map>

namespace strata {

std::vector<NumberClass> classify(std::span<const double> numbers, ClassMethod method, int count) {
  std::vector<double> sorted(numbers.begin(), numbers.end());
  std::ranges::sort(sorted);
  if (sorted.empty() || count < 1) return {};
  std::vector<double> limits{sorted.front()};
  const auto n = static_cast<std::size_t>(count);
  for (std::size_t i = 1; i < n; ++i) {
    const double share = static_cast<double>(i) / count;
    // Does not compute the difference of the two ends, because it may overflow.
    const double limit = method == ClassMethod::equal
                             ? sorted.front() * (1 - share) + sorted.back() * share
                             : sorted[i * sorted.size() / n];
    if (limit > limits.back() && limit < sorted.back()) limits.push_back(limit);
    // If a quantile equals the largest number, the last class contains only this number.
    if (method == ClassMethod::quantile && limit == sorted.back() && limit > limits.back())
      limits.push_back(limit);
  }
  std::vector<NumberClass> classes;
  auto begin = sorted.begin();
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const bool last = i + 1 == limits.size();
    const auto end = last ? sorted.end() : std::lower_bound(begin, sorted.end(), limits[i + 1]);
    classes.push_back(
        {limits[i], last ? sorted.back() : limits[i + 1], static_cast<std::uint64_t>(end - begin)});
    begin = end;
  }
  return classes;
}

std::vector<TextClass> classify(std::span<const std::string> values) {
  std::map<std::string_view, std::uint64_t> counts;
  for (const std::string& value : values) ++counts[value];
  std::vector<TextClass> classes;
  for (const auto& [value, count] : counts) classes.push_back({std::string(value), count});
  std::ranges::stable_sort(classes, std::ranges::greater(), &TextClass::count);
  return classes;
}

}  // namespace strata
