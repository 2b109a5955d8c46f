#pragma once

#include <optional>
#include <string_view>

namespace strata {

// The review state of an edit. Only edits of a layer with review need a review.
enum class Review {
  none,      // the edit did not need a review
  pending,   // provisional: in force, but marked until a curator decides
  accepted,  // in force, like an edit without review
  rejected,  // not in force
};
// Returns nullopt for other names.
std::optional<Review> parse_review(std::string_view name);
std::string_view name(Review review);

// The decision of a curator about edits.
enum class Decision {
  accept,
  reject,
  reopen,  // the accepted or rejected edits wait for review again
};
std::optional<Decision> parse_decision(std::string_view name);
std::string_view name(Decision decision);
Review outcome(Decision decision);

}  // namespace strata
