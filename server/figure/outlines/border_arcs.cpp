#include "figure/outlines/border_arcs.h"

#include <unordered_map>

namespace strata::figure {
namespace {

constexpr std::array<glm::ivec2, 4> kSteps{
    {{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};  // right, down, left, up

class Tracer {
 public:
  Tracer(const LabelFaces& faces, std::size_t most_sides)
      : faces_(faces),
        most_sides_(most_sides),
        walked_((static_cast<std::size_t>(faces.columns) + 1) *
                (static_cast<std::size_t>(faces.rows) + 1)) {}

  Result<BorderGraph> trace(const Progress& progress) {
    for (const bool at_nodes : {true, false})  // afterwards, only rings are left
      for (int y = 0; y <= faces_.rows; ++y) {
        if (progress.cancelled()) return cancelled_problem();
        for (int x = 0; x <= faces_.columns; ++x) {
          const glm::ivec2 corner(x, y);
          if (at_nodes && !is_node(corner)) continue;
          for (int direction = 0; direction < 4; ++direction)
            if (is_border(corner, direction) && !is_walked(corner, direction))
              walk(corner, direction, at_nodes);
        }
        if (sides_ > most_sides_)
          return fail(ErrorCode::invalid, "Too many outlines",
                      "The areas of a layer consist of too many small pieces for outlines. Choose "
                      "a larger tolerance, smaller paper, or a figure without outlines.",
                      "tolerance_mm");
      }
    return std::move(graph_);
  }

 private:
  // The faces on the left and on the right of the side of a cell that leaves a corner.
  std::pair<std::uint32_t, std::uint32_t> sides_of(const glm::ivec2& corner, int direction) const {
    const int x = corner.x, y = corner.y;
    switch (direction) {
      case 0: return {faces_.at(x, y - 1), faces_.at(x, y)};
      case 1: return {faces_.at(x, y), faces_.at(x - 1, y)};
      case 2: return {faces_.at(x - 1, y), faces_.at(x - 1, y - 1)};
      default: return {faces_.at(x - 1, y - 1), faces_.at(x, y - 1)};
    }
  }
  bool is_border(const glm::ivec2& corner, int direction) const {
    const auto [left, right] = sides_of(corner, direction);
    return left != right;
  }
  bool is_node(const glm::ivec2& corner) const {
    if ((corner.x == 0 || corner.x == faces_.columns) && (corner.y == 0 || corner.y == faces_.rows))
      return true;
    int borders = 0;
    for (int direction = 0; direction < 4; ++direction) borders += is_border(corner, direction);
    return borders > 2;
  }

  // One bit for each of the sides that leave a corner.
  std::uint8_t& bits_of(const glm::ivec2& corner) {
    return walked_[static_cast<std::size_t>(corner.y) *
                       (static_cast<std::size_t>(faces_.columns) + 1) +
                   static_cast<std::size_t>(corner.x)];
  }
  bool is_walked(const glm::ivec2& corner, int direction) {
    return (bits_of(corner) >> direction & 1) != 0;
  }
  void mark(const glm::ivec2& corner, int direction) {
    bits_of(corner) |= static_cast<std::uint8_t>(1 << direction);
  }

  std::uint32_t node_at(const glm::ivec2& corner) {
    const std::uint64_t key =
        static_cast<std::uint64_t>(corner.y) << 32 | static_cast<std::uint32_t>(corner.x);
    const auto [found, is_new] =
        numbers_.try_emplace(key, static_cast<std::uint32_t>(graph_.nodes.size()));
    if (is_new) graph_.nodes.push_back({corner});
    return found->second;
  }

  void walk(glm::ivec2 corner, int direction, bool from_node) {
    const auto number = static_cast<HalfArc>(graph_.arcs.size());
    BorderArc arc;
    std::tie(arc.left, arc.right) = sides_of(corner, direction);
    arc.first_direction = direction;
    const glm::ivec2 start = corner;
    if (from_node) {
      arc.from = node_at(corner);
      graph_.nodes[arc.from].leaving[static_cast<std::size_t>(direction)] = 2 * number;
      arc.chain.push_back(2 * corner);
    }
    while (true) {
      const glm::ivec2 step = kSteps[static_cast<std::size_t>(direction)];
      mark(corner, direction);
      arc.chain.push_back(2 * corner + step);
      corner += step;
      mark(corner, (direction + 2) % 4);
      ++sides_;
      if (from_node ? is_node(corner) : corner == start) break;
      for (const int turn : {0, 1, 3})
        if (is_border(corner, (direction + turn) % 4)) {
          direction = (direction + turn) % 4;
          break;
        }
    }
    if (from_node) {
      arc.last_direction = direction;
      arc.to = node_at(corner);
      graph_.nodes[arc.to].leaving[static_cast<std::size_t>((direction + 2) % 4)] = 2 * number + 1;
      arc.chain.push_back(2 * corner);
    }
    graph_.arcs.push_back(std::move(arc));
  }

  const LabelFaces& faces_;
  const std::size_t most_sides_;
  std::vector<std::uint8_t> walked_;  // by corner
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;
  BorderGraph graph_;
  std::size_t sides_ = 0;
};

}  // namespace

HalfArc BorderGraph::next(HalfArc half) const {
  const BorderArc& arc = arcs[half / 2];
  const bool is_forward = half % 2 == 0;
  const int arriving = is_forward ? arc.last_direction : (arc.first_direction + 2) % 4;
  const BorderNode& node = nodes[is_forward ? arc.to : arc.from];
  for (const int turn : {3, 0, 1})  // left, straight on, right
    if (const HalfArc found = node.leaving[static_cast<std::size_t>((arriving + turn) % 4)];
        found != kNoHalfArc)
      return found;
  return half ^ 1;  // not reached: each node has two borders or more
}

std::vector<std::vector<HalfArc>> BorderGraph::walks() const {
  std::vector<std::vector<HalfArc>> walks;
  std::vector<std::uint8_t> is_used(2 * arcs.size());
  for (HalfArc first = 0; first < is_used.size(); ++first) {
    if (is_used[first] != 0) continue;
    walks.emplace_back();
    HalfArc half = first;
    do {
      is_used[half] = 1;
      walks.back().push_back(half);
      if (!arcs[half / 2].is_ring()) half = next(half);
    } while (half != first);
  }
  return walks;
}

Result<BorderGraph> border_arcs(const LabelFaces& faces, std::size_t most_sides,
                                const Progress& progress) {
  return Tracer(faces, most_sides).trace(progress);
}

}  // namespace strata::figure
