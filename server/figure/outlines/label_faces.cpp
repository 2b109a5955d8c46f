#include "figure/outlines/label_faces.h"

#include <algorithm>
#include <map>

namespace strata::figure {
namespace {

constexpr std::uint32_t kUnknown = 0xffffffff;

class Faces {
 public:
  Faces(LabelGrid grid, std::size_t smallest) : grid_(std::move(grid)), smallest_(smallest) {
    faces_.columns = grid_.columns;
    faces_.rows = grid_.rows;
    faces_.label.push_back(kNoLabel);
    sizes_.push_back(0);
    first_cells_.push_back(0);
  }

  Result<LabelFaces> find(const Progress& progress) {
    STRATA_TRY(number_all(progress));
    const bool has_dropped = STRATA_TRY(drop_small(progress));
    if (has_dropped) {
      faces_.label.resize(1);
      sizes_.resize(1);
      first_cells_.resize(1);
      STRATA_TRY(number_all(progress));
    }
    return std::move(faces_);
  }

 private:
  Result<void> number_all(const Progress& progress) {
    faces_.face.assign(grid_.labels.size(), kUnknown);
    for (std::size_t cell = 0; cell < grid_.labels.size(); ++cell) {
      if (cell % static_cast<std::size_t>(grid_.columns) == 0 && progress.cancelled())
        return cancelled_problem();
      if (faces_.face[cell] != kUnknown) continue;
      const auto number = static_cast<std::uint32_t>(faces_.label.size());
      faces_.label.push_back(grid_.labels[cell]);
      first_cells_.push_back(cell);
      flood(cell, number, grid_.labels.size());
      sizes_.push_back(flooded_.size());
    }
    return {};
  }

  template <class Visit>
  void for_each_neighbor(std::size_t cell, const Visit& visit) const {
    const auto columns = static_cast<std::size_t>(grid_.columns);
    const std::size_t x = cell % columns;
    if (x > 0) visit(cell - 1);
    if (x + 1 < columns) visit(cell + 1);
    if (cell >= columns) visit(cell - columns);
    if (cell + columns < grid_.labels.size()) visit(cell + columns);
  }

  // Gives the piece that contains the cell this number. `flooded_` then contains its cells. Stops
  // when it has at least `most` cells.
  void flood(std::size_t cell, std::uint32_t number, std::size_t most) {
    const std::uint32_t label = grid_.labels[cell];
    flooded_.assign(1, cell);
    faces_.face[cell] = number;
    for (std::size_t i = 0; i < flooded_.size() && flooded_.size() < most; ++i)
      for_each_neighbor(flooded_[i], [&](std::size_t next) {
        if (faces_.face[next] == number || grid_.labels[next] != label) return;
        faces_.face[next] = number;
        flooded_.push_back(next);
      });
  }

  // Returns whether a label has changed.
  Result<bool> drop_small(const Progress& progress) {
    std::vector<std::uint32_t> small;
    for (std::uint32_t face = 1; face < sizes_.size(); ++face)
      if (sizes_[face] < smallest_) small.push_back(face);
    std::ranges::stable_sort(small, {}, [&](std::uint32_t face) { return sizes_[face]; });
    for (const std::uint32_t face : small) {
      if (progress.cancelled()) return cancelled_problem();
      // This face may be a part of a larger one since then. The size of that one does not matter,
      // and a grid can have very many small faces in a large one.
      flood(first_cells_[face], static_cast<std::uint32_t>(sizes_.size()), smallest_);
      sizes_.push_back(0);  // makes the number of the next flood a new one
      if (flooded_.size() >= smallest_) continue;
      std::map<std::uint32_t, std::size_t> borders;  // number of common sides, by label
      const std::uint32_t label = grid_.labels[flooded_.front()];
      for (const std::size_t cell : flooded_)
        for_each_neighbor(cell, [&](std::size_t next) {
          if (grid_.labels[next] != label) ++borders[grid_.labels[next]];
        });
      if (borders.empty()) continue;  // the whole grid
      const auto longest =
          std::ranges::max_element(borders, {}, [](const auto& each) { return each.second; });
      for (const std::size_t cell : flooded_) grid_.labels[cell] = longest->first;
      if (label != kNoLabel) {
        ++faces_.dropped_faces;
        faces_.dropped_cells += flooded_.size();
      }
    }
    return !small.empty();
  }

  LabelGrid grid_;
  const std::size_t smallest_;
  LabelFaces faces_;
  std::vector<std::size_t> sizes_, first_cells_, flooded_;
};

}  // namespace

Result<LabelFaces> label_faces(LabelGrid grid, std::size_t smallest, const Progress& progress) {
  return Faces(std::move(grid), smallest).find(progress);
}

}  // namespace strata::figure
