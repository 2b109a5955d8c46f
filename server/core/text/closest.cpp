#include "core/text/closest.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "core/text/search_text.h"

namespace strata {
namespace {

constexpr std::size_t kMaxLength = 100;  // in bytes; the cost grows with the square of the length
constexpr std::size_t kMinPrefix = 3;    // shorter names are not compared with beginnings of names

// Returns the optimal string alignment distance in bytes, because names are mostly ASCII. (It is
// the Levenshtein distance with transpositions, where no part is edited twice.) If the distance
// exceeds `limit`, returns any number above `limit`.
std::size_t distance(std::string_view a, std::string_view b, std::size_t limit) {
  const std::size_t difference = a.size() > b.size() ? a.size() - b.size() : b.size() - a.size();
  if (difference > limit) return limit + 1;
  std::array<std::array<std::size_t, kMaxLength + 1>, 3> rows{};  // the last three rows
  for (std::size_t j = 0; j <= b.size(); ++j) rows[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    auto& row = rows[i % 3];
    const auto &above = rows[(i + 2) % 3], &second_above = rows[(i + 1) % 3];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0u : 1u)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], second_above[j - 2] + 1);
    }
  }
  return rows[a.size() % 3][b.size()];
}

}  // namespace

std::vector<std::string> closest_names(std::string_view wrong, std::span<const std::string> names,
                                       std::size_t most) {
  if (wrong.empty() || wrong.size() > kMaxLength) return {};
  const std::string sought = search_text(wrong);
  if (sought.empty() || sought.size() > kMaxLength) return {};
  const std::size_t limit = std::max<std::size_t>(1, sought.size() / 3);
  std::vector<std::pair<std::size_t, const std::string*>> found;
  for (const std::string& name : names) {
    if (name.size() > kMaxLength || name == wrong) continue;
    const std::string candidate = search_text(name);
    if (candidate.empty() || candidate.size() > kMaxLength) continue;
    const std::size_t steps = distance(sought, candidate, limit);
    // A name with all its characters replaced is not a typing mistake.
    const bool is_typo = steps <= limit && steps < std::min(sought.size(), candidate.size());
    const auto shorter = std::min(sought.size(), candidate.size());
    const bool is_beginning =
        shorter >= kMinPrefix &&
        sought.substr(0, shorter) == std::string_view(candidate).substr(0, shorter);
    if (is_typo)
      found.emplace_back(steps, &name);
    else if (is_beginning)
      found.emplace_back(limit + 1, &name);
  }
  std::ranges::stable_sort(found, {}, &std::pair<std::size_t, const std::string*>::first);
  std::vector<std::string> closest;
  for (const auto& [steps, name] : found) {
    if (closest.size() == most) break;
    if (std::ranges::find(closest, *name) == closest.end()) closest.push_back(*name);
  }
  return closest;
}

}  // namespace strata
