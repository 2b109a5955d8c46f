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

// The effect of one edit on one row: the cells it wrote, also those with an unchanged value, before
// and after. `writer` and `in_force` are as in domain/layers/history.h: undo and redo move content
// but write nothing new.
struct PastCells {
  std::int64_t sequence = 0;
  bool writer = true;
  bool in_force = true;
  Cells before, after;  // of the same names
};

// The rule of undo and redo for rows, as for texels (domain/layers/history.h): a cell shows the
// result of the newest edit in force that wrote it, otherwise the content before all edits.
// Recomputes `names` of one row, after the caller changed an edit's `in_force`. The entries of the
// row are passed one by one.
class CellResolver {
 public:
  explicit CellResolver(std::set<std::string> names) : open_(std::move(names)) {}

  // False when older entries cannot change the result.
  bool is_open() const { return !open_.empty(); }
  // Call with the newest entry first, then the one before it, and so on.
  void add(const PastCells& entry);
  // Call after the oldest entry, or when `is_open` is false. Excludes cells that no entry wrote.
  Cells finish() &&;

 private:
  std::set<std::string> open_;  // cells whose author is still unknown
  Cells result_, past_;
};

}  // namespace strata
