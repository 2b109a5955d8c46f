#include "net/live/edit_events.h"

#include <algorithm>
#include <utility>

namespace strata::net {

std::optional<EditEvents::Clock::duration> EditEvents::add(const protocol::LayerEvent& event,
                                                           Clock::duration interval,
                                                           Clock::time_point now) {
  const auto [place, fresh] = waiting_.try_emplace(std::pair(event.layer_id, event.user), event);
  if (!fresh) {
    const auto provisional = place->second.provisional;
    place->second = event;
    if (!place->second.provisional) place->second.provisional = provisional;
  }
  if (std::exchange(is_due_, true)) return std::nullopt;
  if (!taken_) return Clock::duration{};
  return std::max(Clock::duration{}, *taken_ + interval - now);
}

std::vector<protocol::LayerEvent> EditEvents::take(Clock::time_point now) {
  is_due_ = false;
  taken_ = now;
  return take_before();
}

std::vector<protocol::LayerEvent> EditEvents::take_before() {
  std::vector<protocol::LayerEvent> events;
  for (auto& [of, event] : waiting_) events.push_back(std::move(event));
  waiting_.clear();
  std::ranges::sort(events, {}, &protocol::LayerEvent::sequence);
  return events;
}

}  // namespace strata::net
