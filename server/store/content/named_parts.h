#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "store/content/idempotent_response.h"

namespace strata::store {

class Pool;

// A saved view of a model (a camera with the shown layers, images and light), a tour of views, a
// snapshot (a named state), or a saved selection (the definition of a part of the surface).
struct NamedPart {
  NamedPartId id = 0;
  ModelId model_id = 0;
  std::string slug;  // unique in the model; made from the name if empty
  std::string name;
  std::string text;  // plain, UTF-8, at most 10 000 characters
  // the other fields of View, Tour, Snapshot or SavedSelection in the protocol, with ids in place
  // of slugs
  nlohmann::json content;
  std::string user;  // the user who made it
  std::chrono::system_clock::time_point time;
  std::int64_t version = 1;
};

// Saved views of models, tours, snapshots, or saved selections. Part of Store, whose rules for
// threads and errors apply.
class NamedParts {
 public:
  struct Kind {
    const char* name;   // singular
    const char* table;  // all kinds have the same columns
    std::int64_t most;  // limit for one model
    bool names_states;  // their content has a `sequence`; a thinned state cannot be named
  };
  static constexpr Kind kViews{"view", "views", 1000, false}, kTours{"tour", "tours", 100, false},
      kSnapshots{"snapshot", "snapshots", 200, true},
      kSelections{"selection", "selections", 1000, false};

  NamedParts(Pool& pool, const Kind& kind) : pool_(pool), kind_(kind) {}

  struct Page {
    std::vector<NamedPart> parts;  // sorted by time of creation
    std::int64_t total = 0;
  };
  // Parts whose content has the `audience` personal are visible only to their user: of_model and
  // find leave out those of users other than `reader`. `after` selects only parts with higher ids.
  Result<Page> of_model(ModelId model_id, int limit, int offset, std::int64_t after = 0,
                        const std::string& reader = {});
  Result<std::map<NamedPartId, std::string>> slugs(ModelId model_id);  // slugs of all parts, by id
  Result<NamedPart> find(ModelId model_id, const std::string& ref, const std::string& reader = {});

  // Creates a part. The store sets id, slug, time and version. Returns a `malformed` error for an
  // empty name, and `conflict` for too many parts.
  Result<NamedPart> create(const NamedPart& part, const IdempotentResponse<NamedPart>& answer = {});
  // Changes name, text and content, if `part.version` is the current version. The slug does not
  // change, so links stay valid.
  Result<NamedPart> update(const NamedPart& part, const IdempotentResponse<NamedPart>& answer = {});
  // Deletes the part if `part.version` is the current version.
  Result<void> remove(const NamedPart& part, const IdempotentResponse<>& answer = {});

 private:
  std::string sql(std::string text) const;

  Pool& pool_;
  const Kind kind_;
};

}  // namespace strata::store
