#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/people/role.h"
#include "store/content/idempotent_response.h"

namespace strata::store {

class Pool;
struct TableChange;

// A deleted object that can be restored.
struct TrashEntry {
  enum class Kind { layer, model, record };
  Kind kind = Kind::layer;
  std::int64_t id = 0;  // id of the layer or model, or key of the record
  std::string name;
  ModelId model_id = 0;    // model of the layer, or the model itself
  std::string model_name;  // for a layer: name of its model
  TableId table_id = 0;    // for a record: its table
  std::string table_name;  // for a record: name of its table
  std::string user;        // the user who deleted it; empty for the server
  std::chrono::system_clock::time_point deleted;
  std::uint64_t bytes = 0;  // approximate size of its files and history
};

struct TrashRestored {
  TrashEntry entry;
  std::string slug;  // slug after the restore
  // slug before the deletion, if another object uses it now; otherwise empty
  std::string former_slug;
};

// The Trash of projects. Part of Store, whose rules for threads and errors apply. All other parts
// of Store ignore models and layers that are in the Trash (db/migrations/000023_bin.sql). Records
// are never erased: the journals of their tables keep their values, and the Trash reads them there.
class Trash {
 public:
  explicit Trash(Pool& pool) : pool_(pool) {}

  struct Page {
    std::vector<TrashEntry> entries;  // newest first
    std::int64_t total = 0;
  };
  struct Sight {
    Role role = Role::viewer;      // curators see layers and models, annotators see records
    std::chrono::days records{0};  // how long deleted records are listed
  };
  // The position of the last entry of a page.
  struct Place {
    std::int64_t deleted_us = 0;  // microseconds since 1970
    TrashEntry::Kind kind = TrashEntry::Kind::layer;
    TableId table_id = 0;
    std::int64_t id = 0;
  };
  // Layers on a model in the Trash are restored with the model, and are not listed. `after` selects
  // only the entries after a position.
  Result<Page> of_project(ProjectId project_id, const Sight& sight, int limit, int offset,
                          const std::optional<Place>& after = {});
  // `table_id` is the table of a record.
  Result<TrashEntry> entry(ProjectId project_id, TrashEntry::Kind kind, std::int64_t id,
                           TableId table_id, const Sight& sight);

  // These functions move a layer or model to the Trash, for the user in `answer`.
  Result<void> put_layer(LayerId id, const IdempotentResponse<>& answer);
  Result<void> put_model(ModelId id, const IdempotentResponse<>& answer);
  // Restores a layer or model, with its former slug if that slug is free. An open room does not
  // contain the restored object yet.
  Result<TrashRestored> restore(const TrashEntry& entry,
                                const IdempotentResponse<TrashRestored>& answer);
  // Restores a record, with its key, as an entry in the journal of the table. Returns a `conflict`
  // error if its values are not valid in the current table, or if the record exists.
  Result<TableChange> restore_record(const TrashEntry& entry, const std::string& user,
                                     const IdempotentResponse<TableChange>& answer);
  // Erases a layer or model permanently. `erase_some` erases its content later.
  Result<void> erase(const TrashEntry& entry, const IdempotentResponse<>& answer);

  // Erases, like `erase`, all layers and models that have been in the Trash for longer than
  // `after`.
  Result<void> expire(std::chrono::days after);
  // Erases a part of the content of erased models and layers. The part is so small that no other
  // caller has to wait. Returns false if nothing is left.
  Result<bool> erase_some();

 private:
  Pool& pool_;
};

}  // namespace strata::store
