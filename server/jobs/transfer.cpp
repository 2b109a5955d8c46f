#include "jobs/transfer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "domain/layers/texel_lookup.h"
#include "jobs/counterparts.h"
#include "mesh/texels/surface_map.h"
#include "store/content/models.h"
#include "store/journal/journal_reads.h"

namespace strata::jobs {
namespace {

// Adds the areas of texels in parts. One thread adds each part, so no lock is needed, and the sum
// is the same for any number of threads.
class AreaSum {
 public:
  explicit AreaSum(std::size_t texels) : parts_(texels / mesh::kTexelsAtOnce + 1) {}
  void add(std::size_t texel, double area) { parts_[texel / mesh::kTexelsAtOnce] += area; }
  double total() const { return std::accumulate(parts_.begin(), parts_.end(), 0.0); }

 private:
  std::vector<double> parts_;
};

// The layers with the same resolution.
class Group {
 public:
  Group(const TransferTarget& target, const ComparedSide& here, const ComparedSide& there,
        const CounterpartTolerance& tolerance, int source_resolution, Progress& progress)
      : target_(target),
        here_(here),
        there_(there),
        tolerance_(tolerance),
        source_resolution_(source_resolution),
        resolution_(std::max(source_resolution, target.model.atlas.lowest_resolution)),
        progress_(progress) {}

  int resolution() const { return resolution_; }
  double matched_m2() const { return matched_m2_; }

  // Finds the point on the source from which each texel of the target takes its values.
  Result<void> match(double from, double to) {
    progress_.begin_stage(from, from);
    auto map = STRATA_TRY(target_.surface_map(resolution_));
    map_ = std::move(map);
    auto found =
        STRATA_TRY(find_counterparts(here_, there_, tolerance_, resolution_, progress_, from, to));
    found_ = std::move(found);
    double matched = 0;
    for (std::size_t texel = 0; texel < found_.uv.size(); ++texel)
      if (found_.has(texel)) matched += map_->area[texel];
    matched_m2_ = matched * here_.metres * here_.metres;
    return {};
  }

  // The painted area of a layer on the source, and the part of it without a counterpart on the
  // target.
  struct Balance {
    double source_m2 = 0, lost_m2 = 0;
  };
  Result<std::vector<Balance>> balance(const std::vector<TileMap>& layers, double from, double to) {
    progress_.begin_stage(from, from + 0.4 * (to - from));
    auto map = STRATA_TRY(mesh::bake_surface_map(*there_.geometry, source_resolution_, progress_));
    auto owners =
        STRATA_TRY(mesh::bake_texel_owners(*there_.geometry, source_resolution_, progress_));
    std::vector<AreaSum> painted(layers.size(), AreaSum(owners.triangle.size())), lost = painted;
    progress_.begin_stage(from + 0.4 * (to - from), to);
    const auto weigh = [&](std::size_t texel) {
      std::optional<bool> is_lost;
      for (std::size_t i = 0; i < layers.size(); ++i) {
        if (!is_valid(layers[i], owners, texel)) continue;
        if (!is_lost) is_lost = !counterpart(there_, owners, texel, here_, tolerance_);
        painted[i].add(texel, map.area[texel]);
        if (*is_lost) lost[i].add(texel, map.area[texel]);
      }
    };
    if (auto done = mesh::for_each_texel(owners, weigh, "Measuring the lost areas", progress_);
        !done)
      return tl::unexpected(done.error());
    std::vector<Balance> balances;
    const double m2 = there_.metres * there_.metres;
    for (std::size_t i = 0; i < layers.size(); ++i)
      balances.push_back({painted[i].total() * m2, lost[i].total() * m2});
    return balances;
  }

  Result<TransferredLayer> paint(const Layer& layer, const TileMap& tiles, const Balance& balance) {
    AreaSum area(found_.uv.size());
    const auto bits = [&](std::size_t texel) -> std::optional<std::uint32_t> {
      if (!found_.has(texel)) return std::nullopt;
      const auto found = bits_at(tiles, layer.resolution, found_.uv[texel]);
      if (found) area.add(texel, map_->area[texel]);
      return found;
    };
    auto painted = STRATA_TRY(mesh::paint_texels(found_.owners, layer.type, bits, progress_));
    return TransferredLayer{&layer,
                            resolution_,
                            std::move(painted),
                            balance.source_m2,
                            area.total() * here_.metres * here_.metres,
                            balance.lost_m2};
  }

 private:
  static bool is_valid(const TileMap& tiles, const mesh::TexelOwners& owners, std::size_t texel) {
    const auto block = owners.block_of_slot[texel / 64];
    const int x = static_cast<int>(block % owners.blocks_per_side) * kBlockSize +
                  static_cast<int>(texel % kBlockSize);
    const int y = static_cast<int>(block / owners.blocks_per_side) * kBlockSize +
                  static_cast<int>(texel % 64) / kBlockSize;
    const auto tile = tiles.find(
        {static_cast<std::uint16_t>(x / kTileSize), static_cast<std::uint16_t>(y / kTileSize)});
    return tile != tiles.end() &&
           tile->second->valid.test(y % kTileSize * kTileSize + x % kTileSize);
  }

  const TransferTarget& target_;
  const ComparedSide &here_, &there_;
  const CounterpartTolerance tolerance_;
  const int source_resolution_, resolution_;
  Progress& progress_;
  std::shared_ptr<const mesh::SurfaceMap> map_;
  Counterparts found_;  // on the source, for each texel of the target
  double matched_m2_ = 0;
};

}  // namespace

Result<TransferSummary> transfer_layers(store::Store& store, const TransferTarget& target,
                                        const TransferRequest& request, const Deliver& deliver,
                                        Progress& progress) {
  progress.report(0, "Reading the other model");
  auto bytes = STRATA_TRY(store.models().geometry(request.source.id));
  auto decoded = STRATA_TRY(mesh::decode_geometry(bytes));
  bytes.clear();
  const auto source = std::make_shared<const mesh::Geometry>(std::move(decoded));
  const ComparedSide there(source, std::make_shared<const mesh::SearchTree>(source),
                           request.source.metres());
  const ComparedSide here(target.geometry, target.tree, target.model.metres());
  const CounterpartTolerance tolerance{
      request.tolerance_mm / 1000,
      static_cast<float>(std::cos(glm::radians(request.max_angle_degrees)))};

  std::map<int, std::vector<const Layer*>> by_resolution;
  for (const Layer& layer : request.layers) by_resolution[layer.resolution].push_back(&layer);
  TransferSummary summary{target.model.area_m2(), 0};
  double start = 0.02;
  const double share =
      (1 - start) / static_cast<double>(std::max<std::size_t>(1, by_resolution.size()));
  for (const auto& [resolution, layers] : by_resolution) {
    Group group(target, here, there, tolerance, resolution, progress);
    STRATA_TRY(group.match(start, start + 0.5 * share));
    std::vector<TileMap> contents;
    for (const Layer* layer : layers) {
      auto tiles = STRATA_TRY(store.journal().load_tiles(*layer));
      contents.push_back(std::move(tiles.tiles));
    }
    auto balances = STRATA_TRY(group.balance(contents, start + 0.5 * share, start + 0.8 * share));
    for (std::size_t i = 0; i < layers.size(); ++i) {
      const double step = 0.2 * share / static_cast<double>(layers.size());
      const double from = start + 0.8 * share + static_cast<double>(i) * step;
      progress.begin_stage(from, from + step);
      auto layer = STRATA_TRY(group.paint(*layers[i], contents[i], balances[i]));
      STRATA_TRY(deliver(std::move(layer)));
      contents[i].clear();
    }
    summary.matched_m2 = std::max(summary.matched_m2, group.matched_m2());
    start += share;
  }
  return summary;
}

}  // namespace strata::jobs
