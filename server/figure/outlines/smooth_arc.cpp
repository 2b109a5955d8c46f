#include "figure/outlines/smooth_arc.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace strata::figure {
namespace {

using Points = std::vector<glm::dvec2>;

// The shares of the steps. Their sum is 1.
constexpr double kFilterShare = 0.3, kSimplifyShare = 0.3, kFitShare = 0.2, kCornerShare = 0.2;
constexpr std::array<double, kExact + 1> kShareOfLevel{1, 0.5, 0.25, 0};
constexpr double kRounding = 1e-9;  // in cells

class Smoother {
 public:
  Smoother(const BorderArc& arc, const std::vector<std::uint8_t>& levels, double tolerance)
      : is_ring_(arc.is_ring()), levels_(levels), tolerance_(tolerance) {
    for (const glm::ivec2& point : arc.chain) chain_.push_back(glm::dvec2(point) / 2.0);
  }

  SmoothArc smooth() {
    filter();
    choose_corners();
    fit_corners();
    return round_corners();
  }

 private:
  double allowed(std::size_t i, double share) const {
    return tolerance_ * share * kShareOfLevel[levels_[i]];
  }
  bool is_end(std::size_t i) const { return !is_ring_ && (i == 0 || i + 1 == chain_.size()); }

  // Filters with the weights 1, 2, 1, so the variance grows by half a point in each pass.
  Points filtered(Points points, int passes) const {
    const std::size_t count = points.size();
    Points next(count);
    for (int pass = 0; pass < passes; ++pass) {
      for (std::size_t i = 0; i < count; ++i)
        next[i] =
            is_end(i)
                ? points[i]
                : (points[(i + count - 1) % count] + 2.0 * points[i] + points[(i + 1) % count]) /
                      4.0;
      points.swap(next);
    }
    return points;
  }

  void filter() {
    constexpr int kFewest = 8, kMost = 48;
    const int passes = std::clamp(static_cast<int>(tolerance_ * tolerance_ * 2), kFewest, kMost);
    points_ = filtered(chain_, passes);
    Points lost(chain_.size());
    for (std::size_t i = 0; i < lost.size(); ++i) lost[i] = chain_[i] - points_[i];
    lost = filtered(std::move(lost), passes);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const glm::dvec2 moved = points_[i] + lost[i] - chain_[i];
      const double length = glm::length(moved);
      const double most = is_end(i) ? 0 : allowed(i, kFilterShare);
      points_[i] = length > most ? chain_[i] + moved * (most / length) : points_[i] + lost[i];
    }
  }

  // The point of the filtered chain after `first`, which may be beyond the end of a ring.
  const glm::dvec2& point(std::size_t i) const { return points_[i % points_.size()]; }

  void choose_corners() {
    const std::size_t count = points_.size();
    const std::size_t last = is_ring_ ? count : count - 1;
    // A line that returns to its first point has a second corner at the farthest point.
    std::size_t middle = last;
    if (glm::distance(point(0), point(last)) < kRounding) {
      double farthest = 0;
      for (std::size_t i = 1; i < last; ++i)
        if (const double away = glm::distance(points_[0], points_[i]); away > farthest) {
          farthest = away;
          middle = i;
        }
    }
    corners_.assign(1, 0);
    simplify(0, middle);
    if (middle != last) simplify(middle, last);
    if (is_ring_) corners_.pop_back();  // the first one again
  }

  // Adds the corners after `first`, up to and including `last`.
  void simplify(std::size_t first, std::size_t last) {
    std::vector<std::pair<std::size_t, std::size_t>> open{{first, last}};
    while (!open.empty()) {
      const auto [from, to] = open.back();
      open.pop_back();
      const glm::dvec2 a = point(from), along = point(to) - a;
      const double squared = glm::dot(along, along);
      double worst = 1;
      std::size_t split = to;
      for (std::size_t i = from + 1; i < to; ++i) {
        const glm::dvec2 to_point = point(i) - a;
        const double t =
            squared > 0 ? std::clamp(glm::dot(to_point, along) / squared, 0.0, 1.0) : 0;
        const double away = glm::length(to_point - t * along);
        const double most = std::max(allowed(i % levels_.size(), kSimplifyShare), kRounding);
        if (away / most > worst) {
          worst = away / most;
          split = i;
        }
      }
      if (split == to) {
        corners_.push_back(to);
      } else {
        open.emplace_back(split, to);
        open.emplace_back(from, split);
      }
    }
  }

  std::size_t corner_after(std::size_t k) const {
    return k + 1 < corners_.size() ? corners_[k + 1] : corners_[0] + points_.size();
  }

  struct Line {
    glm::dvec2 through, along;
  };
  // The least-squares line through the points of the side after a corner.
  Line line_of(std::size_t k) const {
    const std::size_t first = corners_[k], last = corner_after(k);
    glm::dvec2 middle(0);
    for (std::size_t i = first; i <= last; ++i) middle += point(i);
    middle /= static_cast<double>(last - first + 1);
    double xx = 0, xy = 0, yy = 0;
    for (std::size_t i = first; i <= last; ++i) {
      const glm::dvec2 d = point(i) - middle;
      xx += d.x * d.x;
      xy += d.x * d.y;
      yy += d.y * d.y;
    }
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    return {middle, {std::cos(angle), std::sin(angle)}};
  }

  void fit_corners() {
    fitted_.clear();
    for (const std::size_t corner : corners_) fitted_.push_back(point(corner));
    const std::size_t count = corners_.size();
    if (count < 3) return;
    std::vector<Line> lines;
    for (std::size_t k = 0; k < (is_ring_ ? count : count - 1); ++k) lines.push_back(line_of(k));
    for (std::size_t k = 0; k < count; ++k) {
      if (!is_ring_ && (k == 0 || k + 1 == count)) continue;
      const Line &before = lines[(k + lines.size() - 1) % lines.size()], &after = lines[k];
      const double cross = before.along.x * after.along.y - before.along.y * after.along.x;
      glm::dvec2 wanted;
      constexpr double kParallel = 0.05;
      if (std::abs(cross) > kParallel) {
        const glm::dvec2 apart = after.through - before.through;
        wanted = before.through +
                 before.along * ((apart.x * after.along.y - apart.y * after.along.x) / cross);
      } else {  // the middle of the nearest points of both lines
        const auto nearest = [&](const Line& line) {
          return line.through + line.along * glm::dot(fitted_[k] - line.through, line.along);
        };
        wanted = (nearest(before) + nearest(after)) / 2.0;
      }
      const glm::dvec2 moved = wanted - fitted_[k];
      const double length = glm::length(moved), most = allowed(corners_[k], kFitShare);
      fitted_[k] += length > most ? moved * (most / length) : moved;
    }
  }

  SmoothArc round_corners() const {
    SmoothArc arc;
    const std::size_t count = fitted_.size();
    const auto wrapped = [&](std::size_t i) {
      return static_cast<std::uint32_t>(i % points_.size());
    };
    const auto add = [&](const glm::dvec2& at, std::size_t first, std::size_t last) {
      arc.points.push_back(at);
      arc.ranges.push_back({wrapped(first), wrapped(last)});
    };
    for (std::size_t k = 0; k < count; ++k) {
      const bool is_inner = is_ring_ || (k > 0 && k + 1 < count);
      const std::size_t last = is_ring_ || k + 1 < count ? corner_after(k) : corners_[k];
      const std::size_t previous = corners_[(k + count - 1) % count];
      const glm::dvec2& at = fitted_[k];
      const double most = allowed(corners_[k], kCornerShare);
      if (!is_inner || count < 3 || most <= 0) {
        add(at, corners_[k], last);
        continue;
      }
      const glm::dvec2 to_before = fitted_[(k + count - 1) % count] - at,
                       to_after = fitted_[(k + 1) % count] - at;
      const double before = glm::length(to_before), after = glm::length(to_after);
      const double cosine =
          std::clamp(-glm::dot(to_before, to_after) / std::max(before * after, 1e-30), -1.0, 1.0);
      const double turn = std::acos(cosine);
      constexpr double kStraight = 0.05, kPieceTurn = 0.2;  // in radians
      if (turn < kStraight || before < kRounding || after < kRounding) {
        add(at, corners_[k], last);
        continue;
      }
      // A quadratic curve from t before the corner to t after it is t sin(turn / 2) / 2 away from
      // the corner.
      const double reach = 2 * most / std::sin(turn / 2);
      const double t_before = std::min(before / 2, reach), t_after = std::min(after / 2, reach);
      const glm::dvec2 begin = at + to_before * (t_before / before),
                       end = at + to_after * (t_after / after);
      const int pieces = std::max(2, static_cast<int>(std::ceil(turn / kPieceTurn)));
      for (int piece = 0; piece <= pieces; ++piece) {
        const double t = static_cast<double>(piece) / pieces;
        const glm::dvec2 on = (1 - t) * (1 - t) * begin + 2 * t * (1 - t) * at + t * t * end;
        if (!arc.points.empty() && glm::distance(arc.points.back(), on) < kRounding) {
          arc.ranges.back() = {wrapped(previous), wrapped(last)};
          continue;
        }
        add(on, previous, last);
      }
    }
    if (is_ring_ && arc.points.size() > 1 &&
        glm::distance(arc.points.back(), arc.points.front()) < kRounding) {
      arc.points.pop_back();
      arc.ranges.pop_back();
    }
    if (!is_ring_) arc.ranges.pop_back();
    return arc;
  }

  const bool is_ring_;
  const std::vector<std::uint8_t>& levels_;
  const double tolerance_;
  Points chain_, points_;             // in cells; after the filter
  std::vector<std::size_t> corners_;  // indices of points_
  Points fitted_;                     // by corner
};

}  // namespace

SmoothArc smooth_arc(const BorderArc& arc, const std::vector<std::uint8_t>& levels,
                     double tolerance) {
  return Smoother(arc, levels, tolerance).smooth();
}

}  // namespace strata::figure
