#pragma once

#include <mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "core/error.h"
#include "net/http/http_types.h"
#include "net/http/token_bucket.h"

namespace strata::net {

// Limits attempts to guess passwords. There is one limit per address, one per name and address, and
// one per name. The limit per name is far above the limit per name and address. Attempts from other
// addresses do not block an address from which the user signed in before. Thread-safe.
class LoginThrottle {
 public:
  using Clock = TokenBucket::Clock;
  // Returns 429 after too many attempts. `name` may be empty for a 256-bit secret, which belongs to
  // no name.
  Result<void> pass(const std::string& address, const std::string& name,
                    Clock::time_point now = Clock::now());
  // Call it after a correct attempt. The limits then ignore that attempt.
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
  std::unordered_set<std::string> known_;  // names and addresses of successful sign-ins
};

// Returns the address of the sender. The sender is the peer or, if the peer is a proxy on this
// machine, the client of the proxy. For IPv6, returns only the first half of the address because
// one household can choose the other half.
std::string address_of(const Request& request);

}  // namespace strata::net
