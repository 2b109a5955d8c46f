#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

namespace strata::mesh {

// Computes the exact area of a triangle within each texel of the grid. Signed areas to the right of
// the triangle's edges are summed along rows.
class TexelPieces {
 public:
  // The corners are in texels and not negative.
  void set(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    corners_ = {a, b, c};
    const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    area_ = std::abs(twice) / 2;
    sign_ = twice < 0 ? 1 : -1;  // counterclockwise: the inside is left of upward edges
    low_ = glm::min(a, glm::min(b, c));
    high_ = glm::max(a, glm::max(b, c));
    const glm::dvec2 extent = high_ - low_;
    // The pieces of thinner triangles would be rounding noise.
    is_line_ = area_ <= 1e-9 * glm::dot(extent, extent);
  }

  double area() const { return area_; }  // texel²
  bool is_line() const { return is_line_; }
  glm::dvec2 centroid() const { return (corners_[0] + corners_[1] + corners_[2]) / 3.0; }
  int first_row() const { return static_cast<int>(low_.y); }
  int last_row() const { return std::max(first_row(), static_cast<int>(std::ceil(high_.y)) - 1); }
  int first_column() const { return static_cast<int>(low_.x); }
  int last_column() const {
    return std::max(first_column(), static_cast<int>(std::ceil(high_.x)) - 1);
  }

  // Calls visit(x, y, area) for each texel in the rows [y_low, y_high) that contains a piece, row
  // by row.
  template <class Visit>
  void for_each(int y_low, int y_high, Visit&& visit) {
    const int x0 = first_column(), columns = last_column() - x0 + 1;
    const int y0 = std::max(first_row(), y_low), y1 = std::min(last_row(), y_high - 1);
    if (columns == 1 && first_row() == last_row()) {
      if (y0 <= y1) visit(x0, y0, area_);
      return;
    }
    if (sums_.size() < static_cast<std::size_t>(columns) + 2) sums_.resize(columns + 2, 0.0);
    for (int y = y0; y <= y1; ++y) {
      // A long slanted triangle covers few of its columns in each row.
      row_first_ = columns, row_last_ = -1;
      for (int k = 0; k < 3; ++k) add_edge(corners_[k], corners_[(k + 1) % 3], y, x0, columns);
      double sum = 0;
      for (int i = row_first_; i <= std::min(row_last_, columns - 1); ++i) {
        sum += sums_[i];
        sums_[i] = 0;
        const double piece = sum * sign_;
        if (piece > 1e-12) visit(x0 + i, y, std::min(piece, 1.0));
      }
      sums_[columns] = sums_[columns + 1] = 0;
    }
  }

 private:
  // Adds the area to the right of the edge's part within row y. After a running sum, each column
  // holds its signed area.
  void add_edge(glm::dvec2 from, glm::dvec2 to, int y, int x0, int columns) {
    const double direction = from.y < to.y ? 1 : -1;
    if (direction < 0) std::swap(from, to);
    const double y_from = std::max<double>(from.y, y), y_to = std::min<double>(to.y, y + 1);
    if (y_from >= y_to) return;
    const double slope = (to.x - from.x) / (to.y - from.y);
    double x_from = (y_from > from.y ? from.x + slope * (y_from - from.y) : from.x) - x0;
    double x_to = (y_to < to.y ? from.x + slope * (y_to - from.y) : to.x) - x0;
    if (x_from > x_to) std::swap(x_from, x_to);
    x_from = std::clamp(x_from, 0.0, static_cast<double>(columns));
    x_to = std::clamp(x_to, 0.0, static_cast<double>(columns));
    const double height = direction * (y_to - y_from);
    const int first = std::min(static_cast<int>(x_from), columns - 1),
              last = std::min(static_cast<int>(x_to), columns - 1);
    row_first_ = std::min(row_first_, first), row_last_ = std::max(row_last_, last + 1);
    if (first == last) {
      const double middle = (x_from + x_to) / 2 - first;
      sums_[first] += height * (1 - middle);
      sums_[first + 1] += height * middle;
      return;
    }
    const double height_per_x = height / (x_to - x_from);
    for (int x = first; x <= last; ++x) {
      const double a = std::max<double>(x_from, x), b = std::min<double>(x_to, x + 1);
      const double part = height_per_x * (b - a), middle = (a + b) / 2 - x;
      sums_[x] += part * (1 - middle);
      sums_[x + 1] += part * middle;
    }
  }

  std::array<glm::dvec2, 3> corners_{};
  glm::dvec2 low_{0}, high_{0};
  double area_ = 0, sign_ = 1;
  bool is_line_ = true;
  int row_first_ = 0, row_last_ = -1;  // columns in which the sums of the row change
  std::vector<double> sums_;
};

}  // namespace strata::mesh
