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

// Where somebody points on the surface.
struct Pointing {
  glm::dvec3 position{0};        // world
  std::optional<double> radius;  // world, of the brush in hand
};

// How others see a person.
struct Portrait {
  std::string full_name{};  // empty: none was given
  std::string color{kNobodysColor};
};

// What is known of one connection to the others; never stored.
struct Presence {
  Uuid session;
  std::string user;
  std::string full_name;  // empty: none was given
  std::string color;      // #rrggbb
  std::optional<Pointing> pointer{};
  bool leading = false;             // asks the others to look with them
  std::optional<Uuid> following{};  // session of whom they look with
  std::optional<Camera> camera{};   // newest of view 0 without its section, for who follows them
};

// One connection in a room. Methods are thread-safe and return at once. Destroying it leaves the
// room.
class Participant {
 public:
  virtual ~Participant() = default;
  virtual Uuid session() const = 0;
  virtual void camera(std::uint32_t view_id, std::uint64_t seq, const Camera& camera,
                      bool moving) = 0;
  // Replaces everything that was set before for this view.
  virtual Result<void> show(std::uint32_t view_id, ViewSettings settings) = 0;
  virtual void ack(std::uint32_t view_id, std::uint64_t frame) = 0;
  virtual void edits() = 0;  // its person does: onlookers do not hold up what they see of it
  virtual void pointer(std::optional<Pointing> at) = 0;
  // Replaces what was said before. Refused as a whole, in `follow`: a session that is not here
  // (not_found), one that follows this one (conflict).
  virtual Result<void> look_together(bool leading, const std::optional<Uuid>& follow) = 0;
};

// Who is in a room. Thread-safe.
class Participants {
 public:
  virtual ~Participants() = default;
  // Frames and what the listener hears are of layers and columns that they see, from one moment to
  // the next.
  virtual std::unique_ptr<Participant> join(Author who, Portrait portrait, Listener* listener,
                                            stream::SendFrames send) = 0;
  // Everyone, as told to one of the sessions: of all cameras only that of whom it follows.
  virtual std::vector<Presence> presence(const Uuid& receiver) const = 0;
};

}  // namespace strata::room
