#include "query/regions/sieve.h"

#include <algorithm>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "mesh/texels/texel_graph.h"
#include "query/statistics/border_lines.h"

namespace strata::query {
namespace {

// Lengths and areas of the same border differ between two atlases, because positions are rounded.
constexpr double kNearlyEqual = 1 - 1e-3;

// The borders of each small region with the regions that it touches. Regions on a surface have on
// average at most six neighbors (Euler's formula), so the memory is proportional to their number.
class Borders {
 public:
  struct Border {
    std::uint32_t neighbour = 0;
    double length = 0;
  };

  // Returns nothing when cancelled.
  static std::optional<Borders> measure(const Regions& regions, const std::vector<bool>& is_small,
                                        const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                        const Progress& progress) {
    Borders borders;
    if (!borders.find(regions, is_small, map, graph, progress)) return std::nullopt;
    const BorderLines lines(map, graph);
    const auto measure = [&](std::uint32_t texel, std::uint32_t region) {
      if (!is_small[region]) return;
      lines.for_each_crossing(
          texel,
          [&](std::uint32_t other) {
            return other != mesh::kNoNeighbour && regions.of_texel[other] != region;
          },
          [&](std::uint32_t other, double length) {
            // A line may cross a thin region, and end in a region that this one does not touch.
            const std::uint32_t neighbour = regions.of_texel[other];
            const auto of = borders.of(region);
            const auto found = std::ranges::lower_bound(of, neighbour, {}, &Border::neighbour);
            if (found != of.end() && found->neighbour == neighbour) found->length += length;
          });
    };
    if (!for_each_texel_of_regions(regions, map, progress, measure)) return std::nullopt;
    return borders;
  }

  std::span<const Border> of(std::uint32_t region) const {
    return {list_.data() + first_[region], list_.data() + first_[region + 1]};
  }

 private:
  std::span<Border> of(std::uint32_t region) {
    return {list_.data() + first_[region], list_.data() + first_[region + 1]};
  }

  // Finds the regions that touch. Returns false when cancelled.
  bool find(const Regions& regions, const std::vector<bool>& is_small, const mesh::SurfaceMap& map,
            const mesh::TexelGraph& graph, const Progress& progress) {
    std::vector<std::uint64_t> pairs;  // a region and its neighbor
    const auto merge = [&] {
      std::ranges::sort(pairs);
      pairs.erase(std::ranges::unique(pairs).begin(), pairs.end());
    };
    std::size_t merge_at = 1 << 18;
    const auto find = [&](std::uint32_t texel, std::uint32_t region) {
      if (!is_small[region]) return;
      mesh::for_each_neighbour(map, graph, texel, [&](std::uint32_t other) {
        if (const std::uint32_t neighbour = regions.of_texel[other]; neighbour != region)
          pairs.push_back(std::uint64_t{region} << 32 | neighbour);
      });
      if (pairs.size() < merge_at) return;
      merge();
      merge_at = std::max(merge_at, 2 * pairs.size());
    };
    if (!for_each_texel_of_regions(regions, map, progress, find)) return false;
    merge();
    first_.assign(regions.list.size() + 1, 0);
    list_.reserve(pairs.size());
    for (const std::uint64_t pair : pairs) {
      ++first_[(pair >> 32) + 1];
      list_.push_back({static_cast<std::uint32_t>(pair), 0});
    }
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    return true;
  }

  std::vector<std::size_t> first_;  // by region; one more for the end
  std::vector<Border> list_;        // by region, then by neighbor
};

// Gives small regions to their neighbors, in rounds. A round uses only the results of earlier
// rounds, so the order of the regions does not matter.
class Merging {
 public:
  Merging(const Regions& regions, const std::vector<bool>& is_small, const Borders& borders)
      : regions_(regions), borders_(borders), owner_(regions.list.size(), kNoRegion) {
    for (std::uint32_t i = 0; i < owner_.size(); ++i)
      if (!is_small[i]) owner_[i] = i;
  }

  // Returns false when cancelled.
  bool run(const Progress& progress) {
    std::vector<std::uint32_t> round, owners;
    for (std::uint32_t i = 0; i < owner_.size(); ++i)
      if (owner_[i] == kNoRegion) round.push_back(i);
    while (!round.empty()) {
      owners.clear();
      for (const std::uint32_t region : round) {
        if (owners.size() % 4096 == 0 && progress.cancelled()) return false;
        owners.push_back(best_owner(region));
      }
      std::vector<std::uint32_t> next;
      for (std::size_t i = 0; i < round.size(); ++i) owner_[round[i]] = owners[i];
      for (std::size_t i = 0; i < round.size(); ++i)
        if (owners[i] != kNoRegion)
          for (const Borders::Border& border : borders_.of(round[i]))
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
  std::uint32_t best_owner(std::uint32_t region) const {
    std::vector<std::pair<std::uint32_t, double>> lengths;  // by owner
    for (const Borders::Border& border : borders_.of(region))
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
  const Borders& borders_;
  // the region that each region belongs to; kNoRegion while a small region waits
  std::vector<std::uint32_t> owner_;
};

}  // namespace

Result<CleanedValues> sieve(SurfaceValues values, const Regions& regions, double min_area,
                            SieveTo to, const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                            Progress& progress) {
  std::vector<bool> is_small(regions.list.size());
  for (std::size_t i = 0; i < is_small.size(); ++i)
    is_small[i] = regions.list[i].value.valid && regions.list[i].area < min_area;
  std::vector<std::optional<TexelValue>> new_values(regions.list.size());
  if (to == SieveTo::no_value) {
    for (std::size_t i = 0; i < is_small.size(); ++i)
      if (is_small[i]) new_values[i] = TexelValue{};
    return recolored(std::move(values), regions, new_values, map, progress);
  }
  progress.report(0, "Measuring borders");
  const auto borders = Borders::measure(regions, is_small, map, graph, progress);
  if (!borders) return cancelled_problem();
  progress.report(0.7, "Merging small regions");
  Merging merging(regions, is_small, *borders);
  if (!merging.run(progress)) return cancelled_problem();
  for (std::uint32_t i = 0; i < is_small.size(); ++i)
    if (const TexelValue& value = regions.list[merging.owner(i)].value;
        value != regions.list[i].value)
      new_values[i] = value;
  return recolored(std::move(values), regions, new_values, map, progress);
}

}  // namespace strata::query
