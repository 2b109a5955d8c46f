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

// Who is in an open room, and what they are told.
class OpenRoom::ParticipantsPart final : public Participants {
 public:
  explicit ParticipantsPart(OpenRoom& room) : room_(room) {}
  std::unique_ptr<Participant> join(Author who, Portrait portrait, Listener* listener,
                                    stream::SendFrames send) override;
  std::vector<Presence> presence(const Uuid& receiver) const override;

  // --- for each of them
  void leave(OpenParticipant* participant);
  void announce_presence();
  // Instead of whom they followed before; nothing: they follow nobody. Refused (not_found): nobody
  // here has that session; else as by Followers.
  Result<void> follow(const Uuid& follower, const std::optional<Uuid>& leader);
  void camera_moved(const Uuid& session);  // tells those who follow it

  // --- for the room
  void tell(const std::function<void(Listener&)>& tell);  // every listener
  // of who sees the layer
  void tell_seen(const Layer& layer, const std::function<void(Listener&)>& tell);
  // Who begins to see the layer hears that it was made, who ends that it was deleted. `before`:
  // nothing, where it is new.
  void tell_layer(std::optional<Visibility> before, const Layer& layer);
  void tell_unsaved(const std::vector<Listener::Edit>& edits, const Error& why);
  void content_changed(LayerId layer_id, const std::optional<render::FrameRequest::Box>& box,
                       std::int64_t sequence);
  void styles_changed();
  void model_changed(render::ModelHandle model);
  std::size_t count() const;       // a connection each
  std::size_t take_leave_count();  // who have left since this was asked

 private:
  OpenRoom& room_;
  // recursive: a listener may ask for presence while it is told
  mutable std::recursive_mutex mutex_;
  std::vector<OpenParticipant*> here_;
  std::size_t left_ = 0;
  Followers followers_;
};

}  // namespace strata::room
