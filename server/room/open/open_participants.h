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
  // Replaces the former leader. nullopt: the follower has no leader. Returns the error `not_found`
  // if no participant has that session, and the same errors as Followers.
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
  std::size_t count() const;       // number of connections
  std::size_t take_leave_count();  // number of connections that left since the last call

 private:
  OpenRoom& room_;
  // Recursive, because a listener may read the presence during a notification.
  mutable std::recursive_mutex mutex_;
  std::vector<OpenParticipant*> here_;
  std::size_t left_ = 0;
  Followers followers_;
};

}  // namespace strata::room
