#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>

namespace strata::net {

// Limits the rate of calls. Allows `per_second` calls on average and `burst` calls in a row. Not
// thread-safe.
class TokenBucket {
 public:
  using Clock = std::chrono::steady_clock;
  TokenBucket(double per_second, double burst, Clock::time_point now = Clock::now())
      : per_second_(per_second), burst_(burst), tokens_(burst), filled_at_(now) {}

  // Takes a token. Returns false if the calls are too fast.
  bool take(Clock::time_point now = Clock::now()) {
    if (!has_one(now)) return false;
    tokens_ -= 1;
    return true;
  }
  // Returns whether `take` would succeed.
  bool has_one(Clock::time_point now) {
    fill(now);
    return tokens_ >= 1;
  }
  // Returns whether the bucket is in its initial state.
  bool is_full(Clock::time_point now) {
    fill(now);
    return tokens_ >= burst_;
  }

  // Return how many calls would succeed now, and after how many whole seconds the bucket is full.
  int left(Clock::time_point now) {
    fill(now);
    return static_cast<int>(tokens_);
  }
  int full_in_s(Clock::time_point now) {
    fill(now);
    return static_cast<int>(std::ceil((burst_ - tokens_) / per_second_));
  }

  // Puts the token of the last `take` back into the bucket.
  void give_back() { tokens_ = std::min(burst_, tokens_ + 1); }

 private:
  void fill(Clock::time_point now) {
    const double elapsed_s = std::chrono::duration<double>(now - filled_at_).count();
    tokens_ = std::min(burst_, tokens_ + std::max(0.0, elapsed_s) * per_second_);
    filled_at_ = std::max(filled_at_, now);
  }

  double per_second_, burst_, tokens_;
  Clock::time_point filled_at_;
};

}  // namespace strata::net
