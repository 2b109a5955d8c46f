#include "net/sign_in_gate.h"

namespace strata::net {
namespace {

constexpr std::size_t kMostKeys = 10'000;

bool is_loopback(std::string_view address) { return address.starts_with("127.") || address == "::1"; }

}  // namespace

TokenBucket& SignInGate::bucket(Buckets& buckets, const std::string& key, Rate rate, Clock::time_point now) {
  // Of so many at once, those who try anew are no better than those who did before: `all_` holds them.
  if (buckets.size() >= kMostKeys && !buckets.contains(key)) buckets.clear();
  return buckets.try_emplace(key, rate.per_second, rate.burst, now).first->second;
}

Result<void> SignInGate::pass(const std::string& address, const std::string& name, Clock::time_point now) {
  std::lock_guard lock(mutex_);
  // An address first: whoever is too fast takes nothing from others.
  if (bucket(by_address_, address, {1, 20}, now).take(now) &&
      (name.empty() || bucket(by_name_, to_lower(name), {0.1, 10}, now).take(now)) && all_.take(now))
    return {};
  return fail(429, "Too many sign-ins", "There were too many tries. Wait ten seconds and try again.");
}

void SignInGate::was_right(const std::string& address, const std::string& name) {
  std::lock_guard lock(mutex_);
  if (const auto found = by_address_.find(address); found != by_address_.end()) found->second.give_back();
  if (const auto found = by_name_.find(to_lower(name)); found != by_name_.end()) found->second.give_back();
  all_.give_back();
}

std::string address_of(const Request& request) {
  if (!is_loopback(request.peer)) return request.peer;
  const std::string_view speaks_for = request.header("x-forwarded-for");
  if (speaks_for.empty()) return request.peer;
  // The last is what the proxy itself saw; what is before it anybody may have written.
  const auto comma = speaks_for.rfind(',');
  std::string_view last = comma == std::string_view::npos ? speaks_for : speaks_for.substr(comma + 1);
  while (!last.empty() && last.front() == ' ') last.remove_prefix(1);
  return std::string(last.substr(0, 64));
}

}  // namespace strata::net
