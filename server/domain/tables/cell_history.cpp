#include "domain/tables/cell_history.h"

namespace strata {

void CellResolver::add(const PastCells& entry) {
  for (const auto& [name, after] : entry.after) {
    const auto open = open_.find(name);
    if (open == open_.end()) continue;
    if (entry.writer && entry.in_force) {
      result_[name] = after;
      past_.erase(name);
      open_.erase(open);
    } else if (const auto before = entry.before.find(name); before != entry.before.end()) {
      past_[name] = before->second;
    }
  }
}

Cells CellResolver::finish() && {
  result_.merge(past_);
  return std::move(result_);
}

}  // namespace strata
