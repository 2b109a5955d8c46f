#pragma once

#include <mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "core/error.h"
#include "net/http/http_types.h"
#include "net/http/token_bucket.h"

namespace strata::net {

// Slows guessing down: tries by an address, tries for a name by an address, and, far above what one
// address can do, tries for a name by all. Whoever was right from an address is not held up there
// by what others try from elsewhere. Thread-safe.
class LoginThrottle {
 public:
  using Clock = TokenBucket::Clock;
  // 429: too many tries. `name` may be empty: a secret of 256 bits is nobody's in particular.
  Result<void> pass(const std::string& address, const std::string& name,
                    Clock::time_point now = Clock::now());
  // The try that was let through last was right: it is no guess.
  void was_right(const std::string& address, const std::string& name);

 private:
  struct Rate {
    double per_second, burst;
  };
  using Buckets = std::unordered_map<std::string, TokenBucket>;
  static TokenBucket& bucket(Buckets& buckets, const std::string& key, Rate rate,
                             Clock::time_point now);

  std::mutex mutex_;
  Buckets by_address_, by_both_, by_name_;
  std::unordered_set<std::string> known_;  // name and address of those who were right
};

// Where a request comes from: the peer, or, where that is a proxy on this machine, whom it speaks
// for. Of IPv6 the first half: the rest is one household's to choose from.
std::string address_of(const Request& request);

}  // namespace strata::net
