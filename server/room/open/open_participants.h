#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "room/listener.h"
#include "room/open/followers.h"
#include "room/open/open_room.h"
#include "room/open/people_elsewhere.h"
#include "room/participants.h"

namespace strata::room {

class OpenParticipant;

// The participants of an open room, and their notifications.
class OpenRoom::ParticipantsPart final : public Participants {
 public:
  explicit ParticipantsPart(OpenRoom& room) : room_(room) {}
  std::unique_ptr<Participant> join(Author who, Portrait portrait, Listener* listener,
                                    stream::SendFrames send) override;
  std::vector<Presence> presence(const Uuid& receiver) const override;

  // --- for each participant
  void leave(OpenParticipant* participant);
  void announce_presence();
  // Notifies a participant who joined after the others had been notified that the model moved, or
  // that the node has no database.
  void tell_state(const Uuid& session);
  // Replaces the former leader, who can also be at another node. nullopt: the follower has no
  // leader. Returns the error `not_found` if nobody has that session, and the same errors as
  // Followers.
  Result<void> follow(const Uuid& follower, const std::optional<Uuid>& leader);
  void camera_moved(const Uuid& session);  // notifies the followers of the session

  // --- for the room
  void tell(const std::function<void(Listener&)>& tell);  // notifies every listener
  void tell_moved(const std::string& url);                // notifies every listener, once
  // Notifies the listeners who see the layer.
  void tell_seen(const Layer& layer, const std::function<void(Listener&)>& tell);
  // Sends a creation to listeners who begin to see the layer, and a deletion to listeners who no
  // longer see it. `before` is nullopt for a new layer.
  void tell_layer(std::optional<Visibility> before, const Layer& layer);
  void tell_unsaved(const std::vector<Listener::Edit>& edits, const Error& why);
  void content_changed(const Layer& layer, const std::optional<render::FrameRequest::Box>& box,
                       std::int64_t sequence);
  void styles_changed();
  void model_changed(render::ModelHandle model);
  // --- for the other nodes (room/presence_exchange.h)
  bool has_people_elsewhere() const;
  // Returns the people at this node, without kiosks. They have cameras only if somebody at another
  // node follows them.
  std::vector<Presence> people_here() const;
  // Replaces the people at another node, and notifies listeners of what has changed.
  void take_people(const Uuid& node, std::vector<Presence> people,
                   PeopleElsewhere::Clock::time_point now);
  void forget_silent_nodes(PeopleElsewhere::Clock::time_point now);

  std::size_t count() const;       // number of connections to this node
  std::size_t take_leave_count();  // number of connections that left since the last call

 private:
  // Call these functions while holding `mutex_`.
  bool is_here(const Uuid& session) const;
  // Records the person that a person at another node follows. Returns whether anything has changed.
  bool follow_elsewhere(const Presence& person);
  void announce(const PeopleElsewhere::Change& change);

  OpenRoom& room_;
  // Recursive, because a listener may read the presence during a notification.
  mutable std::recursive_mutex mutex_;
  std::vector<OpenParticipant*> here_;
  std::size_t left_ = 0;
  PeopleElsewhere elsewhere_;
  Followers followers_;  // of all people, also of those at other nodes
};

}  // namespace strata::room
