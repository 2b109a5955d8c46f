#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/uuid.h"
#include "domain/layers/layer.h"
#include "domain/layers/review.h"
#include "domain/layers/tile_mirror.h"
#include "domain/people/question.h"
#include "domain/people/role.h"
#include "domain/scene/stroke.h"
#include "expression/expression.h"
#include "query/sampling/values.h"
#include "room/edit_answer.h"
#include "room/place.h"
#include "store/journal/journal.h"

namespace strata::room {

// Requests of a caller, in domain terms; net translates messages into them.
struct StrokeEdit {
  StrokeBatch batch;
  Uuid stroke;
  int n = 0;  // number of the batch in its stroke
};
struct FillEdit {
  bool erase = false;
  std::uint32_t value_bits = 0;
  struct Everywhere {};
  struct Where {  // of the model's layers as they are when the edit starts
    Expression condition;
  };
  struct Island {  // the connected piece of the surface, across the seams of its atlas
    Place at;
  };
  struct Connected {
    // the texels that have the same value as the place, or like it no value, and are connected with
    // it across the surface
    Place at;
  };
  std::variant<Everywhere, Where, Island, Connected> region = Everywhere{};
};
struct PolygonEdit {
  bool erase = false;
  std::uint32_t value_bits = 0;
  Outline outline;
};
struct ImportEdit {
  TileMap tiles;
  // true: valid texels of the tiles are painted over the layer; false: the tiles replace its whole
  // content
  bool over = false;
  bool computed = false;  // first content of a layer that is computed from the shape
};
struct ComputeEdit {
  // a computed layer's content, from the layers and records as they are when the edit starts
  Expression expression;
  // shape values that the expression reads (kShapeNames), as layers `surface.…`
  std::vector<query::LayerView> shapes;
  bool overwrites = false;  // also later edits by hand
};
struct UndoEdit {};  // the author's newest stroke in force on the layer
struct RedoEdit {};
struct ReviewEdit {  // of edits that wait for review, or were reviewed before
  Decision decision = Decision::accept;
  store::Reviewees which;
  std::string reason;  // for the authors
};
struct RestoreEdit {  // the layer as it was after a sequence
  std::int64_t sequence = 0;
  std::optional<Outline> outline{};  // only the texels inside it
};

struct EditRequest {
  Uuid id;  // of the message: a repeat gets the first answer and paints nothing
  Author author;
  LayerId layer_id = 0;
  std::variant<StrokeEdit, FillEdit, PolygonEdit, ImportEdit, ComputeEdit, UndoEdit, RedoEdit,
               RestoreEdit, ReviewEdit>
      edit{};
  nlohmann::json record{};  // the edit as requested, for the journal
  // the question that this edit answers, with its limits; null: the limits of the author
  std::shared_ptr<Question> question{};
};

// Returns the keys that an edit of the layer paints: empty if it erases, undoes or restores.
std::vector<std::int64_t> painted_by(const Layer& layer, const EditRequest& edit);

// Returns whether the edit paints: undo, redo and reviews only change the state of other edits.
bool paints(const EditRequest& edit);
// Returns whether the edit is provisional until a curator accepts or rejects it.
bool waits_for_review(const Layer& layer, const EditRequest& edit);

// Returns whether the edit writes a layer's computed values, and is not a change by hand.
bool computes(const EditRequest& edit);
// Refused (forbidden, `layer`): a locked layer, unless the role is curator or higher; a layer with
// its computed content, unless `computing`. The pipeline checks this before it begins an edit;
// other callers check it only if they change something else before.
Result<void> check_not_locked(const Layer& layer, Role role, bool computing = false);

// Returns the answer to a repeat of an edit in the journal.
EditAnswer idempotent_response(const store::JournalRow& row);

}  // namespace strata::room
