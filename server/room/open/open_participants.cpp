#include "room/open/open_participants.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <set>
#include <utility>

#include "room/open/open_participant.h"

namespace strata::room {
namespace {

constexpr std::chrono::seconds kEditsFor{2};

}  // namespace

std::unique_ptr<Participant> OpenRoom::ParticipantsPart::join(Author who, Portrait portrait,
                                                              Listener* listener,
                                                              stream::SendFrames send) {
  std::unique_ptr<OpenParticipant> joined;
  {
    std::lock_guard lock(mutex_);
    joined = std::make_unique<OpenParticipant>(room_.shared_from_this(), std::move(who),
                                               std::move(portrait), listener, std::move(send));
    here_.push_back(joined.get());
  }
  room_.touch();
  announce_presence();
  tell_state(joined->session());
  return joined;
}

void OpenRoom::ParticipantsPart::tell_state(const Uuid& session) {
  boost::asio::post(room_.strand_, [room = room_.shared_from_this(), this, session] {
    if (!room->moved_ && room->is_current_) return;
    std::lock_guard lock(mutex_);
    for (OpenParticipant* each : here_) {
      if (each->session() != session) continue;
      if (room->moved_)
        each->tell_moved(room->moved_->location);
      else if (each->listener())
        each->listener()->database_reachable(false);
    }
  });
}

void OpenRoom::ParticipantsPart::tell(const std::function<void(Listener&)>& tell) {
  std::lock_guard lock(mutex_);
  for (OpenParticipant* each : here_)
    if (each->listener()) tell(*each->listener());
}

void OpenRoom::ParticipantsPart::tell_moved(const std::string& url) {
  std::lock_guard lock(mutex_);
  for (OpenParticipant* each : here_) each->tell_moved(url);
}

void OpenRoom::ParticipantsPart::tell_seen(const Layer& layer,
                                           const std::function<void(Listener&)>& tell) {
  std::lock_guard lock(mutex_);
  for (OpenParticipant* each : here_)
    if (each->listener() && sees(each->role(), layer.visibility)) tell(*each->listener());
}

void OpenRoom::ParticipantsPart::tell_layer(std::optional<Visibility> before, const Layer& layer) {
  using Change = Listener::LayerChange;
  std::lock_guard lock(mutex_);
  for (OpenParticipant* each : here_) {
    const bool saw = before && sees(each->role(), *before),
               sees_now = sees(each->role(), layer.visibility);
    if (!each->listener() || (!saw && !sees_now)) continue;
    each->listener()->layer_changed(!sees_now ? Change::deleted
                                    : saw     ? Change::changed
                                              : Change::created,
                                    layer);
  }
}

void OpenRoom::ParticipantsPart::tell_unsaved(const std::vector<Listener::Edit>& edits,
                                              const Error& why) {
  std::lock_guard lock(mutex_);
  for (const OpenParticipant* each : here_) {
    if (!each->listener()) continue;
    std::vector<Listener::Edit> seen;
    for (const Listener::Edit& edit : edits)
      if (const auto state = room_.layer_state(edit.layer_id);
          state && sees(each->role(), state->layer.visibility))
        seen.push_back(edit);
    if (!seen.empty()) each->listener()->edits_unsaved(seen, why);
  }
}

void OpenRoom::ParticipantsPart::content_changed(
    const Layer& layer, const std::optional<render::FrameRequest::Box>& box,
    std::int64_t sequence) {
  std::lock_guard lock(mutex_);
  // First the people who edit now, so that the GPU does not begin a frame for somebody else before
  // it has the author's request. After a workshop, everybody has edited at some time.
  const auto lately = OpenParticipant::Clock::now() - kEditsFor;
  std::vector<OpenParticipant*> onlookers;
  for (OpenParticipant* each : here_)
    if (each->has_edited_since(lately))
      each->content_changed(layer, box, sequence);
    else
      onlookers.push_back(each);
  for (OpenParticipant* each : onlookers) each->content_changed(layer, box, sequence);
}

void OpenRoom::ParticipantsPart::styles_changed() {
  std::lock_guard lock(mutex_);
  for (OpenParticipant* each : here_) each->styles_changed();
}

void OpenRoom::ParticipantsPart::model_changed(render::ModelHandle model) {
  std::lock_guard lock(mutex_);
  for (OpenParticipant* each : here_) each->model_changed(model);
}

void OpenRoom::ParticipantsPart::leave(OpenParticipant* participant) {
  {
    std::lock_guard lock(mutex_);
    left_ += std::erase(here_, participant);
    followers_.leave(participant->session());
  }
  room_.touch();
  announce_presence();
}

void OpenRoom::ParticipantsPart::announce_presence() {
  boost::asio::post(room_.strand_, [room = room_.shared_from_this(), this] {
    tell([](Listener& listener) { listener.presence_changed(); });
  });
}

Result<void> OpenRoom::ParticipantsPart::follow(const Uuid& follower,
                                                const std::optional<Uuid>& leader) {
  bool other = false;
  {
    std::lock_guard lock(mutex_);
    if (!leader) {
      other = followers_.stop(follower);
    } else {
      if (!is_here(*leader) && !elsewhere_.has(*leader))
        return fail(ErrorCode::not_found, "Session not found",
                    "The session that you want to follow does not exist or has left this model. "
                    "See the list of sessions in `presence`.",
                    "follow");
      other = STRATA_TRY(followers_.follow(follower, *leader));
    }
  }
  if (other) announce_presence();
  return {};
}

void OpenRoom::ParticipantsPart::camera_moved(const Uuid& session) {
  {
    std::lock_guard lock(mutex_);
    if (!followers_.has_followers(session)) return;
  }
  boost::asio::post(room_.strand_, [room = room_.shared_from_this(), this, session] {
    std::lock_guard lock(mutex_);
    for (OpenParticipant* each : here_)
      if (each->listener() && followers_.leader_of(each->session()) == session)
        each->listener()->presence_changed();
  });
}

std::vector<Presence> OpenRoom::ParticipantsPart::presence(const Uuid& receiver) const {
  std::lock_guard lock(mutex_);
  const auto leader = followers_.leader_of(receiver);
  std::vector<Presence> people;
  const auto add = [&](Presence person) {
    person.following = followers_.leader_of(person.session);
    if (leader != person.session) person.camera.reset();
    people.push_back(std::move(person));
  };
  for (const OpenParticipant* each : here_) add(each->presence());
  elsewhere_.each(add);
  return people;
}

bool OpenRoom::ParticipantsPart::has_people_elsewhere() const {
  std::lock_guard lock(mutex_);
  return !elsewhere_.empty();
}

std::vector<Presence> OpenRoom::ParticipantsPart::people_here() const {
  std::lock_guard lock(mutex_);
  std::set<Uuid> followed;  // by people at other nodes
  elsewhere_.each([&](const Presence& person) {
    if (const auto leader = followers_.leader_of(person.session)) followed.insert(*leader);
  });
  std::vector<Presence> people;
  for (const OpenParticipant* each : here_) {
    if (!each->is_person()) continue;
    Presence& person = people.emplace_back(each->presence());
    person.following = followers_.leader_of(person.session);
    if (!followed.contains(person.session)) person.camera.reset();
  }
  return people;
}

void OpenRoom::ParticipantsPart::take_people(const Uuid& node, std::vector<Presence> people,
                                             PeopleElsewhere::Clock::time_point now) {
  std::lock_guard lock(mutex_);
  std::erase_if(people, [this](const Presence& person) { return is_here(person.session); });
  auto change = elsewhere_.replace(node, std::move(people), now);
  for (const Uuid& session : change.left) followers_.leave(session);
  // First end what has ended, so that it makes no cycle with what has begun.
  elsewhere_.each_at(node, [&](const Presence& person) {
    if (followers_.leader_of(person.session) != person.following)
      change.any = followers_.stop(person.session) || change.any;
  });
  elsewhere_.each_at(
      node, [&](const Presence& person) { change.any = follow_elsewhere(person) || change.any; });
  announce(change);
}

void OpenRoom::ParticipantsPart::forget_silent_nodes(PeopleElsewhere::Clock::time_point now) {
  std::lock_guard lock(mutex_);
  const auto change = elsewhere_.forget_silent(now);
  for (const Uuid& session : change.left) followers_.leave(session);
  announce(change);
}

void OpenRoom::ParticipantsPart::announce(const PeopleElsewhere::Change& change) {
  if (change.any) return announce_presence();
  for (const Uuid& session : change.cameras) camera_moved(session);
}

bool OpenRoom::ParticipantsPart::follow_elsewhere(const Presence& person) {
  const auto& leader = person.following;
  // A leader at a third node may be in a list that has not arrived yet. Lists are sent repeatedly.
  if (!leader || !(is_here(*leader) || elsewhere_.has(*leader))) return false;
  if (const auto followed = followers_.follow(person.session, *leader)) return *followed;
  // People at several nodes began to follow each other at the same time. Each node removes its own
  // people from the cycle, and then refuses their requests to follow again, until it receives that
  // the cycle has ended at the other node.
  bool changed = false;
  for (auto ahead = leader; ahead && *ahead != person.session;) {
    const auto next = followers_.leader_of(*ahead);
    if (is_here(*ahead)) changed = followers_.stop(*ahead) || changed;
    ahead = next;
  }
  if (changed) (void)followers_.follow(person.session, *leader);
  return changed;
}

bool OpenRoom::ParticipantsPart::is_here(const Uuid& session) const {
  return std::any_of(here_.begin(), here_.end(),
                     [&](const auto* each) { return each->session() == session; });
}

std::size_t OpenRoom::ParticipantsPart::count() const {
  std::lock_guard lock(mutex_);
  return here_.size();
}

std::size_t OpenRoom::ParticipantsPart::take_leave_count() {
  std::lock_guard lock(mutex_);
  return std::exchange(left_, 0);
}

}  // namespace strata::room
