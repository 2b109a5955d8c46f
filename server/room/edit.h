#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
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

// What a caller asks for, in domain terms; net translates messages into it.
struct StrokeEdit {
  StrokeBatch batch;
  Uuid stroke;
  int n = 0;  // number of the batch in its stroke
};
struct FillEdit {
  bool erase = false;
  std::uint32_t value_bits = 0;
  struct Everywhere {};
  struct Where {  // of the model's layers as they are when the edit's turn comes
    Expression condition;
  };
  struct Island {  // the connected piece of the surface, across the seams of its atlas
    Place at;
  };
  struct Connected {
    // what holds the same as the place, or like it nothing, and is connected with it across the
    // surface
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
  // what is valid in the tiles is painted over the layer; otherwise they replace its whole content
  bool over = false;
  bool computed = false;  // what a layer is made with, from the shape
};
struct ComputeEdit {
  // a computed layer's content, from the layers and records as they are when the edit's turn comes
  Expression expression;
  // what it reads of the mesh (kShapeNames), as layers `surface.…`
  std::vector<query::LayerView> shapes;
  bool overwrites = false;  // also what was edited by hand since
};
struct UndoEdit {};  // the author's newest stroke in force on the layer
struct RedoEdit {};
struct ReviewEdit {  // of edits that wait for it, or were reviewed before
  Decision decision = Decision::accept;
  store::Reviewees which;
  std::string reason;  // for the authors
};
struct RestoreEdit {  // the whole layer as it was after a sequence
  std::int64_t sequence = 0;
};

struct EditRequest {
  Uuid id;  // of the message: a repeat gets the first answer and paints nothing
  Author author;
  LayerId layer_id = 0;
  std::variant<StrokeEdit, FillEdit, PolygonEdit, ImportEdit, ComputeEdit, UndoEdit, RedoEdit,
               RestoreEdit, ReviewEdit>
      edit{};
  nlohmann::json record{};  // the edit as asked, for the journal
  // it is part of its answer; none: it has the limits of its author
  std::shared_ptr<Question> question{};
};

// The keys that an edit of the layer paints: none where it erases, undoes or brings back what was.
std::vector<std::int64_t> painted_by(const Layer& layer, const EditRequest& edit);

// Whether the edit paints by itself: undo, redo and reviews only move what others painted.
bool paints(const EditRequest& edit);
// Whether the edit is provisional until a curator has accepted or rejected it.
bool waits_for_review(const Layer& layer, const EditRequest& edit);

// Whether the edit writes what a layer's values are computed to be, and is no change by hand.
bool computes(const EditRequest& edit);
// Refused (forbidden, `layer`): a locked layer, to who is no curator; one that is as it was
// computed, to everybody who is not `computing` it. The pipeline asks before it begins an edit;
// others only where they would change something else before that.
Result<void> check_not_locked(const Layer& layer, Role role, bool computing = false);

// What a repeat of an edit in the journal is told.
EditAnswer idempotent_response(const store::JournalRow& row);

}  // namespace strata::room
