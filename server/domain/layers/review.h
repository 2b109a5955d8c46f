#pragma once

#include <optional>
#include <string_view>

namespace strata {

// The review state of an edit on a layer with review.
enum class Review {
  none,      // never needed a review
  pending,   // provisional: in force and marked, until a curator decides
  accepted,  // in force, as without review
  rejected,  // not in force
};
// Returns nothing for another name.
std::optional<Review> parse_review(std::string_view name);
std::string_view name(Review review);

// A curator's decision on edits.
enum class Decision {
  accept,
  reject,
  reopen,  // accepted or rejected edits wait again
};
std::optional<Decision> parse_decision(std::string_view name);
std::string_view name(Decision decision);
Review outcome(Decision decision);

}  // namespace strata
