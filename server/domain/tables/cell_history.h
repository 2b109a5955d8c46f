#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace strata {

// The cells of a row, or the properties of a column, by name. An absent cell has no value, like
// null.
using Cells = std::map<std::string, nlohmann::json>;

// The effect of one edit on one row: the old and the new content of the cells that the edit wrote,
// even if a value is unchanged. `writer` and `in_force` are as in domain/layers/history.h: undo and
// redo change the content, but write nothing new.
struct PastCells {
  std::int64_t sequence = 0;
  bool writer = true;
  bool in_force = true;
  Cells before, after;  // both have the same names
};

// Recomputes the cells `names` of one row after the caller has changed the `in_force` of an edit.
// The rule of undo and redo is the same as for texels (domain/layers/history.h). A cell shows the
// result of the newest edit in force that wrote it. Without such an edit, it shows the content
// before all edits. The caller passes the entries of the row one by one.
class CellResolver {
 public:
  explicit CellResolver(std::set<std::string> names) : open_(std::move(names)) {}

  // Returns false if older entries cannot change the result.
  bool is_open() const { return !open_.empty(); }
  // Call with the newest entry first, then with the entry before it, and so on.
  void add(const PastCells& entry);
  // Call after the oldest entry, or when `is_open` is false. The result excludes cells that no
  // entry wrote.
  Cells finish() &&;

 private:
  std::set<std::string> open_;  // cells whose edit was not found yet
  Cells result_, past_;
};

}  // namespace strata
