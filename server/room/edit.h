#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <variant>

#include "core/stroke.h"
#include "core/tile_mirror.h"
#include "core/uuid.h"

namespace strata::room {

// What a caller asks for, in domain terms; net translates messages into it.
struct StrokeEdit {
  StrokeBatch batch;
  Uuid stroke;
  int n = 0;  // number of the batch in its stroke
};
struct FillEdit {  // everywhere on the surface
  bool erase = false;
  std::uint32_t value_bits = 0;
};
struct ImportEdit {  // replaces the whole layer's content
  TileMap tiles;
};
struct UndoEdit {};  // the author's newest stroke in force on the layer
struct RedoEdit {};
struct RestoreEdit {  // the whole layer as it was after a sequence
  std::int64_t sequence = 0;
};

struct EditRequest {
  Uuid id;  // of the message: a repeat gets the first answer and paints nothing
  std::string user;
  std::int64_t layer_id = 0;
  std::variant<StrokeEdit, FillEdit, ImportEdit, UndoEdit, RedoEdit, RestoreEdit> edit;
  nlohmann::json record;  // the edit as asked, for the journal
};

struct EditAnswer {
  std::int64_t sequence = 0;
  std::uint64_t texels_changed = 0;  // surface texels whose value or validity changed
  double area_m2 = 0;                // their surface
  bool repeated = false;             // the id was known: nothing was painted now
};

nlohmann::json to_json(const EditAnswer& answer);

}  // namespace strata::room
