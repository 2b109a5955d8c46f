#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/trace.h"
#include "core/uuid.h"
#include "domain/layers/layer.h"
#include "domain/layers/review.h"
#include "domain/layers/tile_mirror.h"
#include "domain/people/question.h"
#include "domain/people/role.h"
#include "domain/scene/stroke.h"
#include "expression/expression.h"
#include "query/conditions/texel_selection.h"
#include "query/regions/surface_values.h"
#include "query/sampling/values.h"
#include "room/edit_answer.h"
#include "room/place.h"
#include "store/journal/journal.h"

namespace strata::room {

// The edits that a caller can request. `net` converts messages into them.
struct StrokeEdit {
  StrokeBatch batch;
  Uuid stroke;
  int n = 0;  // number of the batch in the stroke
};
struct FillEdit {
  bool erase = false;
  std::uint32_t value_bits = 0;
  struct Everywhere {};
  struct Where {  // evaluated on the state of the layers at the start of the edit
    Expression condition;
  };
  struct Island {  // the connected piece of the surface, across the seams of the atlas
    Place at;
  };
  struct Connected {
    // The largest connected piece of the surface around this position where all texels have the
    // same value, or where all have no value.
    Place at;
  };
  struct Selected {
    // Surface texels that were selected before the edit. If the layer has another resolution by
    // now, the edit is refused with a `conflict` error.
    std::shared_ptr<const query::TexelSelection> texels;
    int resolution = 0;
  };
  std::variant<Everywhere, Where, Island, Connected, Selected> region = Everywhere{};
};
struct PolygonEdit {
  bool erase = false;
  std::uint32_t value_bits = 0;
  Outline outline;
};
struct ImportEdit {
  TileMap tiles;
  // If true, the valid texels of the tiles are painted over the layer. If false, the tiles replace
  // the whole content of the layer.
  bool over = false;
  bool computed = false;  // first content of a layer that is computed from the shape of the model
};
struct ComputeEdit {
  // The content of a computed layer, from the layers and records as they are when the edit starts.
  Expression expression;
  // The shape values (kShapeNames) and functions along the surface that the expression reads, as
  // layers `surface.…`.
  std::vector<query::LayerView> shapes;
  bool overwrites = false;  // also replaces later edits by hand
};
// Changes of single texels that were computed from an earlier state of the layer, outside the
// pipeline. Texels that were edited since then keep their newer values. If the layer has another
// type or resolution by now, the edit is refused with a `conflict` error.
struct PatchEdit {
  query::TexelPatch patch;
  ValueType type = ValueType::u8;  // of the layer at that time
  int resolution = 0;
  // For a layer of records: keys_in(patch). A record may have been deleted since the patch was
  // computed, even if its key was on the layer then.
  std::vector<std::int64_t> keys{};
};
// Returns the distinct values that the patch writes. Reads all its texels, so call it before the
// edit is submitted.
std::vector<std::int64_t> keys_in(const query::TexelPatch& patch);
struct UndoEdit {};  // undoes the author's newest stroke in force on the layer
struct RedoEdit {};
struct ReviewEdit {  // reviews edits that wait for review, or that were reviewed before
  Decision decision = Decision::accept;
  store::Reviewees which;
  std::string reason;  // message to the authors of the edits
};
struct RestoreEdit {  // restores the layer as it was after a sequence
  std::int64_t sequence = 0;
  std::optional<Outline> outline{};  // if set, restores only the texels inside it
};

struct EditRequest {
  Uuid id;  // id of the message; a repeated request gets the first result and paints nothing
  Author author;
  LayerId layer_id = 0;
  std::variant<StrokeEdit, FillEdit, PolygonEdit, ImportEdit, ComputeEdit, PatchEdit, UndoEdit,
               RedoEdit, RestoreEdit, ReviewEdit>
      edit{};
  nlohmann::json record{};  // the requested edit, for the journal
  // The question that contains this edit, with its limits. Null: the limits of the author apply.
  std::shared_ptr<Question> question{};
  // The trace of the request or stroke. Zero: the pipeline begins a new trace.
  TraceId trace{};
};

// Returns the keys that an edit paints on the layer. Empty if the edit erases, undoes or restores.
std::vector<std::int64_t> painted_by(const Layer& layer, const EditRequest& edit);

// Returns whether the edit paints. Undo, redo and reviews only change the state of other edits.
bool paints(const EditRequest& edit);
// Returns whether the edit is provisional until a curator accepts or rejects it.
bool waits_for_review(const Layer& layer, const EditRequest& edit);

// Returns whether the edit writes the computed values of a layer, and is not a change by hand.
bool computes(const EditRequest& edit);
// Returns a `forbidden` error at `layer` for a locked layer if the role is below curator. Returns
// the same error for a layer whose content was computed, unless `computing` is true. The pipeline
// checks this before an edit begins. Other callers need this check only if they change something
// before the edit.
Result<void> check_not_locked(const Layer& layer, Role role, bool computing = false);

// Returns the result for a repeated edit that is already in the journal.
EditAnswer idempotent_response(const store::JournalRow& row);

}  // namespace strata::room
