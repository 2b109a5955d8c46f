#include "query/regions/sieve.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "core/progress.h"
#include "mesh/texels/texel_graph.h"
#include "query/regions/recolor.h"
#include "query/statistics/border_lines.h"

namespace strata::query {
namespace {

// Lengths and areas of the same border differ in their last digits between two atlases.
constexpr double kNearlyEqual = 1 - 1e-6;

// The border of a small region with one of its neighbors.
struct Border {
  std::uint32_t region = 0, neighbour = 0;
  bool touches = false;  // a line may cross a thin region between two that do not touch
  double length = 0;
  bool operator<(const Border& other) const {
    return std::tie(region, neighbour) < std::tie(other.region, other.neighbour);
  }
};

void merge_equal(std::vector<Border>& borders) {
  std::sort(borders.begin(), borders.end());
  std::size_t kept = 0;
  for (const Border& border : borders) {
    if (kept > 0 && borders[kept - 1].region == border.region &&
        borders[kept - 1].neighbour == border.neighbour) {
      borders[kept - 1].touches |= border.touches;
      borders[kept - 1].length += border.length;
    } else {
      borders[kept++] = border;
    }
  }
  borders.resize(kept);
}

// Collects borders. Merges them often enough that the memory stays proportional to their number.
class BorderSums {
 public:
  void add(const Border& border) {
    borders_.push_back(border);
    if (borders_.size() < merge_at_) return;
    merge_equal(borders_);
    merge_at_ = std::max(kMergeAt, 2 * borders_.size());
  }
  // Returns the borders between regions that touch, sorted by region.
  std::vector<Border> take() && {
    merge_equal(borders_);
    std::erase_if(borders_, [](const Border& border) { return !border.touches; });
    return std::move(borders_);
  }

 private:
  static constexpr std::size_t kMergeAt = 1 << 20;
  std::size_t merge_at_ = kMergeAt;
  std::vector<Border> borders_;
};

Result<std::vector<Border>> measure_borders(const Regions& regions,
                                            const std::vector<bool>& is_small,
                                            const mesh::SurfaceMap& map,
                                            const mesh::TexelGraph& graph,
                                            const Progress& progress) {
  const BorderLines lines(map, graph);
  BorderSums sums;
  const auto measure = [&](std::uint32_t texel, std::uint32_t region) {
    if (!is_small[region]) return;
    mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t other) {
      if (regions.of_texel[other] != region) sums.add({region, regions.of_texel[other], true, 0});
    });
    lines.for_each_crossing(
        texel,
        [&](std::uint32_t other) {
          return other != mesh::kNoNeighbour && regions.of_texel[other] != region;
        },
        [&](std::uint32_t other, double length) {
          sums.add({region, regions.of_texel[other], false, length});
        });
  };
  if (!for_each_texel_of_regions(regions, map, progress, measure)) return cancelled_problem();
  return std::move(sums).take();
}

// Gives small regions to their neighbors, in rounds. A round uses only the results of earlier
// rounds, so the order of the regions does not matter.
class Merging {
 public:
  Merging(const Regions& regions, const std::vector<bool>& is_small, std::vector<Border> borders)
      : regions_(regions), borders_(std::move(borders)), owner_(regions.list.size(), kNoRegion) {
    for (std::uint32_t i = 0; i < owner_.size(); ++i)
      if (!is_small[i]) owner_[i] = i;
  }

  // Returns false when cancelled.
  bool run(const Progress& progress) {
    std::vector<std::uint32_t> round, owners;
    for (const Border& border : borders_)
      if (round.empty() || round.back() != border.region) round.push_back(border.region);
    while (!round.empty()) {
      if (progress.cancelled()) return false;
      owners.clear();
      for (const std::uint32_t region : round) owners.push_back(best_owner(region));
      std::vector<std::uint32_t> next;
      for (std::size_t i = 0; i < round.size(); ++i) owner_[round[i]] = owners[i];
      for (std::size_t i = 0; i < round.size(); ++i)
        if (owners[i] != kNoRegion)
          for (const Border& border : borders_of(round[i]))
            if (owner_[border.neighbour] == kNoRegion) next.push_back(border.neighbour);
      std::sort(next.begin(), next.end());
      next.erase(std::unique(next.begin(), next.end()), next.end());
      round = std::move(next);
    }
    return true;
  }

  // Returns the region whose value this region gets: itself if it keeps its value.
  std::uint32_t owner(std::uint32_t region) const {
    return owner_[region] == kNoRegion ? region : owner_[region];
  }

 private:
  std::span<const Border> borders_of(std::uint32_t region) const {
    const auto [first, last] =
        std::equal_range(borders_.begin(), borders_.end(), region,
                         [](const auto& a, const auto& b) { return number(a) < number(b); });
    return {first, last};
  }
  static std::uint32_t number(const Border& border) { return border.region; }
  static std::uint32_t number(std::uint32_t region) { return region; }

  std::uint32_t best_owner(std::uint32_t region) const {
    std::vector<std::pair<std::uint32_t, double>> lengths;  // by owner
    for (const Border& border : borders_of(region))
      if (const std::uint32_t owner = owner_[border.neighbour]; owner != kNoRegion)
        lengths.emplace_back(owner, border.length);
    if (lengths.empty()) return kNoRegion;
    std::sort(lengths.begin(), lengths.end());
    std::size_t owners = 0;
    for (const auto& [owner, length] : lengths) {
      if (owners > 0 && lengths[owners - 1].first == owner)
        lengths[owners - 1].second += length;
      else
        lengths[owners++] = {owner, length};
    }
    lengths.resize(owners);
    double longest = 0, largest = 0;
    for (const auto& [owner, length] : lengths) longest = std::max(longest, length);
    std::erase_if(lengths, [&](const auto& each) { return each.second < longest * kNearlyEqual; });
    for (const auto& [owner, length] : lengths) largest = std::max(largest, area(owner));
    std::erase_if(lengths,
                  [&](const auto& each) { return area(each.first) < largest * kNearlyEqual; });
    return std::ranges::min_element(lengths, {},
                                    [&](const auto& each) {
                                      const TexelValue& value = regions_.list[each.first].value;
                                      return std::tuple(!value.valid, value.bits, each.first);
                                    })
        ->first;
  }
  double area(std::uint32_t region) const { return regions_.list[region].area; }

  const Regions& regions_;
  const std::vector<Border> borders_;  // sorted by region
  // the region that each region belongs to; kNoRegion while a small region waits
  std::vector<std::uint32_t> owner_;
};

}  // namespace

Result<CleanedValues> sieve(SurfaceValues values, double min_area, SieveTo to,
                            const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                            Progress& progress) {
  progress.report(0, "Finding regions");
  const Regions regions = STRATA_TRY(find_regions(values, map, graph, progress));
  std::vector<bool> is_small(regions.list.size());
  for (std::size_t i = 0; i < is_small.size(); ++i)
    is_small[i] = regions.list[i].value.valid && regions.list[i].area < min_area;
  std::vector<std::optional<TexelValue>> new_values(regions.list.size());
  if (to == SieveTo::no_value) {
    for (std::size_t i = 0; i < is_small.size(); ++i)
      if (is_small[i]) new_values[i] = TexelValue{};
    return recolored(std::move(values), regions, new_values, map, progress);
  }
  progress.report(0.4, "Measuring borders");
  auto borders = STRATA_TRY(measure_borders(regions, is_small, map, graph, progress));
  progress.report(0.8, "Merging small regions");
  Merging merging(regions, is_small, std::move(borders));
  if (!merging.run(progress)) return cancelled_problem();
  for (std::uint32_t i = 0; i < is_small.size(); ++i)
    if (const TexelValue& value = regions.list[merging.owner(i)].value;
        value != regions.list[i].value)
      new_values[i] = value;
  return recolored(std::move(values), regions, new_values, map, progress);
}

}  // namespace strata::query
