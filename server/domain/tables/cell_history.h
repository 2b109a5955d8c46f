#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace strata {

// The cells of a row, or the properties of a column, by name. One that is not there is a cell
// without a value, as is null.
using Cells = std::map<std::string, nlohmann::json>;

// What one edit did to one row: the cells it wrote, also where the value stayed, before and after.
// `writer` and `in_force` are as in domain/layers/history.h: undo and redo move content but are
// nobody's writing.
struct PastCells {
  std::int64_t sequence = 0;
  bool writer = true;
  bool in_force = true;
  Cells before, after;  // of the same names
};

// The rule of undo and redo for rows, as for texels (domain/layers/history.h): a cell shows what
// the newest edit in force that wrote it left there, or what was there before all of them.
// Recomputes `names` of one row, after the caller flipped an edit's `in_force`, from what was done
// to the row, which comes one by one.
class CellResolver {
 public:
  explicit CellResolver(std::set<std::string> names) : open_(std::move(names)) {}

  // False when older entries change nothing more.
  bool is_open() const { return !open_.empty(); }
  // The newest entry first, then the one before it, and so on.
  void add(const PastCells& entry);
  // After the oldest entry, or when nothing is open. Cells that no entry wrote are not among them.
  Cells finish() &&;

 private:
  std::set<std::string> open_;  // whose author is not found yet
  Cells result_, past_;
};

}  // namespace strata
