#pragma once

#include <optional>
#include <string_view>

namespace strata {

// Where an edit stands on a layer whose edits wait for review.
enum class Review {
  none,      // it never waited for anybody
  pending,   // provisional: in force and marked, until a curator decides
  accepted,  // as if it had never waited
  rejected,  // not in force
};
// Nothing for a name of none of them.
std::optional<Review> parse_review(std::string_view name);
std::string_view name(Review review);

// What a curator makes of edits.
enum class Decision {
  accept,
  reject,
  reopen,  // what was accepted or rejected waits again
};
std::optional<Decision> parse_decision(std::string_view name);
std::string_view name(Decision decision);
Review outcome(Decision decision);

}  // namespace strata
