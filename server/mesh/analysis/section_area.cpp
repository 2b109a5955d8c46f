#include "mesh/analysis/section_area.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "domain/people/question.h"

namespace strata::mesh {
namespace {

constexpr double kMostGap = 0.01;  // as a share of the outline's length
// Gaps between more open ends stay open. The search for matching ends takes quadratic time.
constexpr std::size_t kMostOpenEnds = 2000;
constexpr std::size_t kTrianglesAtOnce = 1 << 16;
constexpr double kParallel = 1e-12;

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

struct Piece {
  glm::dvec2 from, to;
};

// A half-plane that keeps the points with dot(normal, p) + offset >= 0. The normal has unit length.
struct Half {
  glm::dvec2 normal;
  double offset;
  double height(const glm::dvec2& p) const { return glm::dot(normal, p) + offset; }
  glm::dvec2 flattened(const glm::dvec2& p) const { return p - std::min(0.0, height(p)) * normal; }
};

// Moves the parts outside the half-plane onto its border. Closed outlines stay closed, and the
// moved parts no longer bound an area.
std::vector<Piece> clipped(const std::vector<Piece>& pieces, const Half& half) {
  std::vector<Piece> result;
  result.reserve(pieces.size());
  for (const Piece& piece : pieces) {
    const double from = half.height(piece.from), to = half.height(piece.to);
    if ((from < 0) == (to < 0)) {
      result.push_back({half.flattened(piece.from), half.flattened(piece.to)});
      continue;
    }
    const glm::dvec2 border = glm::mix(piece.from, piece.to, from / (from - to));
    result.push_back({half.flattened(piece.from), border});
    result.push_back({border, half.flattened(piece.to)});
  }
  return result;
}

// The outline of a plane's section through the mesh.
class Outline {
 public:
  Outline(const Geometry& geometry, const glm::dvec4& plane) : geometry_(geometry) {
    const double length = glm::length(glm::dvec3(plane));
    normal_ = glm::dvec3(plane) / length;
    // relative to the model's origin, for precision
    offset_ = plane.w / length + glm::dot(normal_, geometry.origin);
    const glm::dvec3 helper = std::abs(normal_.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    u_ = glm::normalize(glm::cross(helper, normal_));
    v_ = glm::cross(normal_, u_);
    for (std::size_t first = 0; first < geometry.triangle_count(); first += kTrianglesAtOnce) {
      check_question();
      const std::size_t end = std::min(first + kTrianglesAtOnce, geometry.triangle_count());
      for (std::size_t triangle = first; triangle < end; ++triangle) cut(triangle);
    }
  }

  // Closes the gaps in the outline. Returns false if the gaps are too many or too long.
  bool close() {
    std::vector<glm::dvec2> starts, ends;
    for (const auto& [edge, crossing] : crossings_) {
      for (int i = 0; i < crossing.balance; ++i) starts.push_back(crossing.place);
      for (int i = 0; i > crossing.balance; --i) ends.push_back(crossing.place);
    }
    if (starts.size() != ends.size() || starts.size() > kMostOpenEnds) return false;
    double gaps = 0;
    for (const glm::dvec2& end : ends) {
      const auto nearest = std::ranges::min_element(
          starts, {}, [&](const glm::dvec2& start) { return glm::distance(start, end); });
      gaps += glm::distance(*nearest, end);
      pieces_.push_back({end, *nearest});
      *nearest = starts.back();
      starts.pop_back();
    }
    return gaps <= kMostGap * length_;
  }

  std::vector<Piece>& pieces() { return pieces_; }

  // Returns the half-plane of this plane that the other plane keeps. Returns nothing if the other
  // plane keeps all of this plane or no part of it. `all` is true in the first case.
  std::optional<Half> half(const glm::dvec4& plane, bool& all) const {
    const double length = glm::length(glm::dvec3(plane));
    const glm::dvec3 normal = glm::dvec3(plane) / length;
    const double offset = plane.w / length + glm::dot(normal, geometry_.origin);
    const glm::dvec3 foot = -offset_ * normal_;  // the origin projected onto this plane
    const glm::dvec2 in_plane(glm::dot(normal, u_), glm::dot(normal, v_));
    const double height = glm::dot(normal, foot) + offset, across = glm::length(in_plane);
    all = height >= 0;
    if (across < kParallel) return std::nullopt;
    return Half{in_plane / across, height / across};
  }

 private:
  struct Crossing {
    glm::dvec2 place;
    int balance = 0;  // pieces that start here minus pieces that end here
  };

  glm::dvec3 position(std::uint32_t index) const {
    return geometry_.positions[index] - geometry_.origin;
  }

  // Returns the point where the plane crosses an edge. All triangles at the edge share this point.
  Crossing& crossing(std::uint32_t a, std::uint32_t b) {
    if (a > b) std::swap(a, b);
    const auto [found, is_new] = crossings_.try_emplace(std::uint64_t{a} << 32 | b);
    if (is_new) {
      const glm::dvec3 from = position(a), to = position(b);
      const double low = glm::dot(normal_, from) + offset_, high = glm::dot(normal_, to) + offset_;
      const glm::dvec3 place = glm::mix(from, to, low / (low - high));
      found->second.place = {glm::dot(place, u_), glm::dot(place, v_)};
    }
    return found->second;
  }

  void cut(std::size_t triangle) {
    std::uint32_t corners[3];
    bool above[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const Vertex& vertex = geometry_.vertices[geometry_.indices[3 * triangle + k]];
      corners[k] = vertex.position_index;
      above[k] = glm::dot(normal_, position(corners[k])) + offset_ >= 0;
    }
    if (above[0] == above[1] && above[1] == above[2]) return;
    glm::dvec2 from{}, to{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      if (above[k] == above[next]) continue;
      Crossing& crossed = crossing(corners[k], corners[next]);
      (above[k] ? from : to) = crossed.place;
      crossed.balance += above[k] ? 1 : -1;
    }
    pieces_.push_back({from, to});
    length_ += glm::distance(from, to);
  }

  const Geometry& geometry_;
  glm::dvec3 normal_{}, u_{}, v_{};
  double offset_ = 0, length_ = 0;
  std::vector<Piece> pieces_;
  std::unordered_map<std::uint64_t, Crossing> crossings_;  // by edge
};

CutArea area_of(const Geometry& geometry, std::span<const glm::dvec4> planes, std::size_t which) {
  Outline outline(geometry, planes[which]);
  if (!outline.close()) return {};
  std::vector<Piece> pieces = std::move(outline.pieces());
  for (std::size_t other = 0; other < planes.size(); ++other) {
    if (other == which) continue;
    bool all = true;
    if (const auto half = outline.half(planes[other], all))
      pieces = clipped(pieces, *half);
    else if (!all)
      pieces.clear();
  }
  double twice = 0;
  for (const Piece& piece : pieces) twice += cross(piece.from, piece.to);
  return {std::abs(twice) / 2};
}

}  // namespace

std::vector<CutArea> cut_areas(const Geometry& geometry, std::span<const glm::dvec4> planes) {
  std::vector<CutArea> areas;
  for (std::size_t i = 0; i < planes.size(); ++i) areas.push_back(area_of(geometry, planes, i));
  return areas;
}

}  // namespace strata::mesh
