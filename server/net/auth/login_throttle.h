#pragma once

#include <mutex>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "core/error.h"
#include "net/http/http_types.h"
#include "net/http/token_bucket.h"

namespace strata::net {

// Limits password guesses: tries per address, tries per name and address, and, with a limit far
// above that of one address, tries per name. Tries from other addresses do not block an address
// that signed in successfully before. Thread-safe.
class LoginThrottle {
 public:
  using Clock = TokenBucket::Clock;
  // 429: too many tries. `name` may be empty for a secret of 256 bits, which belongs to no name.
  Result<void> pass(const std::string& address, const std::string& name,
                    Clock::time_point now = Clock::now());
  // The last try was right, so it does not count as a guess.
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
  std::unordered_set<std::string> known_;  // name and address of successful sign-ins
};

// Returns the sender's address: the peer, or the client of a proxy on this machine. Of IPv6 only
// the first half, since one household chooses the rest.
std::string address_of(const Request& request);

}  // namespace strata::net
