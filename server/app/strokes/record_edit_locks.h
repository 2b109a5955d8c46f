#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/uuid.h"

namespace strata::app {

// The users who are editing records. Each record has at most one editor. The locks are advisory,
// belong to a connection and are never stored. The version of the record prevents lost updates.
// Thread-safe. Does not block.
class RecordEditLocks {
 public:
  static constexpr std::size_t kMaxOfSession = 100;  // records per session

  struct Record {
    TableId table = 0;
    std::int64_t key = 0;
    auto operator<=>(const Record&) const = default;
  };
  struct Editor {
    Uuid session;
    std::string user;
  };
  struct Entry {
    Record record;
    std::optional<Editor> editor;  // empty: no longer edited
  };
  // Receives the changed entries, or all entries, of a project. Called while the mutex is locked,
  // so all receivers get the entries in the same order. The function must not block or call this
  // object.
  using Tell = std::function<void(ProjectId project_id, const std::vector<Entry>& entries)>;

  // Sets the editor of the record. If the record has another editor and `take_over` is false,
  // changes nothing. Refuses (422, `key`) more than `kMaxOfSession` records.
  Result<void> begin(ProjectId project_id, const Record& record, const Editor& editor,
                     bool take_over, const Tell& tell);
  // Has no effect if another session edits the record.
  void end(const Record& record, const Uuid& session, const Tell& tell);
  void leave(const Uuid& session, const Tell& tell);  // call when the connection is closed
  // Does not call `tell` if there are no entries.
  void list(ProjectId project_id, const Tell& tell) const;

 private:
  struct Held {
    ProjectId project_id = 0;
    Editor editor;
  };
  mutable std::mutex mutex_;
  std::map<Record, Held> held_;
};

}  // namespace strata::app
