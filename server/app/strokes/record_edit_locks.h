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

// Who is writing into which record just now. Advice for people, one editor a record, kept while the
// connection is there and never stored: what keeps them from overwriting each other is the record's
// version. Thread-safe; does not block.
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
    std::optional<Editor> editor;  // nothing: nobody any more
  };
  // Hears what changed, or what there is, of a project. Called with the book locked, so that all
  // hear it in one order: it must return at once and not call the book.
  using Tell = std::function<void(ProjectId project_id, const std::vector<Entry>& entries)>;

  // The editor has the record now, unless somebody else has it and is not to be relieved: then
  // nothing changes. Refused (422, `key`): more than `kMaxOfSession`.
  Result<void> begin(ProjectId project_id, const Record& record, const Editor& editor,
                     bool take_over, const Tell& tell);
  // where it is this session's
  void end(const Record& record, const Uuid& session, const Tell& tell);
  void leave(const Uuid& session, const Tell& tell);  // the connection is gone
  // not called where there is none
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
