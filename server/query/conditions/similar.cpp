#include "query/conditions/similar.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "mesh/parallel.h"
#include "query/conditions/flood_from.h"
#include "query/conditions/texel_values.h"
#include "query/conditions/tile_table.h"
#include "query/sampling/cielab.h"
#include "query/sampling/texel_appearance.h"
#include "query/statistics/value_classes.h"

namespace strata::query {
namespace {

using mesh::kNoNeighbour;
using mesh::Way;

// Calls visit(texel) once for the texel, for its neighbors in 3 × 3 texels of the atlas, and for
// the texels on the other side of a seam.
template <class Visit>
void for_each_around(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                     std::uint32_t texel, Visit&& visit) {
  std::array<std::uint32_t, 9> around{texel};
  std::size_t count = 1;
  const auto next = [&](std::uint32_t from, Way way) {
    return from == kNoNeighbour ? kNoNeighbour : mesh::neighbour(map, graph, from, way);
  };
  const auto take = [&](std::uint32_t found) {
    if (found != kNoNeighbour) around[count++] = found;
  };
  const std::uint32_t upper = next(texel, Way::upper), lower = next(texel, Way::lower);
  take(upper);
  take(lower);
  for (const Way side : {Way::left, Way::right}) {
    const std::uint32_t beside = next(texel, side);
    take(beside);
    for (const auto& [way, middle] : {std::pair(Way::upper, upper), std::pair(Way::lower, lower)}) {
      const std::uint32_t corner = next(middle, side);
      take(corner != kNoNeighbour ? corner : next(beside, way));
    }
  }
  const std::span atlas(around.data(), count);
  std::ranges::for_each(atlas, visit);
  if ((graph.has_links[texel / 64] >> texel % 64 & 1u) == 0) return;
  for (const mesh::TexelGraph::Link& link : graph.links_of(texel))
    if (std::ranges::find(atlas, link.second) == atlas.end()) visit(link.second);
}

// A field gives each texel a value that can be averaged, or none, and compares means:
//   bool has(texel), dvec3 at(texel), Compared compared(mean), bool near(compared, compared),
//   kAverages

class Colors {
 public:
  using Compared = glm::vec3;
  static constexpr bool kAverages = true;
  Colors(std::span<const std::uint32_t> colors, double tolerance)
      : colors_(colors), squared_(static_cast<float>(tolerance * tolerance)) {}
  bool has(std::uint32_t texel) const { return has_color(colors_[texel]); }
  glm::dvec3 at(std::uint32_t texel) const {
    const std::uint32_t color = colors_[texel];
    const auto light = [&](int shift) {
      return light_[static_cast<std::size_t>(color >> shift & 0xffu)];
    };
    return {light(0), light(8), light(16)};
  }
  static glm::vec3 compared(const glm::dvec3& mean) { return lab_of_light(glm::vec3(mean)); }
  bool near(const glm::vec3& a, const glm::vec3& b) const {
    return glm::dot(a - b, a - b) <= squared_;
  }

 private:
  static std::array<float, 256> lights() {
    std::array<float, 256> light{};
    for (std::size_t i = 0; i < light.size(); ++i)
      light[i] = light_of_srgb(static_cast<std::uint8_t>(i));
    return light;
  }
  const std::span<const std::uint32_t> colors_;
  const std::array<float, 256> light_ = lights();
  const float squared_;
};

class Normals {
 public:
  using Compared = glm::vec3;
  static constexpr bool kAverages = true;
  Normals(std::span<const std::uint32_t> normals, double degrees)
      : normals_(normals),
        least_cos_(static_cast<float>(std::cos(glm::radians(std::min(degrees, 180.0))) - 1e-6)) {}
  bool has(std::uint32_t texel) const { return normals_[texel] != kNoNormal; }
  glm::dvec3 at(std::uint32_t texel) const { return unpacked_normal(normals_[texel]); }
  static glm::vec3 compared(const glm::dvec3& mean) {
    const double length = glm::length(mean);
    return glm::vec3(length > 0 ? mean / length : mean);
  }
  bool near(const glm::vec3& a, const glm::vec3& b) const { return glm::dot(a, b) >= least_cos_; }

 private:
  const std::span<const std::uint32_t> normals_;
  const float least_cos_;
};

template <bool averages>
class Values {
 public:
  using Compared = double;
  static constexpr bool kAverages = averages;
  Values(const LayerView& view, const mesh::SurfaceMap& map, double tolerance)
      : map_(map),
        type_(view.layer.type),
        decoded_(values_of_bits(type_)),
        tiles_(view.snapshot.tiles, view.layer.resolution),
        tolerance_(tolerance) {}
  bool has(std::uint32_t texel) const {
    const Stored stored = find(texel);
    return stored.tile && stored.tile->valid.test(stored.in_tile) &&
           std::isfinite(value_of(stored));
  }
  glm::dvec3 at(std::uint32_t texel) const { return {value_of(find(texel)), 0, 0}; }
  static double compared(const glm::dvec3& mean) { return mean.x; }
  bool near(double a, double b) const { return std::abs(a - b) <= tolerance_; }

 private:
  struct Stored {
    const TileData* tile;
    int in_tile;
  };
  Stored find(std::uint32_t texel) const {
    const auto block = static_cast<int>(map_.block_of_slot[texel / 64]),
               i = static_cast<int>(texel % 64);
    const int x = tiles_.texel_under(block % map_.blocks_per_side * kBlockSize + i % kBlockSize,
                                     map_.resolution),
              y = tiles_.texel_under(block / map_.blocks_per_side * kBlockSize + i / kBlockSize,
                                     map_.resolution);
    return {tiles_.of_texel(x, y), y % kTileSize * kTileSize + x % kTileSize};
  }
  double value_of(const Stored& stored) const {
    const std::uint32_t bits = stored.tile->bits(stored.in_tile);
    return decoded_ ? decoded_[bits] : decode_value(type_, bits);
  }
  const mesh::SurfaceMap& map_;
  const ValueType type_;
  const double* const decoded_;
  const TileTable tiles_;
  const double tolerance_;
};

// Returns whether texels are similar to the texel at which the selection starts.
template <class Field>
class Comparison {
 public:
  Comparison(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph, const Field& field,
             std::uint32_t start)
      : map_(map), graph_(graph), field_(field), start_has_(field.has(start)) {
    if (start_has_) at_start_ = Field::kAverages ? mean(start) : Field::compared(field.at(start));
  }
  bool operator()(std::uint32_t texel) const {
    const bool has = field_.has(texel);
    if (!has || !start_has_) return has == start_has_;
    if (field_.near(Field::compared(field_.at(texel)), at_start_)) return true;
    return Field::kAverages && field_.near(mean(texel), at_start_);
  }

 private:
  // The sum of equal values is exact: their mean is the value itself.
  typename Field::Compared mean(std::uint32_t texel) const {
    glm::dvec3 sum(0);
    double count = 0;
    for_each_around(map_, graph_, texel, [&](std::uint32_t each) {
      if (!field_.has(each)) return;
      sum += field_.at(each);
      ++count;
    });
    return Field::compared(sum / count);
  }
  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  const Field& field_;
  const bool start_has_;
  typename Field::Compared at_start_{0};
};

// The space within the radius of the places. Use each object on one thread.
class Reach {
 public:
  explicit Reach(const Similarity& similarity)
      : places_(similarity.around), radius_(similarity.radius) {
    if (!std::isfinite(radius_)) return;
    for (std::size_t i = 0; i < places_.size(); ++i)
      cells_[cell_of(places_[i].position)].push_back(i);
  }
  bool contains(const glm::vec3& at) {
    if (!std::isfinite(radius_)) return true;
    if (is_near(last_, at)) return true;  // like most texels, because their neighbors are
    const Cell middle = cell_of(at);
    for (int i = 0; i < 27; ++i) {
      const auto cell =
          cells_.find({middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1});
      if (cell == cells_.end()) continue;
      for (const std::size_t place : cell->second)
        if (is_near(place, at)) {
          last_ = place;
          return true;
        }
    }
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(const glm::vec3& at) const {
    const glm::dvec3 cell = glm::floor(glm::dvec3(at) / double{radius_});
    return {static_cast<std::int64_t>(cell.x), static_cast<std::int64_t>(cell.y),
            static_cast<std::int64_t>(cell.z)};
  }
  bool is_near(std::size_t place, const glm::vec3& at) const {
    return place < places_.size() && glm::distance(places_[place].position, at) <= radius_;
  }
  const std::vector<Similarity::Place>& places_;
  const float radius_;
  std::map<Cell, std::vector<std::size_t>> cells_;  // cubes with side radius_
  std::size_t last_ = 0;
};

void keep_if(TexelSelection& selection, int threads,
             const std::function<bool(std::uint32_t)>& belongs) {
  constexpr std::size_t kSlotsAtOnce = 256;
  const auto parts = static_cast<int>((selection.size() + kSlotsAtOnce - 1) / kSlotsAtOnce);
  mesh::parallel_for(threads, parts, [&](int part) {
    const std::size_t first = static_cast<std::size_t>(part) * kSlotsAtOnce,
                      last = std::min(selection.size(), first + kSlotsAtOnce);
    for (std::size_t slot = first; slot < last; ++slot)
      for (std::uint64_t left = selection[slot]; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        if (!belongs(static_cast<std::uint32_t>(slot * 64) + static_cast<std::uint32_t>(i)))
          selection[slot] &= ~(std::uint64_t{1} << i);
      }
  });
}

template <class Field>
TexelSelection select_similar(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                              const Field& field, const Similarity& similarity, int threads) {
  const Comparison<Field> similar(map, graph, field, similarity.start);
  std::vector<std::uint32_t> starts;
  for (const Similarity::Place& place : similarity.around) starts.push_back(place.texel);
  Reach reach(similarity);
  const auto in_reach = [&](std::uint32_t texel) {
    return reach.contains(map.position(texel / 64, static_cast<int>(texel % 64)));
  };
  if (!similarity.contiguous) {
    auto selection = std::isfinite(similarity.radius) ? flood_from(map, graph, starts, in_reach)
                                                      : map.surface_mask;
    keep_if(selection, threads, similar);
    return selection;
  }
  return flood_from(map, graph, starts,
                    [&](std::uint32_t texel) { return in_reach(texel) && similar(texel); });
}

}  // namespace

TexelSelection select_similar_colors(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                     std::span<const std::uint32_t> colors,
                                     const Similarity& similarity, int threads) {
  return select_similar(map, graph, Colors(colors, similarity.tolerance), similarity, threads);
}

TexelSelection select_similar_normals(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                      std::span<const std::uint32_t> normals,
                                      const Similarity& similarity, int threads) {
  return select_similar(map, graph, Normals(normals, similarity.tolerance), similarity, threads);
}

TexelSelection select_similar_values(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                     const LayerView& view, const Similarity& similarity,
                                     int threads) {
  if (classes_of(view.layer).each)
    return select_similar(map, graph, Values<false>(view, map, similarity.tolerance), similarity,
                          threads);
  return select_similar(map, graph, Values<true>(view, map, similarity.tolerance), similarity,
                        threads);
}

}  // namespace strata::query
