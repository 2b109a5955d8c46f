#include "query/regions/line_graph.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/progress.h"
#include "query/regions/touching_texels.h"

namespace strata::query {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr double kLeastBranch = 3;  // texels
// The steps between rows of texels move a center line by up to this number of texels.
constexpr double kTolerance = 1.5;

// Returns the distance of a point from a segment.
double from_segment(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 side = b - a;
  const double squared = glm::dot(side, side);
  const double along =
      squared > 0 ? std::clamp(glm::dot(point - a, side) / squared, 0.0, 1.0) : 0.0;
  return glm::distance(point, a + along * side);
}

// Returns the length of the line that Douglas and Peucker leave.
double simplified_length(const std::vector<glm::dvec3>& line, double tolerance) {
  double length = 0;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, line.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    std::size_t farthest = first;
    double most = tolerance;
    for (std::size_t i = first + 1; i < last; ++i)
      if (const double away = from_segment(line[i], line[first], line[last]); away > most)
        most = away, farthest = i;
    if (farthest == first) {
      length += glm::distance(line[first], line[last]);
    } else {
      open.emplace_back(first, farthest);
      open.emplace_back(farthest, last);
    }
  }
  return length;
}

}  // namespace

// Finds the nodes and chains.
class LineGraph::Tracer {
 public:
  Tracer(LineGraph& graph, const std::vector<std::uint32_t>& texels, const Pieces& pieces,
         const mesh::TexelGraph& texel_graph)
      : graph_(graph),
        texels_(texels),
        beside_(texels.size()),
        node_(texels.size(), kNone),
        traced_(texels.size()) {
    for (std::uint32_t i = 0; i < texels.size(); ++i)
      for_each_touching(graph.map_, texel_graph, texels[i], [&](std::uint32_t other) {
        const auto found = std::ranges::lower_bound(texels, other);
        if (found == texels.end() || *found != other ||
            pieces.of_texel[other] != pieces.of_texel[texels[i]])
          return;
        const auto index = static_cast<std::uint32_t>(found - texels.begin());
        add(i, index);
        add(index, i);
      });
  }

  void run() {
    for (std::uint32_t i = 0; i < texels_.size(); ++i) {
      if (beside_[i].size() <= 1) node_[i] = add_node(i);
      if (beside_[i].size() > 2 && node_[i] == kNone) add_junction(i);
    }
    for (std::uint32_t i = 0; i < texels_.size(); ++i)
      if (node_[i] != kNone)
        for (const std::uint32_t next : beside_[i]) follow(i, next);
    // What is left are closed lines.
    for (std::uint32_t i = 0; i < texels_.size(); ++i)
      if (node_[i] == kNone && !traced_[i]) {
        node_[i] = add_node(i);
        follow(i, beside_[i].front());
      }
  }

 private:
  void add(std::uint32_t from, std::uint32_t to) {
    auto& list = beside_[from];
    if (std::ranges::find(list, to) == list.end()) list.push_back(to);
  }
  std::uint32_t add_node(std::uint32_t index) {
    graph_.nodes_.push_back({texels_[index], {}});
    return static_cast<std::uint32_t>(graph_.nodes_.size() - 1);
  }

  // Texels of a junction that touch each other are one node, at the widest place.
  void add_junction(std::uint32_t index) {
    const std::uint32_t node = add_node(index);
    std::vector<std::uint32_t> open{index};
    node_[index] = node;
    double widest = graph_.half_width_(texels_[index]);
    for (std::size_t next = 0; next < open.size(); ++next)
      for (const std::uint32_t other : beside_[open[next]]) {
        if (beside_[other].size() <= 2 || node_[other] != kNone) continue;
        node_[other] = node;
        open.push_back(other);
        if (const double half = graph_.half_width_(texels_[other]); half > widest)
          widest = half, graph_.nodes_[node].texel = texels_[other];
      }
  }

  // Adds the chain that leaves a node over the texel `next`, unless it was traced before.
  void follow(std::uint32_t start, std::uint32_t next) {
    const std::uint32_t from = node_[start];
    if (node_[next] != kNone) {
      if (node_[next] <= from) return;  // the same node, or traced from the other end
      add_chain(from, node_[next], {});
      return;
    }
    if (traced_[next]) return;
    std::vector<std::uint32_t> between;
    std::uint32_t before = start;
    while (node_[next] == kNone) {
      traced_[next] = true;
      between.push_back(texels_[next]);
      const auto& sides = beside_[next];
      const std::uint32_t after = sides[0] == before ? sides[1] : sides[0];
      before = std::exchange(next, after);
    }
    add_chain(from, node_[next], between);
  }

  void add_chain(std::uint32_t from, std::uint32_t to, const std::vector<std::uint32_t>& between) {
    Chain chain{from, to, {graph_.nodes_[from].texel}};
    chain.texels.insert(chain.texels.end(), between.begin(), between.end());
    chain.texels.push_back(graph_.nodes_[to].texel);
    const auto number = static_cast<std::uint32_t>(graph_.chains_.size());
    graph_.nodes_[from].chains.push_back(number);
    graph_.nodes_[to].chains.push_back(number);
    graph_.chains_.push_back(std::move(chain));
  }

  LineGraph& graph_;
  const std::vector<std::uint32_t>& texels_;
  std::vector<std::vector<std::uint32_t>> beside_;  // by index of a texel: indices of others
  std::vector<std::uint32_t> node_;                 // by index of a texel
  std::vector<bool> traced_;                        // by index of a texel
};

LineGraph::LineGraph(const std::vector<std::uint32_t>& texels, const Pieces& pieces,
                     const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                     HalfWidth half_width)
    : map_(map), half_width_(std::move(half_width)) {
  Tracer(*this, texels, pieces, graph).run();
}

double LineGraph::texel_size(std::uint32_t texel) const {
  return std::sqrt(double{map_.area[texel]});
}

double LineGraph::length_of(const Chain& chain) const {
  if (chain.length == kUnknown) chain.length = measured_length(chain.texels);
  return chain.length;
}

double LineGraph::measured_length(const std::vector<std::uint32_t>& texels) const {
  std::vector<glm::dvec3> line;
  double tolerance = 0;
  for (const std::uint32_t texel : texels) {
    line.emplace_back(map_.position(texel / 64, static_cast<int>(texel % 64)));
    tolerance += std::max(kTolerance * texel_size(texel), half_width_(texel) / 4);
  }
  tolerance /= double(texels.size());
  if (texels.front() != texels.back()) return simplified_length(line, tolerance);
  // The simplification of a closed line needs a second point on it.
  const auto farthest = std::ranges::max_element(
      line, {}, [&](const glm::dvec3& at) { return glm::distance(at, line.front()); });
  return simplified_length({line.begin(), farthest + 1}, tolerance) +
         simplified_length({farthest, line.end()}, tolerance);
}

// Returns whether a chain that ends freely is only a part of the width of the line at its other
// end.
bool LineGraph::is_branch(const Node& at, const Chain& chain) const {
  const Node& end = nodes_[&nodes_[chain.from] == &at ? chain.to : chain.from];
  if (end.chains.size() != 1) return true;
  const double half = half_width_(at.texel),
               protrudes = length_of(chain) + half_width_(end.texel) - half;
  return protrudes >= std::max(2 * half, kLeastBranch * texel_size(at.texel));
}

void LineGraph::remove(std::uint32_t chain) {
  chains_[chain].removed = true;
  std::erase(nodes_[chains_[chain].from].chains, chain);
  std::erase(nodes_[chains_[chain].to].chains, chain);
}

bool LineGraph::remove_branches() {
  std::vector<std::uint32_t> short_ones;
  for (const Node& node : nodes_) {
    if (node.chains.size() < 3) continue;
    for (const std::uint32_t chain : node.chains)
      if (!is_branch(node, chains_[chain])) short_ones.push_back(chain);
  }
  std::vector<std::uint32_t> junctions;
  for (const std::uint32_t chain : short_ones) {
    const auto [from, to] = std::pair(chains_[chain].from, chains_[chain].to);
    const bool ends_at_to = nodes_[to].chains.size() == 1;
    remove(chain);
    nodes_[ends_at_to ? to : from].texel = kNone;
    junctions.push_back(ends_at_to ? from : to);
  }
  for (const std::uint32_t junction : junctions) join_chains_at(junction);
  return !short_ones.empty();
}

bool LineGraph::remove_loops() {
  bool found = false;
  for (std::uint32_t node = 0; node < nodes_.size(); ++node)
    while (remove_loop_at(node)) found = true;
  return found;
}

// Removes a closed chain, or the longer one of two chains between the same nodes, if the loop is
// small compared with the width: a hole in the line.
bool LineGraph::remove_loop_at(std::uint32_t node) {
  if (nodes_[node].chains.size() < 3) return false;
  constexpr double kSmallLoop = 6;  // of the width
  const std::uint32_t at = nodes_[node].texel;
  const double small = kSmallLoop * std::max(2 * half_width_(at), kLeastBranch * texel_size(at));
  const auto far_end = [&](std::uint32_t chain) {
    return chains_[chain].from == node ? chains_[chain].to : chains_[chain].from;
  };
  const auto& chains = nodes_[node].chains;
  for (const std::uint32_t one : chains) {
    const std::uint32_t far = far_end(one);
    const double length = length_of(chains_[one]);
    const bool closes =
        far == node ? length < small : std::ranges::any_of(chains, [&](std::uint32_t other) {
          return other != one && far_end(other) == far && length_of(chains_[other]) <= length &&
                 length + length_of(chains_[other]) < small;
        });
    if (!closes) continue;
    remove(one);
    join_chains_at(node);
    if (far != node) join_chains_at(far);
    return true;
  }
  return false;
}

// A node between two chains is no longer a junction.
void LineGraph::join_chains_at(std::uint32_t node) {
  if (nodes_[node].chains.size() != 2 || nodes_[node].chains[0] == nodes_[node].chains[1]) return;
  const std::uint32_t stays = nodes_[node].chains[0], goes = nodes_[node].chains[1];
  Chain& first = chains_[stays];
  Chain second = chains_[goes];
  remove(goes);
  std::erase(nodes_[node].chains, stays);
  if (first.from == node) {
    std::swap(first.from, first.to);
    std::ranges::reverse(first.texels);
  }
  if (second.to == node) {
    std::swap(second.from, second.to);
    std::ranges::reverse(second.texels);
  }
  first.texels.insert(first.texels.end(), second.texels.begin() + 1, second.texels.end());
  first.to = second.to;
  first.length = kUnknown;
  nodes_[first.to].chains.push_back(stays);
  nodes_[node].texel = kNone;
}

void LineGraph::prune(const Progress& progress) {
  while (!progress.cancelled() && (remove_branches() || remove_loops())) {
  }
}

std::vector<LineGraph::Part> LineGraph::parts() const {
  std::vector<Part> parts;
  for (const Chain& chain : chains_)
    if (!chain.removed) parts.push_back({chain.texels.front(), length_of(chain)});
  for (const Node& node : nodes_)
    if (node.texel != kNone && node.chains.size() < 2)
      parts.push_back({node.texel, double(2 - node.chains.size()) * half_width_(node.texel)});
  return parts;
}

}  // namespace strata::query
