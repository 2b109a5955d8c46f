#include "domain/layers/review.h"

#include <algorithm>
#include <array>

namespace strata {
namespace {

constexpr std::array<std::string_view, 4> kReviews{"none", "pending", "accepted", "rejected"};
constexpr std::array<std::string_view, 3> kDecisions{"accept", "reject", "reopen"};

template <class Value, std::size_t count>
std::optional<Value> parse(const std::array<std::string_view, count>& names,
                           std::string_view text) {
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) return std::nullopt;
  return static_cast<Value>(found - names.begin());
}

}  // namespace

std::optional<Review> parse_review(std::string_view text) { return parse<Review>(kReviews, text); }
std::string_view name(Review review) { return kReviews[static_cast<std::size_t>(review)]; }

std::optional<Decision> parse_decision(std::string_view text) {
  return parse<Decision>(kDecisions, text);
}
std::string_view name(Decision decision) { return kDecisions[static_cast<std::size_t>(decision)]; }

Review outcome(Decision decision) {
  switch (decision) {
    case Decision::accept: return Review::accepted;
    case Decision::reject: return Review::rejected;
    case Decision::reopen: break;
  }
  return Review::pending;
}

}  // namespace strata
