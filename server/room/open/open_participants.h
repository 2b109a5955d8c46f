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

  // --- for each of them
  void leave(OpenParticipant* participant);
  void announce_presence();
  // Replaces the former leader; nothing: follow nobody. Refused (not_found): no participant has
  // that session; other refusals as in Followers.
  Result<void> follow(const Uuid& follower, const std::optional<Uuid>& leader);
  void camera_moved(const Uuid& session);  // notifies its followers

  // --- for the room
  void tell(const std::function<void(Listener&)>& tell);  // every listener
  // listeners who see the layer
  void tell_seen(const Layer& layer, const std::function<void(Listener&)>& tell);
  // Listeners who begin to see the layer are notified of its creation, those who no longer see it
  // of its deletion. `before`: nothing for a new layer.
  void tell_layer(std::optional<Visibility> before, const Layer& layer);
  void tell_unsaved(const std::vector<Listener::Edit>& edits, const Error& why);
  void content_changed(LayerId layer_id, const std::optional<render::FrameRequest::Box>& box,
                       std::int64_t sequence);
  void styles_changed();
  void model_changed(render::ModelHandle model);
  std::size_t count() const;       // number of connections
  std::size_t take_leave_count();  // number of connections that left since the last call

 private:
  OpenRoom& room_;
  // recursive: a listener may read the presence during a notification
  mutable std::recursive_mutex mutex_;
  std::vector<OpenParticipant*> here_;
  std::size_t left_ = 0;
  Followers followers_;
};

}  // namespace strata::room
