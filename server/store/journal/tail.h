#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "core/error.h"
#include "core/ids.h"
#include "core/uuid.h"

namespace strata::store {

class PgConnection;

// What a copy of a model at another node compares with the database (room/open/following.h).
struct ModelState {
  std::int64_t sequence = 0;   // of the last edit
  std::int64_t last_edit = 0;  // digest of the edit with the highest sequence, with its time
  std::int64_t epoch = 0;      // of the newest claim (store/nodes/nodes.h)
  std::int64_t version = 0;    // of the properties of the model
  // Digests of the properties of the layers, without their content, and of the surface images.
  std::int64_t layers = 0, images = 0;

  bool operator==(const ModelState&) const = default;
};

// Reads the states of models several times a second. Uses its own connection with short limits,
// which it opens again when it breaks, so it waits neither for a busy pool nor long for a database
// that has vanished. Not thread-safe.
class ModelStates {
 public:
  explicit ModelStates(std::string dsn);
  ~ModelStates();
  // Reads all states in one query. Models that were deleted are left out.
  Result<std::map<ModelId, ModelState>> read(std::span<const ModelId> models);
  void disconnect();  // the next call opens another connection

 private:
  const std::string dsn_;
  std::unique_ptr<PgConnection> connection_;
};

// What other users learn about an edit.
struct TailEdit {
  std::int64_t sequence = 0;
  LayerId layer_id = 0;
  Uuid id, stroke;
  std::string user, op;
  bool pending = false;      // the edit waits for review
  bool provisional = false;  // the edit waited for review when it was made
};

}  // namespace strata::store
