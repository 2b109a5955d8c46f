#include "mesh/surface/chart_rims.h"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace strata::mesh {
namespace {

std::uint64_t key_of(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

// Edges with a triangle on one side alone, ascending.
std::vector<std::uint64_t> rim_edges(const Geometry& geometry) {
  std::vector<std::uint64_t> edges;
  edges.reserve(geometry.indices.size());
  for (std::size_t i = 0; i < geometry.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k)
      edges.push_back(key_of(geometry.indices[i + k], geometry.indices[i + (k + 1) % 3]));
  std::ranges::sort(edges);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && edges[end] == edges[i]) ++end;
    if (end - i == 1) edges[kept++] = edges[i];
    i = end;
  }
  edges.resize(kept);
  return edges;
}

// Vertices that triangles join, as trees that are kept flat.
class Charts {
 public:
  explicit Charts(const Geometry& geometry) : parent_(geometry.vertices.size()) {
    std::iota(parent_.begin(), parent_.end(), 0u);
    for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
      join(geometry.indices[i], geometry.indices[i + 1]);
      join(geometry.indices[i], geometry.indices[i + 2]);
    }
  }
  std::uint32_t of(std::uint32_t vertex) {
    while (parent_[vertex] != vertex) vertex = parent_[vertex] = parent_[parent_[vertex]];
    return vertex;
  }

 private:
  void join(std::uint32_t a, std::uint32_t b) {
    a = of(a), b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  std::vector<std::uint32_t> parent_;
};

}  // namespace

std::vector<ChartRims> find_chart_rims(const Geometry& geometry) {
  const std::vector<std::uint64_t> edges = rim_edges(geometry);
  std::unordered_multimap<std::uint32_t, std::uint32_t> next;
  std::vector<std::uint32_t> starts;
  for (std::size_t i = 0; i < geometry.indices.size(); i += 3)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = geometry.indices[i + k], to = geometry.indices[i + (k + 1) % 3];
      if (!std::ranges::binary_search(edges, key_of(from, to))) continue;
      next.emplace(from, to);
      starts.push_back(from);
    }
  Charts charts(geometry);
  std::unordered_map<std::uint32_t, std::size_t> number_of;
  std::vector<ChartRims> all;
  for (const std::uint32_t start : starts) {
    // As many edges leave a vertex as come to it, so that the way ends where it began.
    std::vector<std::uint32_t> ring;
    std::uint32_t at = start;
    for (auto edge = next.find(at); edge != next.end(); edge = next.find(at)) {
      ring.push_back(at);
      at = edge->second;
      next.erase(edge);
      if (at == start) break;
    }
    if (ring.size() < 3) continue;
    const auto [known, is_new] = number_of.try_emplace(charts.of(start), all.size());
    if (is_new) all.emplace_back();
    all[known->second].rings.push_back(std::move(ring));
  }
  return all;
}

}  // namespace strata::mesh
