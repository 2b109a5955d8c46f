#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "mesh/texels/texel_graph.h"
#include "query/regions/region_pieces.h"

namespace strata {
class Progress;
}

namespace strata::query {

// The center lines of pieces as a graph: nodes are the ends and junctions of lines, and chains of
// texels join them. A closed line without a junction has one node.
class LineGraph {
 public:
  // Returns half of the width at a texel, in model units.
  using HalfWidth = std::function<double(std::uint32_t)>;

  // `texels` are those of the center lines of the pieces, ascending.
  LineGraph(const std::vector<std::uint32_t>& texels, const Pieces& pieces,
            const mesh::SurfaceMap& map, const mesh::TexelGraph& graph, HalfWidth half_width);

  // Removes the branches and small loops that do not count (see measure_lines). Ends early when
  // cancelled.
  void prune(const Progress& progress);

  // A part of a center line, with one of its texels.
  struct Part {
    std::uint32_t texel = 0;
    double length = 0;  // model units
  };
  // Returns the chains, and the parts between the ends of lines and the border.
  std::vector<Part> parts() const;

 private:
  class Tracer;
  static constexpr double kUnknown = -1;
  struct Node {
    std::uint32_t texel = 0;            // kNone: removed
    std::vector<std::uint32_t> chains;  // a closed chain is listed twice
  };
  struct Chain {
    std::uint32_t from = 0, to = 0;     // nodes
    std::vector<std::uint32_t> texels;  // from node to node, with their texels
    // Model units; kUnknown until it is needed, because chains can be joined many times.
    mutable double length = kUnknown;
    bool removed = false;
  };
  double length_of(const Chain& chain) const;
  double measured_length(const std::vector<std::uint32_t>& texels) const;
  double texel_size(std::uint32_t texel) const;
  bool is_branch(const Node& at, const Chain& chain) const;
  bool remove_branches();
  bool remove_loops();
  bool remove_loop_at(std::uint32_t node);
  void remove(std::uint32_t chain);
  void join_chains_at(std::uint32_t node);

  const mesh::SurfaceMap& map_;
  const HalfWidth half_width_;
  std::vector<Node> nodes_;
  std::vector<Chain> chains_;
};

}  // namespace strata::query
