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
#include "store/tables/table_changes.h"

namespace strata::store {

class Pool;

// Something that was deleted and can be restored.
struct TrashEntry {
  enum class Kind { layer, model, record };
  Kind kind = Kind::layer;
  std::int64_t id = 0;  // of the layer or model; key of the record
  std::string name;
  ModelId model_id = 0;    // where a layer lay; of a model its own
  std::string model_name;  // of a layer
  TableId table_id = 0;    // of a record
  std::string table_name;  // the same
  std::string user;        // who deleted it; empty: the server itself
  std::chrono::system_clock::time_point deleted;
  std::uint64_t bytes = 0;  // of its files and history, about
};

struct TrashRestored {
  TrashEntry entry;
  std::string slug;         // that it has now
  std::string former_slug;  // that it had, where something else has it meanwhile; else empty
};

// What was deleted in projects; of a Store, and as thread-safe and blocking as that, with the same
// Problems for what is not there or away. Models and layers that are in it are there for nothing
// else (db/migrations/000023_bin.sql). Records are never erased: their tables' journals keep what
// they were, and the Trash finds them there.
class Trash {
 public:
  explicit Trash(Pool& pool) : pool_(pool) {}

  struct Page {
    std::vector<TrashEntry> entries;  // newest first
    std::int64_t total = 0;
  };
  struct Sight {
    Role role = Role::viewer;      // layers and models are for curators, records for annotators
    std::chrono::days records{0};  // for how long they are told
  };
  // Where a page ends: at this entry.
  struct Place {
    std::int64_t deleted_us = 0;  // since 1970
    TrashEntry::Kind kind = TrashEntry::Kind::layer;
    TableId table_id = 0;
    std::int64_t id = 0;
  };
  // Layers that lie on a model in the Trash come back with it, and are no entries. `after`: only
  // those that follow it.
  Result<Page> of_project(ProjectId project_id, const Sight& sight, int limit, int offset,
                          const std::optional<Place>& after = {});
  // `table_id` is of a record.
  Result<TrashEntry> entry(ProjectId project_id, TrashEntry::Kind kind, std::int64_t id,
                           TableId table_id, const Sight& sight);

  // Into it, by whom the answer is for.
  Result<void> put_layer(LayerId id, const IdempotentResponse<>& answer);
  Result<void> put_model(ModelId id, const IdempotentResponse<>& answer);
  // A layer or model out of it, with the short name that it had where that is free. A room that is
  // open does not know it yet.
  Result<TrashRestored> restore(const TrashEntry& entry,
                                const IdempotentResponse<TrashRestored>& answer);
  // A record, with its key, as an entry of the table's journal. Refused (conflict): its values do
  // not fit the table as it is now, or it is there.
  Result<TableChange> restore_record(const TrashEntry& entry, const std::string& user,
                                     const IdempotentResponse<TableChange>& answer);
  // A layer or model, gone for ever; its content is left to `erase_some`.
  Result<void> erase(const TrashEntry& entry, const IdempotentResponse<>& answer);

  // What was put in longer ago is gone for ever, likewise.
  Result<void> expire(std::chrono::days after);
  // Some of the content of what is gone for ever, so little that nobody waits for it; false: there
  // is none.
  Result<bool> erase_some();

 private:
  Pool& pool_;
};

}  // namespace strata::store
