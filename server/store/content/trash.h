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
  std::int64_t id = 0;  // of the layer or model; key of the record
  std::string name;
  ModelId model_id = 0;    // model of a layer; of a model, its own id
  std::string model_name;  // of a layer
  TableId table_id = 0;    // of a record
  std::string table_name;  // of a record
  std::string user;        // the user who deleted it; empty: the server
  std::chrono::system_clock::time_point deleted;
  std::uint64_t bytes = 0;  // of its files and history, approximately
};

struct TrashRestored {
  TrashEntry entry;
  std::string slug;         // after restoring
  std::string former_slug;  // before, if another object uses it now; else empty
};

// The Trash of projects. Part of Store: thread-safe and blocking as Store is, with the same errors
// for missing or unreachable data. All other parts of Store ignore models and layers that are in
// the Trash (db/migrations/000023_bin.sql). Records are never erased: the journals of their tables
// keep their values, and the Trash finds them there.
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
  // The entry where a page ends.
  struct Place {
    std::int64_t deleted_us = 0;  // since 1970
    TrashEntry::Kind kind = TrashEntry::Kind::layer;
    TableId table_id = 0;
    std::int64_t id = 0;
  };
  // Layers on a model in the Trash are restored with the model, and are not listed. `after`: only
  // the entries that follow it.
  Result<Page> of_project(ProjectId project_id, const Sight& sight, int limit, int offset,
                          const std::optional<Place>& after = {});
  // `table_id` is the table of a record.
  Result<TrashEntry> entry(ProjectId project_id, TrashEntry::Kind kind, std::int64_t id,
                           TableId table_id, const Sight& sight);

  // Moves a layer or model into the Trash, as the user in `answer`.
  Result<void> put_layer(LayerId id, const IdempotentResponse<>& answer);
  Result<void> put_model(ModelId id, const IdempotentResponse<>& answer);
  // Restores a layer or model, with its former slug if that is free. An open room does not contain
  // it yet.
  Result<TrashRestored> restore(const TrashEntry& entry,
                                const IdempotentResponse<TrashRestored>& answer);
  // Restores a record, with its key, as an entry of the table's journal. Refused (conflict): its
  // values do not fit the present table, or it exists.
  Result<TableChange> restore_record(const TrashEntry& entry, const std::string& user,
                                     const IdempotentResponse<TableChange>& answer);
  // Erases a layer or model permanently; `erase_some` erases its content later.
  Result<void> erase(const TrashEntry& entry, const IdempotentResponse<>& answer);

  // Erases, in the same way, everything that is in the Trash for longer than `after`.
  Result<void> expire(std::chrono::days after);
  // Erases some of the content of erased models and layers, so little that no other caller has to
  // wait. Returns false if nothing is left.
  Result<bool> erase_some();

 private:
  Pool& pool_;
};

}  // namespace strata::store
