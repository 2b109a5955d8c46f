#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/uuid.h"
#include "domain/layers/layer.h"
#include "domain/layers/review.h"
#include "domain/scene/model.h"
#include "domain/scene/surface_image.h"
#include "room/edit_answer.h"

namespace strata::room {

// Receives the events of a room. Called on the strand of the room, in the same order for all
// listeners. Must return quickly, so post the event to a socket.
class Listener {
 public:
  virtual ~Listener() = default;
  struct Edit {
    LayerId layer_id = 0;
    std::string layer;  // slug
    std::int64_t sequence = 0;
    Uuid id, stroke;
    int n = 0;
    bool is_stroke = false;
    std::string user, op;
    EditAnswer answer;
    struct Review {
      Decision decision = Decision::accept;
      std::string reason;
      std::vector<std::string> authors;  // authors of the reviewed edits
    };
    std::optional<Review> review{};
  };
  // The edit is visible, but not yet durable.
  virtual void edit_applied(const Edit& edit) = 0;
  // The edits were rolled back.
  virtual void edits_unsaved(const std::vector<Edit>& edits, const Error& why) = 0;
  enum class LayerChange { created, changed, deleted };
  virtual void layer_changed(LayerChange change, const Layer& layer) = 0;
  virtual void surface_image_changed(LayerChange change, const SurfaceImage& image) = 0;
  virtual void model_changed(const Model& model) = 0;
  virtual void model_deleted() = 0;  // the last event
  // Another node of the site has the model now, or this node must no longer change it. `url` is the
  // address of that node, or empty if it is not known. The last event. Edits without an answer were
  // refused with the code `moved`, so the client must send them again.
  virtual void moved(const std::string& url) = 0;
  // This node lost its connection to the database, or connected again. Without the database, the
  // room still draws, but refuses edits. Another node may then have newer edits of the model.
  virtual void database_reachable(bool reachable) = 0;
  virtual void presence_changed() = 0;
  // Called on the GPU thread, for one view of this participant only. The view cannot be drawn as
  // requested until something changes.
  virtual void view_refused(std::uint32_t view_id, const Error& why) = 0;
};

}  // namespace strata::room
