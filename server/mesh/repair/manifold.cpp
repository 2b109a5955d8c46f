#include "mesh/repair/manifold.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "mesh/io/load_formats.h"
#include "mesh/repair/keep_triangles.h"
#include "mesh/surface/edges.h"

namespace strata::mesh {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
// As a share of the longest edge. A corner this close to the edge is off the edge only because of
// float rounding.
constexpr double kSliverHeight = 1e-5;
constexpr std::size_t kMaxShells = 64;  // only the largest shells may contain hollows
constexpr std::size_t kMaxSides = 64;   // of a repaired edge; other edges are cut on all sides

std::uint32_t next_corner(std::uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}
std::uint32_t corner_before(std::uint32_t corner) {
  return corner % 3 == 0 ? corner + 2 : corner - 1;
}

class Manifold {
 public:
  explicit Manifold(LoadedMesh& loaded) : mesh_(loaded.mesh), repairs_(loaded.repairs) {}

  Result<void> run(Progress& progress, double from, double to) {
    const auto step = [&](double share, const char* message) {
      progress.report(from + (to - from) * share, message);
      return !progress.cancelled();
    };
    if (!step(0, "Finding neighboring triangles")) return cancelled_problem();
    find_mates();
    if (crowded_edges_ > 0) drop_slivers();
    if (slivers_ > 0) find_mates();
    if (!step(0.6, "Turning triangles the same way")) return cancelled_problem();
    orient();
    if (!step(0.8, "Cutting non-manifold edges")) return cancelled_problem();
    turn_triangles();
    split_fans();
    if (crowded_edges_ + one_sided_edges_ > 0)
      while (detach_what_still_touches()) {
        if (progress.cancelled()) return cancelled_problem();
        split_fans();
      }
    note(repairs_, "dropped slivers on edges of other triangles", slivers_);
    note(repairs_, "cut edges of more than two triangles", crowded_edges_);
    note(repairs_, "turned triangles to agree with their neighbours", turned_);
    note(repairs_, "closed pieces turned outward", turned_pieces_);
    note(repairs_, "cut edges where the surface has only one side", one_sided_edges_);
    note(repairs_, "cut vertices where pieces of the surface only touch", cut_vertices_);
    return {};
  }

 private:
  const glm::dvec3& point(std::uint32_t corner) const {
    return mesh_.positions[mesh_.triangles[corner]];
  }

  // Returns true if the triangle has no area and this side is its longest side, except for
  // rounding.
  bool is_sliver_along(std::uint32_t corner) const {
    const glm::dvec3 along = point(next_corner(corner)) - point(corner),
                     to = point(corner_before(corner)) - point(corner);
    const double length = glm::length(along);
    const double across = glm::dot(to, along);
    return across > 0 && across < length * length &&
           glm::length(glm::cross(along, to)) < kSliverHeight * length * length;
  }

  void drop_slivers() {
    std::vector<bool> dropped(mesh_.triangle_count(), false);
    for_each_edge(mesh_.triangles, mesh_.positions.size(),
                  [&](std::uint32_t, std::span<const HalfEdge> sides) {
                    std::size_t left = 0;
                    for (const HalfEdge& side : sides) left += !dropped[side.triangle()];
                    for (const HalfEdge& side : sides) {
                      if (left <= 2) return;
                      if (dropped[side.triangle()] || !is_sliver_along(side.corner)) continue;
                      dropped[side.triangle()] = true;
                      ++slivers_;
                      --left;
                    }
                  });
    if (slivers_ > 0)
      keep_triangles(mesh_, [&](std::size_t triangle) { return !dropped[triangle]; });
  }

  void find_mates() {
    mate_.assign(mesh_.triangles.size(), kNone);
    std::vector<CrowdedEdge> crowded;
    for_each_edge(mesh_.triangles, mesh_.positions.size(),
                  [&](std::uint32_t low, std::span<const HalfEdge> sides) {
                    if (sides.size() == 2) join(sides[0].corner, sides[1].corner);
                    if (sides.size() > 2) crowded.push_back({low, {sides.begin(), sides.end()}});
                  });
    crowded_edges_ = crowded.size();
    for (const CrowdedEdge& edge : crowded) pair_up(edge);
  }

  struct CrowdedEdge {
    std::uint32_t low;
    std::vector<HalfEdge> sides;
  };

  // Returns true if the side belongs to a fin whose two other sides are free. Fins are joined last.
  bool is_loose(const HalfEdge& side) const {
    const std::uint32_t other = next_corner(side.corner);
    return mate_[other] == kNone && mate_[next_corner(other)] == kNone;
  }

  void pair_up(const CrowdedEdge& edge) {
    if (edge.sides.size() > kMaxSides) return;
    struct Pair {
      int loose;
      double flatness;
      std::uint32_t a, b;
    };
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < edge.sides.size(); ++i)
      for (std::size_t k = i + 1; k < edge.sides.size(); ++k) {
        const HalfEdge &a = edge.sides[i], &b = edge.sides[k];
        if (a.upward != b.upward)
          pairs.push_back(
              {is_loose(a) + is_loose(b), flatness(edge.low, a, b), a.corner, b.corner});
      }
    std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
      return x.loose != y.loose ? x.loose < y.loose : x.flatness > y.flatness;
    });
    for (const Pair& pair : pairs)
      if (mate_[pair.a] == kNone && mate_[pair.b] == kNone) join(pair.a, pair.b);
  }

  // Returns a larger value for flatter pairs: −1 if the triangles lie on each other, 1 if they lie
  // in one plane.
  double flatness(std::uint32_t low, const HalfEdge& a, const HalfEdge& b) const {
    const glm::dvec3 from = mesh_.positions[low], axis = mesh_.positions[a.other_end] - from;
    const auto away = [&](const HalfEdge& side) {
      const glm::dvec3 to = point(corner_before(side.corner)) - from;
      const glm::dvec3 across =
          to - axis * (glm::dot(to, axis) / std::max(glm::dot(axis, axis), 1e-300));
      return across / std::max(glm::length(across), 1e-300);
    };
    return -glm::dot(away(a), away(b));
  }

  void join(std::uint32_t a, std::uint32_t b) {
    mate_[a] = b;
    mate_[b] = a;
  }

  // Returns true if the triangles on both sides have the same winding. Their sides then have
  // opposite directions.
  bool agree(std::uint32_t corner) const {
    return mesh_.triangles[corner] == mesh_.triangles[next_corner(mate_[corner])];
  }

  // Spreads an orientation from the first triangle of each piece. The triangles of the minority are
  // reversed.
  void orient() {
    const std::size_t count = mesh_.triangle_count();
    is_turned_.assign(count, false);
    std::vector<bool> seen(count, false);
    std::vector<Shell> shells;
    std::vector<std::uint32_t> piece;
    for (std::uint32_t seed = 0; seed < count; ++seed) {
      if (seen[seed]) continue;
      piece.assign(1, seed);
      seen[seed] = true;
      std::size_t turned = 0;
      bool closed = true;
      for (std::size_t i = 0; i < piece.size(); ++i) {
        const std::uint32_t triangle = piece[i];
        turned += is_turned_[triangle];
        for (std::uint32_t corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
          const std::uint32_t mate = mate_[corner];
          if (mate == kNone) {
            closed = false;
            continue;
          }
          const std::uint32_t other = mate / 3;
          const bool must_turn = is_turned_[triangle] == agree(corner);
          if (!seen[other]) {
            seen[other] = true;
            is_turned_[other] = must_turn;
            piece.push_back(other);
          } else if (is_turned_[other] != must_turn) {
            mate_[corner] = mate_[mate] = kNone;
            ++one_sided_edges_;
            closed = false;
          }
        }
      }
      if (2 * turned > piece.size()) {
        for (const std::uint32_t triangle : piece) is_turned_[triangle] = !is_turned_[triangle];
        turned = piece.size() - turned;
      }
      turned_ += turned;
      if (closed) shells.push_back(measure(piece));
    }
    turn_shells(shells);
  }

  struct Shell {
    std::vector<std::uint32_t> triangles;  // empty if oriented outward
    double volume = 0;                     // six times the signed volume
    glm::dvec3 low{INFINITY}, high{-INFINITY};
    bool holds(const Shell& other) const {
      return glm::all(glm::lessThan(low, other.low)) &&
             glm::all(glm::greaterThan(high, other.high));
    }
  };

  Shell measure(const std::vector<std::uint32_t>& piece) const {
    Shell shell;
    const glm::dvec3 base = point(3 * piece.front());
    for (const std::uint32_t triangle : piece) {
      const glm::dvec3 a = point(3 * triangle) - base, b = point(3 * triangle + 1) - base,
                       c = point(3 * triangle + 2) - base;
      const double six = glm::dot(a, glm::cross(b, c));
      shell.volume += is_turned_[triangle] ? -six : six;
      shell.low = glm::min(shell.low, glm::min(a, glm::min(b, c)) + base);
      shell.high = glm::max(shell.high, glm::max(a, glm::max(b, c)) + base);
    }
    if (shell.volume < 0) shell.triangles = piece;
    return shell;
  }

  void turn_shells(std::vector<Shell>& shells) {
    std::vector<const Shell*> largest;
    for (const Shell& shell : shells) largest.push_back(&shell);
    const std::size_t kept_shells = std::min(kMaxShells, largest.size());
    std::partial_sort(
        largest.begin(), largest.begin() + static_cast<std::ptrdiff_t>(kept_shells), largest.end(),
        [](const Shell* a, const Shell* b) { return std::abs(a->volume) > std::abs(b->volume); });
    largest.resize(kept_shells);
    for (const Shell& shell : shells) {
      if (shell.volume >= 0) continue;
      if (std::any_of(largest.begin(), largest.end(),
                      [&](const Shell* other) { return other->holds(shell); }))
        continue;
      ++turned_pieces_;
      for (const std::uint32_t triangle : shell.triangles)
        is_turned_[triangle] = !is_turned_[triangle];
    }
  }

  // Returns the corner at `vertex` of the triangle on the other side of `side`.
  std::uint32_t across(std::uint32_t side, std::uint32_t vertex) const {
    const std::uint32_t mate = mate_[side];
    if (mate == kNone) return kNone;
    return mesh_.triangles[mate] == vertex ? mate : next_corner(mate);
  }

  // Groups the corners of a vertex that are connected through joined sides. Each group after the
  // first gets its own vertex.
  void split_fans() {
    struct Moved {
      std::uint32_t vertex;
      std::vector<std::uint32_t> corners;
    };
    std::vector<Moved> moved;
    const std::size_t vertices = mesh_.positions.size();
    std::vector<bool> seen(mesh_.triangles.size(), false), has_fan(vertices, false),
        is_cut(vertices, false);
    std::vector<std::uint32_t> fan;
    for (std::uint32_t first = 0; first < mesh_.triangles.size(); ++first) {
      if (seen[first]) continue;
      const std::uint32_t vertex = mesh_.triangles[first];
      fan.assign(1, first);
      seen[first] = true;
      for (std::size_t i = 0; i < fan.size(); ++i) {
        for (const std::uint32_t side : {fan[i], corner_before(fan[i])}) {
          const std::uint32_t other = across(side, vertex);
          if (other == kNone || seen[other]) continue;
          seen[other] = true;
          fan.push_back(other);
        }
      }
      if (!has_fan[vertex]) {
        has_fan[vertex] = true;
        continue;
      }
      if (!is_cut[vertex]) ++cut_vertices_;
      is_cut[vertex] = true;
      moved.push_back({copy_vertex(vertex), fan});
    }
    // The vertices are changed at the end only, because `across` depends on the old vertices.
    for (const Moved& move : moved)
      for (const std::uint32_t corner : move.corners) mesh_.triangles[corner] = move.vertex;
  }

  // Triangles at a cut edge may still share both of its vertices. The triangles that are not joined
  // at the edge then get their own copy of the lower vertex. Returns true if such triangles exist.
  bool detach_what_still_touches() {
    std::vector<std::uint32_t> corners;
    for_each_edge(
        mesh_.triangles, mesh_.positions.size(),
        [&](std::uint32_t low, std::span<const HalfEdge> sides) {
          if (sides.size() < 2 || (sides.size() == 2 && mate_[sides[0].corner] == sides[1].corner))
            return;
          std::uint32_t stays = sides[0].corner;  // the side joined to this side also stays
          for (const HalfEdge& side : sides)
            if (mate_[side.corner] != kNone) stays = side.corner;
          for (const HalfEdge& side : sides)
            if (side.corner != stays && mate_[side.corner] != stays)
              corners.push_back(mesh_.triangles[side.corner] == low ? side.corner
                                                                    : next_corner(side.corner));
        });
    for (const std::uint32_t corner : corners) {
      mesh_.triangles[corner] = copy_vertex(mesh_.triangles[corner]);
      for (const std::uint32_t side : {corner, corner_before(corner)}) {
        if (mate_[side] != kNone) mate_[mate_[side]] = kNone;
        mate_[side] = kNone;
      }
    }
    return !corners.empty();
  }

  std::uint32_t copy_vertex(std::uint32_t vertex) {
    mesh_.positions.push_back(glm::dvec3(mesh_.positions[vertex]));
    if (!mesh_.vertex_colors.empty())
      mesh_.vertex_colors.push_back(std::uint32_t{mesh_.vertex_colors[vertex]});
    return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
  }

  // Swaps the corners b and c, and also the sides a-b and c-a.
  void turn_triangles() {
    if (turned_ + turned_pieces_ == 0) return;
    for (std::uint32_t& mate : mate_)
      if (mate != kNone && is_turned_[mate / 3]) mate = mate / 3 * 3 + (2 - mate % 3);
    for (std::size_t t = 0; t < is_turned_.size(); ++t) {
      if (!is_turned_[t]) continue;
      std::swap(mate_[3 * t], mate_[3 * t + 2]);
      std::swap(mesh_.triangles[3 * t + 1], mesh_.triangles[3 * t + 2]);
      if (!mesh_.corner_uvs.empty())
        std::swap(mesh_.corner_uvs[3 * t + 1], mesh_.corner_uvs[3 * t + 2]);
    }
  }

  TriangleMesh& mesh_;
  std::vector<Repair>& repairs_;
  // the neighboring side of each triangle side; sides are numbered by their first corner
  std::vector<std::uint32_t> mate_;
  std::vector<bool> is_turned_;
  std::uint64_t slivers_ = 0, crowded_edges_ = 0, turned_ = 0, turned_pieces_ = 0,
                one_sided_edges_ = 0, cut_vertices_ = 0;
};

}  // namespace

Result<void> make_manifold(LoadedMesh& loaded, Progress& progress, double from, double to) {
  return Manifold(loaded).run(progress, from, to);
}

}  // namespace strata::mesh
