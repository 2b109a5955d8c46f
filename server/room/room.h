#pragma once

#include "core/error.h"
#include "domain/scene/model.h"
#include "store/content/idempotent_response.h"

namespace strata::room {

class Layers;
class Edits;
class Queries;
class Surface;
class Pictures;
class SurfaceImages;
class Participants;

// One open model as a user sees it, without the layers that are hidden from the user. This is the
// only component that connects the store, renderer, streams and queries. It manages the order of
// edits, the tile mirrors, undo, the journal and the participants. Code that uses a part includes
// the header of the part.
class Room {
 public:
  virtual ~Room() = default;

  virtual Model model() const = 0;
  virtual Result<Model> update_model(Model model,
                                     const store::IdempotentResponse<Model>& answer = {}) = 0;

  Layers& layers() { return *parts_.layers; }
  const Layers& layers() const { return *parts_.layers; }
  Edits& edits() { return *parts_.edits; }
  const Edits& edits() const { return *parts_.edits; }
  Queries& queries() { return *parts_.queries; }
  Surface& surface() { return *parts_.surface; }
  const Surface& surface() const { return *parts_.surface; }
  Pictures& pictures() { return *parts_.pictures; }
  SurfaceImages& surface_images() { return *parts_.images; }
  const SurfaceImages& surface_images() const { return *parts_.images; }
  Participants& participants() { return *parts_.participants; }
  const Participants& participants() const { return *parts_.participants; }

 protected:
  struct Parts {
    Layers* layers = nullptr;
    Edits* edits = nullptr;
    Queries* queries = nullptr;
    Surface* surface = nullptr;
    Pictures* pictures = nullptr;
    SurfaceImages* images = nullptr;
    Participants* participants = nullptr;
  };
  Parts parts_;  // set by the implementation before the room is shared
};

}  // namespace strata::room
