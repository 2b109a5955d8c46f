#include "query/regions/majority.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "core/progress.h"
#include "mesh/parallel.h"
#include "mesh/texels/texel_graph.h"
#include "query/regions/border_distance.h"
#include "query/regions/row_runs.h"
#include "query/regions/value_areas.h"

namespace strata::query {
namespace {

using mesh::kNoNeighbour;
using mesh::Way;

constexpr double kMaxTexels = 40;  // radius in texels of the mean size
constexpr int kMaxRows = 4 * static_cast<int>(kMaxTexels);
// Texels whose distance equals the radius are inside, in spite of rounding errors.
constexpr double kRim = 1 + 1e-4;

double mean_texel_size(const mesh::SurfaceMap& map) {
  return map.surface_texels == 0
             ? 0
             : std::sqrt(map.area_total / static_cast<double>(map.surface_texels));
}

// The texels that a flood has visited: a hash table with a stamp per flood, so that it need not be
// cleared.
class VisitedTexels {
 public:
  explicit VisitedTexels(std::size_t expected)
      : entries_(std::bit_ceil(std::max<std::size_t>(8 * expected, 1024))) {}
  void clear() {
    ++stamp_;
    count_ = 0;
  }
  bool full() const { return count_ >= entries_.size() / 2; }
  // Returns whether the texel is new.
  bool add(std::uint32_t texel) {
    const std::size_t mask = entries_.size() - 1;
    std::size_t at = texel * 0x9e3779b1u & mask;
    while (entries_[at].stamp == stamp_) {
      if (entries_[at].texel == texel) return false;
      at = (at + 1) & mask;
    }
    entries_[at] = {texel, stamp_};
    ++count_;
    return true;
  }

 private:
  struct Entry {
    std::uint32_t texel = 0;
    std::uint32_t stamp = 0;
  };
  std::vector<Entry> entries_;
  std::uint32_t stamp_ = 0;
  std::size_t count_ = 0;
};

// Sums the areas around texels. One object for each thread.
class Neighbourhoods {
 public:
  Neighbourhoods(const SurfaceValues& values, const RowRuns& rows, const mesh::SurfaceMap& map,
                 const mesh::TexelGraph& graph, double radius)
      : values_(values),
        rows_(rows),
        map_(map),
        graph_(graph),
        radius_(radius * kRim),
        texels_in_radius_(radius / mean_texel_size(map)),
        visited_(static_cast<std::size_t>(
            std::ceil(std::numbers::pi * texels_in_radius_ * texels_in_radius_))) {
    visited_.clear();
  }

  TexelValue majority(std::uint32_t texel) {
    areas_.clear();
    if (!sum_ellipse(texel)) {
      areas_.clear();
      flood(texel);
    }
    return areas_.largest(values_.of(texel));
  }

 private:
  // The sides of a texel on the surface, as products of the vectors along x and y.
  struct Metric {
    double xx, xy, yy;
  };
  struct Chord {
    int first, last;
  };

  glm::dvec3 place(std::uint32_t texel) const {
    return glm::dvec3(map_.position(texel / 64, static_cast<int>(texel % 64)));
  }
  std::uint32_t walk(std::uint32_t texel, Way way, int steps) const {
    for (int i = 0; i < steps && texel != kNoNeighbour; ++i)
      texel = mesh::neighbour(map_, graph_, texel, way);
    return texel;
  }

  // Returns nothing near a seam or an edge. Measures over a few texels, so that the noise of a scan
  // does not make texels larger.
  std::optional<Metric> metric(std::uint32_t texel) const {
    const int steps = std::clamp(static_cast<int>(texels_in_radius_ / 2), 1, 4);
    const std::array ends{walk(texel, Way::left, steps), walk(texel, Way::right, steps),
                          walk(texel, Way::lower, steps), walk(texel, Way::upper, steps)};
    for (const std::uint32_t end : ends)
      if (end == kNoNeighbour) return std::nullopt;
    const glm::dvec3 x = (place(ends[1]) - place(ends[0])) / (2.0 * steps),
                     y = (place(ends[3]) - place(ends[2])) / (2.0 * steps);
    return Metric{glm::dot(x, x), glm::dot(x, y), glm::dot(y, y)};
  }

  // Sums the areas in an ellipse of texels. Returns false if they are not all connected in the
  // atlas.
  bool sum_ellipse(std::uint32_t texel) {
    const auto sides = metric(texel);
    if (!sides || sides->xx <= 0) return false;
    const double shear = sides->xy / sides->xx,
                 height_squared = sides->yy - sides->xy * shear;  // of a texel, across its rows
    if (!(height_squared > 0)) return false;
    const double rows = std::floor(radius_ / std::sqrt(height_squared));
    if (rows > kMaxRows) return false;
    const auto block = static_cast<int>(map_.block_of_slot[texel / 64]),
               i = static_cast<int>(texel % 64);
    const int x = block % map_.blocks_per_side * kBlockSize + i % kBlockSize,
              y = block / map_.blocks_per_side * kBlockSize + i / kBlockSize;
    const auto chord_at = [&](int dy) {
      const double half = std::sqrt(
          std::max(0.0, (radius_ * radius_ - double(dy) * dy * height_squared) / sides->xx));
      const double middle = x - shear * dy;
      return Chord{static_cast<int>(std::ceil(middle - half)),
                   static_cast<int>(std::floor(middle + half))};
    };
    const auto add = [&](const TexelValue& value, std::uint32_t area) { areas_.add(value, area); };
    const Chord through_center = chord_at(0);
    if (through_center.last - through_center.first > 2 * kMaxRows ||
        !rows_.for_each_run(y, through_center.first, through_center.last, add))
      return false;
    for (const int way : {1, -1}) {
      Chord before = through_center;
      int row_before = 0;
      for (int row = 1; row <= static_cast<int>(rows); ++row) {
        const Chord chord = chord_at(way * row);
        if (chord.first > chord.last) continue;  // passes between two texels
        if (row_before != row - 1 ||
            !are_connected(before, chord, y + way * row_before, y + way * row) ||
            !rows_.for_each_run(y + way * row, chord.first, chord.last, add))
          return false;
        before = chord;
        row_before = row;
      }
    }
    return true;
  }

  // Returns whether two adjacent rows are connected at a column of both chords.
  bool are_connected(const Chord& a, const Chord& b, int y_of_a, int y_of_b) const {
    const int first = std::max(a.first, b.first), last = std::min(a.last, b.last);
    const int lower_row = std::min(y_of_a, y_of_b);
    if (first < 0 || first > last || last >= map_.resolution || lower_row < 0 ||
        lower_row >= map_.resolution)
      return false;
    const std::uint32_t texel = rows_.texel_at((first + last) / 2, lower_row);
    return texel != kNoNeighbour && (graph_.to_upper[texel / 64] >> texel % 64 & 1u) != 0;
  }

  // Sums the areas of the connected texels in a ball.
  void flood(std::uint32_t start) {
    visited_.clear();
    open_.assign(1, start);
    visited_.add(start);
    const glm::dvec3 center = place(start);
    for (std::size_t next = 0; next < open_.size(); ++next) {
      const std::uint32_t texel = open_[next];
      areas_.add(values_.of(texel), rows_.area(texel));
      mesh::for_each_neighbour(map_, graph_, texel, [&](std::uint32_t other) {
        if (visited_.full() || !visited_.add(other)) return;
        if (glm::distance(place(other), center) <= radius_) open_.push_back(other);
      });
    }
  }

  const SurfaceValues& values_;
  const RowRuns& rows_;
  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  const double radius_, texels_in_radius_;
  VisitedTexels visited_;
  std::vector<std::uint32_t> open_;
  ValueAreas areas_;
};

// Returns the texels whose value may change. Where the nearest border is at d, the disc of radius d
// has the value of the texel. In a neighborhood without narrow necks, that is at least a part
// (d / radius)² of the area, and so more than half of it for d above 0.71 radius.
Result<std::vector<std::uint64_t>> texels_near_borders(const SurfaceValues& values, double radius,
                                                       const mesh::SurfaceMap& map,
                                                       const mesh::TexelGraph& graph,
                                                       const Progress& progress) {
  const auto distances = STRATA_TRY(border_distances(
      map, graph, [&](std::uint32_t a, std::uint32_t b) { return !values.same(a, b); },
      static_cast<float>(std::min(radius, 0.75 * radius + mean_texel_size(map))), progress));
  std::vector<std::uint64_t> near(map.block_of_slot.size(), 0);
  for (std::uint32_t texel = 0; texel < distances.size(); ++texel)
    if (std::isfinite(distances[texel])) near[texel / 64] |= std::uint64_t{1} << texel % 64;
  return near;
}

}  // namespace

double max_majority_radius(const mesh::SurfaceMap& map) {
  return kMaxTexels * mean_texel_size(map);
}

Result<SurfaceValues> majority(SurfaceValues values, double radius, const mesh::SurfaceMap& map,
                               const mesh::TexelGraph& graph, Progress& progress, int threads) {
  if (map.surface_texels == 0) return values;
  if (!(radius <= max_majority_radius(map)))
    return fail(ErrorCode::invalid, "Radius too large",
                "The radius is larger than 40 texels of this layer. Choose a smaller radius.",
                "radius_mm");
  constexpr const char* kCounting = "Comparing areas";
  progress.report(0, "Finding borders");
  const auto near = STRATA_TRY(texels_near_borders(values, radius, map, graph, progress));
  progress.report(0.2, kCounting);
  const RowRuns rows(values, map, graph, threads);

  constexpr std::size_t kSlotsAtOnce = 256;
  const std::size_t parts = (near.size() + kSlotsAtOnce - 1) / kSlotsAtOnce;
  std::vector<std::vector<std::pair<std::uint32_t, TexelValue>>> changes(parts);
  std::atomic<std::size_t> done{0};
  mesh::parallel_for(threads, static_cast<int>(parts), [&](int number) {
    const auto part = static_cast<std::size_t>(number);
    std::optional<Neighbourhoods> around;
    for (std::size_t slot = part * kSlotsAtOnce;
         slot < std::min(near.size(), (part + 1) * kSlotsAtOnce); ++slot)
      for (std::uint64_t left = near[slot]; left != 0; left &= left - 1) {
        if (progress.cancelled()) return;
        if (!around) around.emplace(values, rows, map, graph, radius);
        const auto texel = static_cast<std::uint32_t>(
            slot * 64 + static_cast<std::size_t>(std::countr_zero(left)));
        const TexelValue value = around->majority(texel);
        if (value != values.of(texel)) changes[part].emplace_back(texel, value);
      }
    progress.report(0.2 + 0.8 * double(++done) / double(parts), kCounting);
  });
  if (progress.cancelled()) return cancelled_problem();
  for (const auto& part : changes)
    for (const auto& [texel, value] : part) values.set(texel, value);
  return values;
}

}  // namespace strata::query
