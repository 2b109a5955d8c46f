#include "mesh/texels/texel_graph.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "mesh/parallel.h"
#include "mesh/surface/connectivity.h"
#include "mesh/surface/face_neighbours.h"
#include "mesh/surface/uv_islands.h"
#include "mesh/texels/gutter_ring.h"
#include "mesh/texels/texel_owners.h"
#include "mesh/texels/texel_raster.h"

namespace strata::mesh {
namespace {

constexpr std::uint32_t kNoTexel = 0xffffffffu;
constexpr double kSamplesPerTexel = 2;
constexpr const char* kJoining = "Joining texels across the surface";

std::uint32_t texel_number(const SurfaceMap& map, int x, int y) {
  if (x < 0 || y < 0 || x >= map.resolution || y >= map.resolution) return kNoTexel;
  const auto slot =
      map.slot_of_block[static_cast<std::size_t>(y / kBlockSize) * map.blocks_per_side +
                        x / kBlockSize];
  if (slot == kNoSlot) return kNoTexel;
  const int i = y % kBlockSize * kBlockSize + x % kBlockSize;
  return (map.surface_mask[slot] >> i) & 1u ? slot * 64 + static_cast<std::uint32_t>(i) : kNoTexel;
}

glm::ivec2 texel_place(const SurfaceMap& map, std::uint32_t texel) {
  const auto block = static_cast<int>(map.block_of_slot[texel / 64]),
             i = static_cast<int>(texel % 64);
  return {block % map.blocks_per_side * kBlockSize + i % kBlockSize,
          block / map.blocks_per_side * kBlockSize + i / kBlockSize};
}

class Builder {
 public:
  Builder(const Geometry& geometry, const SurfaceMap& map, const TexelOwners& owners)
      : geometry_(geometry),
        map_(map),
        islands_(find_islands(geometry.indices, geometry.vertices.size())),
        neighbours_(face_neighbours(surface_connectivity(geometry))) {
    island_of_texel_.resize(owners.triangle.size());
    for (std::size_t slot = 0; slot < map.surface_mask.size(); ++slot)
      for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1) {
        const std::size_t texel = slot * 64 + static_cast<std::size_t>(std::countr_zero(left));
        island_of_texel_[texel] = islands_.of_triangle[owners.triangle[texel]];
      }
  }

  void join_in_atlas(TexelGraph& graph, std::size_t slot) const {
    for (std::uint64_t left = map_.surface_mask[slot]; left != 0; left &= left - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
      const auto texel = static_cast<std::uint32_t>(slot) * 64 + i;
      const glm::ivec2 at = texel_place(map_, texel);
      if (is_same_island(texel, texel_number(map_, at.x + 1, at.y)))
        graph.to_right[slot] |= std::uint64_t{1} << i;
      if (is_same_island(texel, texel_number(map_, at.x, at.y + 1)))
        graph.to_upper[slot] |= std::uint64_t{1} << i;
    }
  }

  // A texel of a thin triangle and its position along the triangle.
  struct Along {
    double at;
    std::uint32_t texel;
    bool operator<(const Along& other) const {
      return at != other.at ? at < other.at : texel < other.texel;
    }
  };

  // `scratch` is memory that is reused for speed.
  void link_triangle(std::uint32_t triangle, std::vector<TexelGraph::Link>& links,
                     std::vector<std::uint32_t>& at_open_edge, std::vector<Along>& scratch) const {
    for (int k = 0; k < 3; ++k) link_edge(triangle, k, links, at_open_edge);
    // In a triangle thinner than two texels, a texel may touch neither another texel nor a sample
    // of the edges. Samples on the line to the centroid are therefore added. They are the only
    // samples of a triangle between texel centers.
    const glm::dvec2 a = uv(triangle, 0), b = uv(triangle, 1), c = uv(triangle, 2);
    const double twice_area = std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
    glm::dvec2 side = b - a;
    for (const glm::dvec2 other : {c - b, a - c})
      if (glm::length(other) > glm::length(side)) side = other;
    if (twice_area > 2 * glm::length(side)) return;
    const auto island = islands_.of_triangle[triangle];
    scratch.clear();
    const auto add = [&](const glm::dvec2& point, std::uint32_t texel) {
      if (texel != kNoTexel) scratch.push_back({glm::dot(point, side), texel});
    };
    const glm::dvec2 centroid = (a + b + c) / 3.0;
    const int steps =
        std::max(1, static_cast<int>(std::ceil(glm::length(centroid - a) * kSamplesPerTexel)));
    for (int i = 0; i <= steps; ++i) {
      const glm::dvec2 point = glm::mix(a, centroid, static_cast<double>(i) / steps);
      add(point, resolve(point, island));
    }
    const auto snapped = [&](const glm::dvec2& p) { return snap_to_subtexels(p.x, p.y); };
    const CoverageRaster raster(snapped(a), snapped(b), snapped(c));
    raster.for_each_span(0, map_.resolution, 0, map_.resolution,
                         [&](int y, int x_begin, int x_end) {
                           for (int x = x_begin; x < x_end; ++x)
                             if (const auto texel = texel_number(map_, x, y);
                                 texel != kNoTexel && island_of_texel_[texel] == island)
                               add({x + 0.5, y + 0.5}, texel);
                           return true;
                         });
    link_along(scratch, links);
  }

 private:
  std::uint32_t vertex(std::uint32_t triangle, int k) const {
    return geometry_.indices[3 * std::size_t{triangle} + k];
  }
  std::uint32_t position(std::uint32_t triangle, int k) const {
    return geometry_.vertices[vertex(triangle, k)].position_index;
  }
  glm::dvec2 uv(std::uint32_t triangle, int k) const {
    return glm::dvec2(geometry_.vertices[vertex(triangle, k)].uv) * double(map_.resolution);
  }
  bool is_same_island(std::uint32_t a, std::uint32_t b) const {
    return a != kNoTexel && b != kNoTexel && island_of_texel_[a] == island_of_texel_[b];
  }

  // Returns the island's texel at a point, or its nearest texel at most kGutterRing texels away.
  std::uint32_t resolve(const glm::dvec2& point, std::uint32_t island) const {
    const int x = std::clamp(static_cast<int>(point.x), 0, map_.resolution - 1),
              y = std::clamp(static_cast<int>(point.y), 0, map_.resolution - 1);
    const auto is_its = [&](std::uint32_t texel) {
      return texel != kNoTexel && island_of_texel_[texel] == island;
    };
    if (const auto texel = texel_number(map_, x, y); is_its(texel)) return texel;
    for (const TexelOffset o : kGutterRingOffsets)
      if (const auto texel = texel_number(map_, x + o.x, y + o.y); is_its(texel)) return texel;
    return kNoTexel;
  }

  // Links texels along an edge, and also across it if the edge is a seam.
  void link_edge(std::uint32_t triangle, int k, std::vector<TexelGraph::Link>& links,
                 std::vector<std::uint32_t>& at_open_edge) const {
    const std::uint32_t other = neighbours_[3 * std::size_t{triangle} + k];
    if (other != kNoTriangle && other < triangle) return;  // the other triangle has linked it
    const int next = (k + 1) % 3;
    int other_from = 0, other_to = 0;  // corners of `other` at corners k and next
    bool seam = false;
    if (other != kNoTriangle) {
      while (other_to < 2 && (position(other, other_to) != position(triangle, next) ||
                              position(other, (other_to + 1) % 3) != position(triangle, k)))
        ++other_to;
      other_from = (other_to + 1) % 3;
      seam = vertex(other, other_from) != vertex(triangle, k) ||
             vertex(other, other_to) != vertex(triangle, next);
    }
    const glm::dvec2 a0 = uv(triangle, k), a1 = uv(triangle, next);
    glm::dvec2 b0(0), b1(0);
    if (seam) b0 = uv(other, other_from), b1 = uv(other, other_to);
    const double length = std::max(glm::length(a1 - a0), glm::length(b1 - b0));
    const int steps = std::max(1, static_cast<int>(std::ceil(length * kSamplesPerTexel)));
    // The texels of a sliver may be far apart, so a gap does not end the chain.
    std::uint32_t last_a = kNoTexel, last_b = kNoTexel;
    bool sides_joined = false;
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const auto a = resolve(glm::mix(a0, a1, t), islands_.of_triangle[triangle]);
      extend(last_a, a, links);
      if (other == kNoTriangle && a != kNoTexel) at_open_edge.push_back(a);
      if (!seam) continue;
      const auto b = resolve(glm::mix(b0, b1, t), islands_.of_triangle[other]);
      extend(last_b, b, links);
      if (a == kNoTexel || b == kNoTexel) continue;
      join(a, b, links);
      sides_joined = true;
    }
    // Joins the two sides of a seam if each side has texels only at the gaps of the other side.
    if (seam && !sides_joined) join(last_a, last_b, links);
  }

  // Links each texel to the nearest of a few preceding texels. No link therefore passes over
  // another texel of the triangle.
  void link_along(std::vector<Along>& texels, std::vector<TexelGraph::Link>& links) const {
    // more texels than a triangle of this width contains along two texels of its length
    constexpr std::size_t kBefore = 8;
    std::sort(texels.begin(), texels.end());
    for (std::size_t i = 1; i < texels.size(); ++i) {
      const glm::ivec2 place = texel_place(map_, texels[i].texel);
      std::uint32_t nearest = kNoTexel;
      int least = std::numeric_limits<int>::max();
      for (std::size_t k = i; k-- > i - std::min(i, kBefore);) {
        const glm::ivec2 apart = texel_place(map_, texels[k].texel) - place;
        const int squared = apart.x * apart.x + apart.y * apart.y;
        if (squared < least) least = squared, nearest = texels[k].texel;
      }
      join(nearest, texels[i].texel, links);
    }
  }

  void extend(std::uint32_t& last, std::uint32_t texel,
              std::vector<TexelGraph::Link>& links) const {
    if (texel == kNoTexel) return;
    join(last, texel, links);
    last = texel;
  }

  // Links two texels that are connected on the surface unless the atlas already shows this.
  void join(std::uint32_t a, std::uint32_t b, std::vector<TexelGraph::Link>& links) const {
    if (a == kNoTexel || b == kNoTexel || a == b || shown_by_atlas(a, b)) return;
    const TexelGraph::Link link{a, b};
    if (!links.empty() && links.back() == TexelGraph::Link{b, a}) return;
    links.push_back(link);
    links.emplace_back(b, a);
  }

  bool shown_by_atlas(std::uint32_t a, std::uint32_t b) const {
    if (island_of_texel_[a] != island_of_texel_[b]) return false;
    const glm::ivec2 p = texel_place(map_, a), q = texel_place(map_, b), d = glm::abs(p - q);
    if (d.x + d.y == 1) return true;
    if (d.x != 1 || d.y != 1) return false;
    return is_same_island(a, texel_number(map_, p.x, q.y)) ||
           is_same_island(a, texel_number(map_, q.x, p.y));
  }

  const Geometry& geometry_;
  const SurfaceMap& map_;
  const UvIslands islands_;
  const std::vector<std::uint32_t> neighbours_;
  std::vector<std::uint32_t> island_of_texel_;
};

}  // namespace

std::span<const TexelGraph::Link> TexelGraph::links_of(std::uint32_t texel) const {
  const auto first = std::lower_bound(links.begin(), links.end(), Link{texel, 0});
  auto last = first;
  while (last != links.end() && last->first == texel) ++last;
  return {first, last};
}

std::size_t TexelGraph::linked_texels() const {
  std::size_t count = 0;
  for (const std::uint64_t bits : has_links) count += static_cast<std::size_t>(std::popcount(bits));
  return count;
}

std::size_t TexelGraph::bytes() const {
  return (to_right.capacity() + to_upper.capacity() + has_links.capacity() +
          at_open_edge.capacity()) *
             sizeof(std::uint64_t) +
         links.capacity() * sizeof(Link);
}

Result<TexelGraph> build_texel_graph(const Geometry& geometry, const SurfaceMap& map,
                                     Progress& progress, int threads) {
  auto owners = bake_texel_owners(geometry, map.resolution, progress, threads);
  if (!owners) return tl::unexpected(owners.error());
  progress.report(0.5, kJoining);
  const Builder builder(geometry, map, *owners);
  owners = TexelOwners{};  // releases the memory

  TexelGraph graph;
  const std::size_t slots = map.block_of_slot.size();
  graph.to_right.assign(slots, 0);
  graph.to_upper.assign(slots, 0);
  graph.has_links.assign(slots, 0);
  graph.at_open_edge.assign(slots, 0);
  constexpr std::size_t kAtOnce = 4096;
  const auto parts_of = [](std::size_t count) {
    return static_cast<int>((count + kAtOnce - 1) / kAtOnce);
  };
  parallel_for(threads, parts_of(slots), [&](int part) {
    for (std::size_t slot = part * kAtOnce; slot < std::min(slots, (part + 1) * kAtOnce); ++slot)
      builder.join_in_atlas(graph, slot);
  });
  const std::size_t triangles = geometry.triangle_count();
  std::vector<std::vector<TexelGraph::Link>> links(parts_of(triangles));
  std::vector<std::vector<std::uint32_t>> at_open_edge(links.size());
  parallel_for(threads, static_cast<int>(links.size()), [&](int part) {
    if (progress.cancelled()) return;
    std::vector<Builder::Along> scratch;
    for (std::size_t t = part * kAtOnce; t < std::min(triangles, (part + 1) * kAtOnce); ++t)
      builder.link_triangle(static_cast<std::uint32_t>(t), links[part], at_open_edge[part],
                            scratch);
    std::sort(links[part].begin(), links[part].end());
    links[part].erase(std::unique(links[part].begin(), links[part].end()), links[part].end());
  });
  if (progress.cancelled()) return cancelled_problem();
  for (const auto& part : links) graph.links.insert(graph.links.end(), part.begin(), part.end());
  std::sort(graph.links.begin(), graph.links.end());
  graph.links.erase(std::unique(graph.links.begin(), graph.links.end()), graph.links.end());
  graph.links.shrink_to_fit();
  for (const auto& link : graph.links)
    graph.has_links[link.first / 64] |= std::uint64_t{1} << (link.first % 64);
  for (const auto& part : at_open_edge)
    for (const std::uint32_t texel : part)
      graph.at_open_edge[texel / 64] |= std::uint64_t{1} << (texel % 64);
  progress.report(1, kJoining);
  return graph;
}

std::optional<std::uint32_t> surface_texel_at(const SurfaceMap& map, glm::vec2 uv) {
  const auto texel = [&](float at) {
    return std::clamp(static_cast<int>(at * map.resolution), 0, map.resolution - 1);
  };
  const int x = texel(uv.x), y = texel(uv.y);
  if (const auto found = texel_number(map, x, y); found != kNoTexel) return found;
  for (const TexelOffset o : kGutterRingOffsets)
    if (const auto found = texel_number(map, x + o.x, y + o.y); found != kNoTexel) return found;
  return std::nullopt;
}

}  // namespace strata::mesh
