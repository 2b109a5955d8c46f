#include "net/auth/login_throttle.h"

#include <boost/asio/ip/address.hpp>

namespace strata::net {
namespace {

constexpr std::size_t kMaxKeys = 100'000;

std::string both(const std::string& address, const std::string& name) {
  return to_lower(name) + " " + address;
}

}  // namespace

TokenBucket& LoginThrottle::bucket(Buckets& buckets, const std::string& key, Rate rate,
                                   Clock::time_point now) {
  if (buckets.size() >= kMaxKeys && !buckets.contains(key)) {
    for (auto at = buckets.begin(); at != buckets.end();)
      at = at->second.is_full(now) ? buckets.erase(at) : std::next(at);
    if (buckets.size() >= kMaxKeys) buckets.erase(buckets.begin());
  }
  return buckets.try_emplace(key, rate.per_second, rate.burst, now).first->second;
}

Result<void> LoginThrottle::pass(const std::string& address, const std::string& name,
                                 Clock::time_point now) {
  const auto refused = [] {
    return fail(ErrorCode::too_many_requests, "Too many sign-in attempts",
                "There were too many attempts to sign in. Wait ten seconds and try again.");
  };
  std::lock_guard lock(mutex_);
  TokenBucket& of_address = bucket(by_address_, address, {2, 60}, now);
  if (!of_address.has_one(now)) return refused();
  if (!name.empty()) {
    const std::string key = both(address, name);
    TokenBucket& of_both = bucket(by_both_, key, {0.1, 10}, now);
    TokenBucket& of_name = bucket(by_name_, to_lower(name), {0.5, 60}, now);
    if (!of_both.has_one(now) || (!known_.contains(key) && !of_name.has_one(now))) return refused();
    of_both.take(now);
    of_name.take(now);
  }
  of_address.take(now);
  return {};
}

void LoginThrottle::was_right(const std::string& address, const std::string& name) {
  if (name.empty()) return;
  std::lock_guard lock(mutex_);
  const std::string key = both(address, name);
  // The limit of the address still counts the attempt, because repeated sign-ins cost the server as
  // much as guesses.
  if (const auto found = by_both_.find(key); found != by_both_.end()) found->second.give_back();
  if (const auto found = by_name_.find(to_lower(name)); found != by_name_.end())
    found->second.give_back();
  if (known_.size() >= kMaxKeys) known_.erase(known_.begin());
  known_.insert(key);
}

std::string address_of(const Request& request) {
  using boost::asio::ip::make_address;
  boost::system::error_code bad;
  auto address = make_address(request.peer, bad);
  if (bad) return request.peer;
  const auto plain = [](const boost::asio::ip::address& given) {
    return given.is_v6() && given.to_v6().is_v4_mapped()
               ? boost::asio::ip::address(
                     boost::asio::ip::make_address_v4(boost::asio::ip::v4_mapped, given.to_v6()))
               : given;
  };
  address = plain(address);
  if (address.is_loopback()) {
    // The proxy adds the last entry of the last header. A client can forge the entries before it.
    std::string_view speaks_for;
    for (const auto& [key, value] : request.headers)
      if (key == "x-forwarded-for") speaks_for = value;
    speaks_for = speaks_for.substr(speaks_for.rfind(',') + 1);
    while (!speaks_for.empty() && speaks_for.front() == ' ') speaks_for.remove_prefix(1);
    while (!speaks_for.empty() && speaks_for.back() == ' ') speaks_for.remove_suffix(1);
    if (const auto parsed = make_address(std::string(speaks_for), bad); !bad)
      address = plain(parsed);
  }
  if (!address.is_v6()) return address.to_string();
  auto bytes = address.to_v6().to_bytes();
  std::fill(bytes.begin() + 8, bytes.end(), 0);
  return boost::asio::ip::address_v6(bytes).to_string() + "/64";
}

}  // namespace strata::net
