#pragma once

#include <mutex>
#include <string>
#include <unordered_map>

#include "core/problem.h"
#include "net/http_types.h"
#include "net/token_bucket.h"

namespace strata::net {

// Slows guessing down: tries by one address, tries for one name, and all of them together, as each costs the server time and memory.
// Tries that were right cost nothing. Nobody is locked out for good. Thread-safe.
class SignInGate {
 public:
  using Clock = TokenBucket::Clock;
  // 429: too many tries. `name` may be empty: a secret of 256 bits is nobody's in particular.
  Result<void> pass(const std::string& address, const std::string& name, Clock::time_point now = Clock::now());
  // The try that was let through last was right.
  void was_right(const std::string& address, const std::string& name);

 private:
  struct Rate {
    double per_second, burst;
  };
  using Buckets = std::unordered_map<std::string, TokenBucket>;
  static TokenBucket& bucket(Buckets& buckets, const std::string& key, Rate rate, Clock::time_point now);

  std::mutex mutex_;
  Buckets by_address_, by_name_;
  TokenBucket all_{5, 20};
};

// Where a request comes from: the peer, or, where that is a proxy on this machine, whom it speaks for.
std::string address_of(const Request& request);

}  // namespace strata::net
