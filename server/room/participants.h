#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/uuid.h"
#include "domain/people/person_color.h"
#include "domain/people/role.h"
#include "domain/scene/camera.h"
#include "room/view_settings.h"
#include "stream/frame_messages.h"

namespace strata::room {

class Listener;

// The position of a pointer on the surface.
struct Pointing {
  glm::dvec3 position{0};        // in world coordinates
  std::optional<double> radius;  // radius of the brush, in world units
};

// The data of a participant that other participants see.
struct Portrait {
  std::string full_name{};  // empty if the user has no full name
  std::string color{kNobodysColor};
  // False for kiosks. Other nodes are not notified of them, because nobody sees them.
  bool is_person = true;
};

// The data of one connection that the other participants receive. Never stored.
struct Presence {
  Uuid session;
  std::string user;
  std::string full_name;  // empty if the user has no full name
  std::string color;      // #rrggbb
  std::optional<Pointing> pointer{};
  bool leading = false;             // the participant asks the others to follow
  std::optional<Uuid> following{};  // session of the leader
  std::optional<Camera> camera{};   // newest camera of view 0 without its section, for followers
};

// One connection in a room. The methods are thread-safe and return immediately. The destructor
// leaves the room.
class Participant {
 public:
  virtual ~Participant() = default;
  virtual Uuid session() const = 0;
  virtual void camera(std::uint32_t view_id, std::uint64_t seq, const Camera& camera,
                      bool moving) = 0;
  // Replaces all former settings of this view.
  virtual Result<void> show(std::uint32_t view_id, ViewSettings settings) = 0;
  virtual void ack(std::uint32_t view_id, std::uint64_t frame) = 0;
  // Call when the user edits, so slow frames of other participants do not delay the frames of this
  // one.
  virtual void edits() = 0;
  virtual void pointer(std::optional<Pointing> at) = 0;
  // Replaces the former settings. Changes nothing, and returns an error at `follow`: `not_found` if
  // the session is not in the room, `conflict` if it follows this one.
  virtual Result<void> look_together(bool leading, const std::optional<Uuid>& follow) = 0;
};

// The participants of a room. Thread-safe.
class Participants {
 public:
  virtual ~Participants() = default;
  // Frames and events contain only the layers and columns that the participant can see at that
  // time.
  virtual std::unique_ptr<Participant> join(Author who, Portrait portrait, Listener* listener,
                                            stream::SendFrames send) = 0;
  // Returns all participants as one of the sessions receives them. The only camera in the result is
  // the camera of this session's leader.
  virtual std::vector<Presence> presence(const Uuid& receiver) const = 0;
};

}  // namespace strata::room
