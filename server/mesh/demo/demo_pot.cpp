#include "mesh/demo/demo_pot.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "mesh/demo/demo_pot_shape.h"

namespace strata::mesh {
namespace {

using Stretch = DemoPotShape::Stretch;

const glm::dvec3 kSize(105, 99, 91);

struct Ring {
  Stretch stretch;
  double t;
  int columns;              // 1 at a pole
  std::uint32_t first = 0;  // index of its first vertex
};

// Returns the rings from the center of the underside over the rim to the center of the inside
// floor. Toward the poles, the number of columns halves whenever the radius halves, so triangles
// stay well-shaped.
std::vector<Ring> make_rings(double detail) {
  const double scale = std::sqrt(detail);
  const int columns = 32 * std::max(2, static_cast<int>(std::lround(480 * scale / 32)));
  const auto columns_at = [&](Stretch stretch, double t) {
    int count = columns;
    for (double full = 24;
         DemoPotShape::radius(stretch, t) < full && count % 2 == 0 && count / 2 >= 8; full /= 2)
      count /= 2;
    return count;
  };
  std::vector<Ring> rings;
  // `with_end` is true if the ring at t = 1 belongs to this stretch. Otherwise this ring is the
  // first ring of the next stretch.
  const auto add = [&](Stretch stretch, int rows, bool with_end) {
    const int count = std::max(4, static_cast<int>(std::lround(rows * scale)));
    for (int i = 0; i < count + (with_end ? 1 : 0); ++i) {
      const double t = static_cast<double>(i) / count;
      rings.push_back({stretch, t, columns_at(stretch, t)});
    }
  };
  add(Stretch::underside_and_belly, 109, false);
  add(Stretch::shoulder_and_neck, 54, false);
  add(Stretch::rim, 9, false);
  add(Stretch::inside_upper, 26, false);
  add(Stretch::inside_lower, 40, true);
  rings.front().columns = 1;
  rings.back().columns = 1;
  return rings;
}

class RingMesh {
 public:
  explicit RingMesh(std::vector<Ring> rings) : rings_(std::move(rings)) {}

  TriangleMesh build() {
    for (Ring& ring : rings_) add_vertices(ring);
    for (std::size_t i = 0; i + 1 < rings_.size(); ++i) stitch(rings_[i], rings_[i + 1]);
    return std::move(mesh_);
  }

 private:
  void add_vertices(Ring& ring) {
    ring.first = static_cast<std::uint32_t>(mesh_.positions.size());
    for (int j = 0; j < ring.columns; ++j) {
      const double angle = 2 * std::numbers::pi * j / ring.columns;
      const auto [position, color] = DemoPotShape::at(ring.stretch, ring.t, angle);
      mesh_.positions.push_back(position);
      mesh_.vertex_colors.push_back(color);
    }
  }

  static std::uint32_t vertex(const Ring& ring, int column) {
    return ring.first + static_cast<std::uint32_t>(column % ring.columns);
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.triangles.insert(mesh_.triangles.end(), {a, b, c});
  }

  // `a` precedes `b` on the way from the underside to the floor. Seen from outside, `a` is the
  // lower ring.
  void stitch(const Ring& a, const Ring& b) {
    const int fewer = std::min(a.columns, b.columns);
    if (a.columns == 1) {
      for (int j = 0; j < b.columns; ++j) triangle(a.first, vertex(b, j + 1), vertex(b, j));
    } else if (b.columns == 1) {
      for (int j = 0; j < a.columns; ++j) triangle(vertex(a, j), vertex(a, j + 1), b.first);
    } else if (a.columns == b.columns) {
      for (int j = 0; j < a.columns; ++j)
        quad(vertex(a, j), vertex(a, j + 1), vertex(b, j + 1), vertex(b, j));
    } else if (a.columns == 2 * fewer) {
      for (int j = 0; j < fewer; ++j) {
        triangle(vertex(a, 2 * j), vertex(a, 2 * j + 1), vertex(b, j));
        triangle(vertex(a, 2 * j + 1), vertex(b, j + 1), vertex(b, j));
        triangle(vertex(a, 2 * j + 1), vertex(a, 2 * j + 2), vertex(b, j + 1));
      }
    } else {
      for (int j = 0; j < fewer; ++j) {
        triangle(vertex(a, j), vertex(b, 2 * j + 1), vertex(b, 2 * j));
        triangle(vertex(a, j), vertex(a, j + 1), vertex(b, 2 * j + 1));
        triangle(vertex(a, j + 1), vertex(b, 2 * j + 2), vertex(b, 2 * j + 1));
      }
    }
  }

  // Splits along the shorter diagonal.
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    const auto& p = mesh_.positions;
    if (glm::distance(p[a], p[c]) <= glm::distance(p[b], p[d])) {
      triangle(a, b, c);
      triangle(a, c, d);
    } else {
      triangle(a, b, d);
      triangle(b, c, d);
    }
  }

  std::vector<Ring> rings_;
  TriangleMesh mesh_;
};

// Puts the pot on z = 0 with its axis near the origin and scales it to its stated size.
void scale_to_size(TriangleMesh& mesh) {
  glm::dvec3 low = mesh.positions[0], high = low;
  for (const glm::dvec3& p : mesh.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::dvec3 base((low.x + high.x) / 2, (low.y + high.y) / 2, low.z);
  for (glm::dvec3& p : mesh.positions) p = (p - base) * (kSize / (high - low));
}

}  // namespace

TriangleMesh make_demo_pot(double detail) {
  // The number of columns may at most double or halve from one ring to the next. A coarser pot
  // would violate this limit.
  std::vector<Ring> rings = make_rings(std::clamp(detail, 0.02, 100.0));
  for (std::size_t i = 2; i + 1 < rings.size(); ++i) {
    rings[i].columns =
        std::clamp(rings[i].columns, rings[i - 1].columns / 2, rings[i - 1].columns * 2);
  }
  TriangleMesh mesh = RingMesh(std::move(rings)).build();
  scale_to_size(mesh);
  return mesh;
}

}  // namespace strata::mesh
