#include "query/statistics/statistics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "mesh/parallel.h"
#include "mesh/texels/surface_map.h"
#include "query/statistics/perimeter.h"
#include "query/statistics/pieces.h"

namespace strata::query {
namespace {

class Counting {
 public:
  Counting(const LayerView& view, const mesh::SurfaceMap& map, const StatisticsRequest& request)
      : type_(view.layer.type), map_(map), request_(request) {
    for (const auto& [address, tile] : view.snapshot.tiles)
      if (tile) tiles_.emplace_back(address, &tile);
    // Sums of floats depend on their order, so sorting makes the statistics of a layer
    // reproducible.
    std::ranges::sort(tiles_, {}, [](const auto& tile) { return tile.first; });
  }

  std::vector<std::shared_ptr<const TileSums>> sums() const {
    std::vector<std::shared_ptr<const TileSums>> found(tiles_.size());
    for_each_tile(
        [&](std::size_t i, TileAddress address, const std::shared_ptr<const TileData>& tile) {
          const auto make = [&] { return sum_tile(*tile, address, type_, map_, request_.within); };
          found[i] = cache() ? cache()->sums(address, tile, make)
                             : std::make_shared<const TileSums>(make());
        });
    return found;
  }

  TileHistogram histogram(double min, double max) const {
    std::vector<std::shared_ptr<const TileHistogram>> found(tiles_.size());
    for_each_tile(
        [&](std::size_t i, TileAddress address, const std::shared_ptr<const TileData>& tile) {
          const auto make = [&] {
            return count_tile(*tile, address, type_, map_, request_.within, min, max);
          };
          found[i] = cache() ? cache()->histogram(address, tile, min, max, make)
                             : std::make_shared<const TileHistogram>(make());
        });
    TileHistogram all;
    for (const auto& of_tile : found)
      for (std::size_t bin = 0; bin < kHistogramBins; ++bin) {
        all.texels[bin] += of_tile->texels[bin];
        all.area[bin] += of_tile->area[bin];
      }
    return all;
  }

 private:
  TileSumsCache* cache() const { return request_.within ? nullptr : request_.cache; }
  template <class Work>
  void for_each_tile(Work work) const {
    mesh::parallel_for(request_.threads, static_cast<int>(tiles_.size()), [&](int number) {
      const auto i = static_cast<std::size_t>(number);
      work(i, tiles_[i].first, *tiles_[i].second);
    });
  }

  const ValueType type_;
  const mesh::SurfaceMap& map_;
  const StatisticsRequest& request_;
  std::vector<std::pair<TileAddress, const std::shared_ptr<const TileData>*>> tiles_;
};

TileSums join(const std::vector<std::shared_ptr<const TileSums>>& parts) {
  TileSums all;
  std::unordered_map<std::uint32_t, std::uint32_t> index;
  for (const auto& part : parts) {
    if (part->texels == 0) continue;
    const double before = all.area.value(), more = part->area.value();
    const double apart = before > 0 && more > 0 ? part->mean() - all.mean() : 0;
    all.area += part->area;
    all.weighted += part->weighted;
    all.squares += part->squares;
    if (apart != 0) all.squares += apart * apart * before * more / all.area.value();
    all.min = all.texels == 0 ? part->min : std::min(all.min, part->min);
    all.max = all.texels == 0 ? part->max : std::max(all.max, part->max);
    all.texels += part->texels;
    all.too_many_keys |= part->too_many_keys;
    if (all.too_many_keys) continue;
    for (const auto& key : part->keys) {
      const auto [found, fresh] =
          index.try_emplace(key.bits, static_cast<std::uint32_t>(all.keys.size()));
      if (fresh)
        all.keys.push_back(key);
      else
        all.keys[found->second].add(key);
    }
    all.too_many_keys = all.keys.size() > kMaxStatisticsKeys;
  }
  if (all.too_many_keys) all.keys.clear();
  return all;
}

}  // namespace

Statistics statistics(const LayerView& view, const mesh::SurfaceMap& map, const glm::dvec3& origin,
                      double metres_per_unit, const StatisticsRequest& request) {
  if (map.resolution != view.layer.resolution)
    throw std::invalid_argument("The surface map has another resolution than the layer.");
  const ValueType type = view.layer.type;
  const double m2_per_unit2 = metres_per_unit * metres_per_unit;
  const Counting counting(view, map, request);
  const TileSums sums = join(counting.sums());
  Statistics out;
  if (request.pieces) out.pieces = 0;
  if (request.perimeter) out.perimeter_m = 0;
  if (sums.texels == 0) return out;
  out.texels = sums.texels;
  const double area = sums.area.value();
  out.area_m2 = area * m2_per_unit2;
  out.min = sums.min;
  out.max = sums.max;
  out.mean = sums.mean();
  out.std = area > 0 ? std::sqrt(sums.squares / area) : 0;
  out.root_mean_square = std::hypot(out.mean, out.std);
  for (const auto& key : sums.keys) {
    const double of_key = key.area.value();
    const glm::dvec3 centroid =
        of_key > 0 ? key.weighted_position / of_key : (key.lowest + key.highest) / 2.0;
    out.keys[decode_value(type, key.bits)] = {key.texels, of_key * m2_per_unit2, centroid + origin,
                                              key.lowest + origin, key.highest + origin};
  }

  TileHistogram histogram;
  if (sums.keys.empty()) {
    histogram = counting.histogram(out.min, out.max);
  } else {
    for (const auto& key : sums.keys) {
      const auto bin =
          static_cast<std::size_t>(bin_of(decode_value(type, key.bits), out.min, out.max));
      histogram.texels[bin] += key.texels;
      histogram.area[bin] += key.area.value();
    }
  }
  const double range = out.max - out.min;
  const int bins = range > 0 ? kHistogramBins : 1;
  for (int i = 0; i < bins; ++i)
    out.histogram.push_back({out.min + range * i / bins, out.min + range * (i + 1) / bins,
                             histogram.texels[static_cast<std::size_t>(i)],
                             histogram.area[static_cast<std::size_t>(i)] * m2_per_unit2});

  if (request.quantiles) out.quantiles = quantiles(view, map, request.within, sums);
  const ValueClasses value_classes{.each = !is_float(type)};
  if (request.pieces) {
    const PieceCounts counts =
        count_pieces(view, map, *request.graph, request.within, value_classes);
    out.pieces = counts.all;
    for (const auto& [bits, pieces] : counts.of_class)
      if (const auto key = out.keys.find(decode_value(type, bits)); key != out.keys.end())
        key->second.pieces = pieces;
  }
  if (request.perimeter) {
    const Perimeters perimeters = measure_perimeters(view, map, *request.graph, request.within,
                                                     value_classes, request.threads);
    out.perimeter_m = perimeters.all * metres_per_unit;
    for (auto& [key, of_key] : out.keys) of_key.perimeter_m = 0;
    for (const auto& [bits, length] : perimeters.of_class)
      if (const auto key = out.keys.find(decode_value(type, bits)); key != out.keys.end())
        key->second.perimeter_m = length * metres_per_unit;
  }
  return out;
}

}  // namespace strata::query
