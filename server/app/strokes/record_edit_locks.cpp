#include "app/strokes/record_edit_locks.h"

#include <algorithm>

namespace strata::app {

Result<void> RecordEditLocks::begin(ProjectId project_id, const Record& record,
                                    const Editor& editor, bool take_over, const Tell& tell) {
  std::lock_guard lock(mutex_);
  const auto found = held_.find(record);
  if (found != held_.end()) {
    const Uuid& holder = found->second.editor.session;
    if (holder == editor.session || !take_over) return {};
  }
  const auto own = std::ranges::count_if(
      held_, [&](const auto& entry) { return entry.second.editor.session == editor.session; });
  if (static_cast<std::size_t>(own) >= kMaxOfSession)
    return fail(ErrorCode::invalid, "Too many records",
                "A connection can edit at most " + std::to_string(kMaxOfSession) +
                    " records at the same time. Finish editing another record first.",
                "key");
  held_[record] = {project_id, editor};
  tell(project_id, {{record, editor}});
  return {};
}

void RecordEditLocks::end(const Record& record, const Uuid& session, const Tell& tell) {
  std::lock_guard lock(mutex_);
  const auto found = held_.find(record);
  if (found == held_.end() || found->second.editor.session != session) return;
  const ProjectId project_id = found->second.project_id;
  held_.erase(found);
  tell(project_id, {{record, std::nullopt}});
}

void RecordEditLocks::leave(const Uuid& session, const Tell& tell) {
  std::lock_guard lock(mutex_);
  std::map<ProjectId, std::vector<Entry>> gone;  // entries by project
  std::erase_if(held_, [&](const auto& entry) {
    const bool own = entry.second.editor.session == session;
    if (own) gone[entry.second.project_id].push_back({entry.first, std::nullopt});
    return own;
  });
  for (const auto& [project_id, entries] : gone) tell(project_id, entries);
}

void RecordEditLocks::list(ProjectId project_id, const Tell& tell) const {
  std::lock_guard lock(mutex_);
  std::vector<Entry> entries;
  for (const auto& [record, held] : held_)
    if (held.project_id == project_id) entries.push_back({record, held.editor});
  if (!entries.empty()) tell(project_id, entries);
}

}  // namespace strata::app
