#include "mesh/atlas/relax.h"

#include <algorithm>
#include <cmath>

namespace strata::mesh {
namespace {

constexpr double kAreaWeight = 4;  // weight of the area distortion relative to the shape distortion
// height over base; the true shape of a thinner sliver is not meaningful
constexpr double kMinQuality = 0.1;
constexpr int kMaxHalvings = 6;

// The map of a triangle from its true shape. The columns of the Jacobian are sums of the triangle's
// corners with these factors.
struct Element {
  double first[3], second[3];
  double weight;
};

Element make_element(const RelaxPatch::Face& face, double mean_area) {
  glm::dvec2 b = face.b, c = face.c;
  const double area = (b.x * c.y - b.y * c.x) / 2;
  const double longest = std::max({glm::dot(b, b), glm::dot(c, c), glm::dot(c - b, c - b)});
  if (area < kMinQuality * longest / 2) {
    const double side = std::sqrt(4 * std::max(area, 1e-6 * mean_area) / std::sqrt(3.0));
    b = {side, 0}, c = {side / 2, side * std::sqrt(3.0) / 2};
  }
  const double det = b.x * c.y - b.y * c.x;
  // The inverse of [b c] maps (b - a, c - a) to the Jacobian.
  Element element;
  element.first[1] = c.y / det, element.first[2] = -b.y / det;
  element.second[1] = -c.x / det, element.second[2] = b.x / det;
  element.first[0] = -element.first[1] - element.first[2];
  element.second[0] = -element.second[1] - element.second[2];
  element.weight = area / mean_area + 0.25;
  return element;
}

struct Energy {
  double value = 0, curvature = 0;
  glm::dvec2 gradient{0};
};

class Relaxer {
 public:
  explicit Relaxer(RelaxPatch& patch)
      : patch_(patch), points_(patch.points.begin(), patch.points.end()) {
    double area = 0;
    for (const auto& face : patch.faces) area += (face.b.x * face.c.y - face.b.y * face.c.x) / 2;
    const double mean_area = std::max(area / double(patch.faces.size()), 1e-300);
    elements_.reserve(patch.faces.size());
    first_corner_.assign(points_.size() + 1, 0);
    for (const auto& face : patch.faces) {
      elements_.push_back(make_element(face, mean_area));
      for (const auto v : face.vertex) ++first_corner_[v + 1];
    }
    for (std::size_t v = 0; v < points_.size(); ++v) first_corner_[v + 1] += first_corner_[v];
    corners_.resize(3 * patch.faces.size());
    auto cursor = first_corner_;
    for (std::uint32_t f = 0; f < patch.faces.size(); ++f)
      for (std::uint32_t k = 0; k < 3; ++k)
        corners_[cursor[patch.faces[f].vertex[k]]++] = 3 * f + k;
  }

  void run(double good_area, int most_sweeps) {
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      for (std::uint32_t v = 0; v < points_.size(); ++v)
        if (!patch_.is_fixed[v]) move(v);
      if (least_area() >= good_area) break;
    }
    std::copy(points_.begin(), points_.end(), patch_.points.begin());
  }

 private:
  struct Jacobian {
    glm::dvec2 first{0}, second{0};
    double det() const { return first.x * second.y - first.y * second.x; }
  };
  Jacobian jacobian(std::uint32_t f) const {
    Jacobian j;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec2 p = points_[patch_.faces[f].vertex[k]];
      j.first += elements_[f].first[k] * p;
      j.second += elements_[f].second[k] * p;
    }
    return j;
  }
  double least_area() const {
    double least = 1;
    for (std::uint32_t f = 0; f < elements_.size(); ++f) least = std::min(least, jacobian(f).det());
    return least;
  }
  template <class Visit>
  void for_each_corner(std::uint32_t v, Visit visit) const {
    for (auto i = first_corner_[v]; i < first_corner_[v + 1]; ++i)
      visit(corners_[i] / 3, corners_[i] % 3);
  }

  // Returns the energy of the faces around a point. `epsilon` keeps it finite if some faces are
  // folded.
  Energy energy(std::uint32_t v, double epsilon, bool with_gradient) const {
    Energy sum;
    for_each_corner(v, [&](std::uint32_t f, std::uint32_t k) {
      const Element& element = elements_[f];
      const Jacobian j = jacobian(f);
      const double det = j.det(), root = std::sqrt(det * det + epsilon * epsilon),
                   chi = (det + root) / 2;
      const double norm = glm::dot(j.first, j.first) + glm::dot(j.second, j.second);
      const double value = (norm + kAreaWeight * (det * det + 1)) / chi;
      sum.value += element.weight * value;
      if (!with_gradient) return;
      const double a = element.first[k], b = element.second[k];
      const glm::dvec2 of_det(a * j.second.y - b * j.first.y, b * j.first.x - a * j.second.x);
      const glm::dvec2 of_norm = 2.0 * (a * j.first + b * j.second);
      const glm::dvec2 of_chi = (1 + det / root) / 2 * of_det;
      sum.gradient +=
          element.weight * (of_norm + 2 * kAreaWeight * det * of_det - value * of_chi) / chi;
      sum.curvature += element.weight *
                           (2 * (a * a + b * b) + 2 * kAreaWeight * glm::dot(of_det, of_det)) /
                           chi +
                       element.weight * 2 * value * glm::dot(of_chi, of_chi) / (chi * chi);
    });
    return sum;
  }

  void move(std::uint32_t v) {
    double least = 1;
    for_each_corner(
        v, [&](std::uint32_t f, std::uint32_t) { least = std::min(least, jacobian(f).det()); });
    const double folded = std::min(least, 0.0);
    const double epsilon = std::sqrt(1e-8 + 0.04 * folded * folded);
    const Energy here = energy(v, epsilon, true);
    if (!(here.curvature > 0)) return;
    const glm::dvec2 from = points_[v];
    glm::dvec2 step = -here.gradient / here.curvature;
    for (int i = 0; i < kMaxHalvings; ++i, step *= 0.5) {
      points_[v] = from + step;
      if (energy(v, epsilon, false).value < here.value) return;
    }
    points_[v] = from;
  }

  RelaxPatch& patch_;
  std::vector<glm::dvec2> points_;
  std::vector<Element> elements_;
  std::vector<std::uint32_t> first_corner_, corners_;  // per point; a corner is 3 * face + k
};

}  // namespace

void relax(RelaxPatch& patch, float good_area, int most_sweeps) {
  if (!patch.faces.empty()) Relaxer(patch).run(double{good_area}, most_sweeps);
}

}  // namespace strata::mesh
