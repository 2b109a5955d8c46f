#include "room/presence_exchange.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "core/log.h"
#include "room/open/open_participants.h"
#include "room/open/open_room.h"
#include "store/nodes/nodes.h"
#include "store/nodes/presence_channel.h"
#include "store/store.h"

namespace strata::room {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kStopWithin{100};
constexpr milliseconds kRetryAfter{1000};
constexpr std::chrono::seconds kLogEvery{60};

}  // namespace

static_assert(PresenceExchange::kEvery * kMaxPresenceParts + PresenceExchange::kRepeatAfter <
                  PeopleElsewhere::kSilentAfter,
              "the next list arrives before the people of a node are forgotten");

PresenceExchange::PresenceExchange(store::Store& store, const Uuid& node, OpenRooms rooms)
    : node_(node), rooms_(std::move(rooms)), channel_(store.nodes().presence(node)) {
  thread_ = std::thread([this] { run(); });
}

PresenceExchange::~PresenceExchange() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

bool PresenceExchange::pause(milliseconds time) {
  std::unique_lock lock(mutex_);
  return !changed_.wait_for(lock, time, [this] { return stopping_; });
}

void PresenceExchange::run() {
  while (pause(milliseconds(0))) {
    if (reconnects_.exchange(false)) channel_->disconnect();
    const auto done = exchange();
    for (const auto& room : rooms_()) room->people().forget_silent_nodes(Clock::now());
    if (!done && !fails_)
      log::warning("presence messages of other nodes cannot be exchanged: " + done.error().detail);
    if (done && fails_) log::info("presence messages of other nodes can be exchanged again");
    fails_ = !done;
    if (!done && !pause(kRetryAfter)) return;
  }
}

// Holds no room while it waits, so rooms without participants can be closed.
Result<void> PresenceExchange::exchange() {
  const auto texts = STRATA_TRY(channel_->receive(kStopWithin));
  for (const std::string& text : texts) receive(text);
  // If this node has no lease, the lists are not sent. They are repeated later in any case.
  const auto sent = channel_->send(due(Clock::now()));
  if (sent) return {};
  if (sent.error().code != ErrorCode::busy) return tl::unexpected(sent.error());
  // Receives in any case. The next lists are sent when the database is less busy.
  warn_rarely(unsent_,
              "the people at this node could not be sent to other nodes: " + sent.error().detail);
  return {};
}

void PresenceExchange::receive(const std::string& text) {
  auto part = parse_presence(text);
  if (!part) return refuse(part.error().detail);
  if (part->node == node_) return;
  const Uuid node = part->node;
  const ModelId model = part->model;
  auto people = joined(std::move(*part));
  if (!people) return;
  const auto rooms = rooms_();
  const auto room = std::ranges::find(rooms, model, [](const auto& each) { return each->id(); });
  if (room != rooms.end()) (*room)->people().take_people(node, std::move(*people), Clock::now());
}

// The parts of a list arrive one after the other, because they are sent in one transaction.
std::optional<std::vector<Presence>> PresenceExchange::joined(PresenceMessage part) {
  if (part.part == 0) {
    begun_ = std::move(part);
  } else {
    if (!begun_ || begun_->node != part.node || begun_->model != part.model ||
        begun_->parts != part.parts || begun_->part + 1 != part.part) {
      begun_.reset();
      refuse("The parts of a list do not belong together.");
      return std::nullopt;
    }
    begun_->part = part.part;
    std::ranges::move(part.people, std::back_inserter(begun_->people));
  }
  if (begun_->part + 1 < begun_->parts) return std::nullopt;
  auto people = std::move(begun_->people);
  begun_.reset();
  return people;
}

void PresenceExchange::refuse(const std::string& why) {
  warn_rarely(refused_, "a presence message was refused: " + why);
}

void PresenceExchange::warn_rarely(LastLogged& last, const std::string& line) {
  const auto now = Clock::now();
  if (last && now - *last < kLogEvery) return;
  last = now;
  log::warning(line);
}

std::vector<std::string> PresenceExchange::due(Clock::time_point now) {
  std::vector<std::string> all;
  std::set<ModelId> open;
  for (const auto& room : rooms_()) {
    const ModelId model = room->id();
    open.insert(model);
    const auto last = sent_.find(model);
    const bool was_sent = last != sent_.end();
    const auto age = was_sent ? now - last->second.time : Clock::duration::max();
    if (was_sent && age < kEvery * static_cast<int>(last->second.texts.size())) continue;
    OpenRoom::ParticipantsPart& here = room->people();
    std::vector<Presence> people;
    if (room->following() || here.has_people_elsewhere()) people = here.people_here();
    if (people.empty() && !was_sent) continue;
    auto texts = presence_texts(node_, model, people);
    // An empty list is not repeated.
    if (was_sent && texts == last->second.texts && (people.empty() || age < kRepeatAfter)) continue;
    std::ranges::copy(texts, std::back_inserter(all));
    sent_.insert_or_assign(model, Sent{std::move(texts), now});
  }
  std::erase_if(sent_, [&](const auto& entry) {
    if (open.contains(entry.first)) return false;
    // The room was closed, so its people have left.
    std::ranges::move(presence_texts(node_, entry.first, {}), std::back_inserter(all));
    return true;
  });
  return all;
}

}  // namespace strata::room
