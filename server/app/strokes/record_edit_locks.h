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

// The people who are editing records. One editor per record; advisory, bound to the connection and
// never stored: the record's version prevents lost updates. Thread-safe; does not block.
class RecordEditLocks {
 public:
  static constexpr std::size_t kMaxOfSession = 100;  // records

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
    std::optional<Editor> editor;  // nothing: no longer edited
  };
  // Receives the changed entries, or all entries, of a project. Called with the mutex locked, so
  // that all receive them in one order: it must return at once and not call this object.
  using Tell = std::function<void(ProjectId project_id, const std::vector<Entry>& entries)>;

  // Makes the editor the one of the record. If another one has it and `take_over` is false, changes
  // nothing. Refuses (422, `key`) more than `kMaxOfSession`.
  Result<void> begin(ProjectId project_id, const Record& record, const Editor& editor,
                     bool take_over, const Tell& tell);
  // does nothing if another session has it
  void end(const Record& record, const Uuid& session, const Tell& tell);
  void leave(const Uuid& session, const Tell& tell);  // the connection is closed
  // makes no call if there are no entries
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
