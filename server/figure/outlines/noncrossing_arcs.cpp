#include "figure/outlines/noncrossing_arcs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace strata::figure {
namespace {

constexpr double kTouching = 1e-9;  // twice the area of a triangle, in cells
constexpr double kBucket = 4;       // side of a bucket, in cells
constexpr int kGentleRounds = 8;    // afterwards, borders in conflict become exact as a whole

double twice_area(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

struct Segment {
  glm::dvec2 a, b;
  std::uint32_t arc = 0, number = 0;
};

// Segments by square buckets of the grid.
class Buckets {
 public:
  Buckets(const LabelFaces& faces, const std::vector<Segment>& segments)
      : segments_(segments),
        columns_(static_cast<int>(faces.columns / kBucket) + 1),
        rows_(static_cast<int>(faces.rows / kBucket) + 1),
        starts_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1) {
    for_each_entry([&](std::size_t bucket, std::uint32_t) { ++starts_[bucket + 1]; });
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    entries_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    for_each_entry(
        [&](std::size_t bucket, std::uint32_t segment) { entries_[next[bucket]++] = segment; });
  }

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  static int place(double cell, int count) {
    return std::clamp(static_cast<int>(std::floor(cell / kBucket)), 0, count - 1);
  }
  std::span<const std::uint32_t> in(int column, int row) const {
    const std::size_t bucket = number(column, row);
    return std::span(entries_).subspan(starts_[bucket], starts_[bucket + 1] - starts_[bucket]);
  }

 private:
  std::size_t number(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  // Visits each bucket that a segment may cross.
  template <class Visit>
  void for_each_entry(const Visit& visit) const {
    constexpr double kMargin = 1e-6;
    for (std::uint32_t i = 0; i < segments_.size(); ++i) {
      const auto& [a, b, arc, part] = segments_[i];
      const int top = place(std::min(a.y, b.y) - kMargin, rows_),
                bottom = place(std::max(a.y, b.y) + kMargin, rows_);
      for (int row = top; row <= bottom; ++row) {
        // the part of the segment between the upper and the lower border of this row
        double left = std::min(a.x, b.x), right = std::max(a.x, b.x);
        if (top != bottom) {
          const auto x_at = [&, &a = a, &b = b](double y) {
            const double t = std::clamp((y - a.y) / (b.y - a.y), 0.0, 1.0);
            return std::lerp(a.x, b.x, t);
          };
          if (std::abs(b.y - a.y) > kMargin) {
            const double above = x_at(row * kBucket - kMargin),
                         below = x_at((row + 1) * kBucket + kMargin);
            left = std::min(above, below);
            right = std::max(above, below);
          }
        }
        const int last = place(right + kMargin, columns_);
        for (int column = place(left - kMargin, columns_); column <= last; ++column)
          visit(number(column, row), i);
      }
    }
  }

  const std::vector<Segment>& segments_;
  const int columns_, rows_;
  std::vector<std::size_t> starts_;
  std::vector<std::uint32_t> entries_;
};

// Returns whether two segments have a common point.
bool meet(const Segment& s, const Segment& t) {
  if (std::max(s.a.x, s.b.x) < std::min(t.a.x, t.b.x) - kTouching ||
      std::max(t.a.x, t.b.x) < std::min(s.a.x, s.b.x) - kTouching ||
      std::max(s.a.y, s.b.y) < std::min(t.a.y, t.b.y) - kTouching ||
      std::max(t.a.y, t.b.y) < std::min(s.a.y, s.b.y) - kTouching)
    return false;
  const auto sign = [](double value) {
    return value > kTouching ? 1 : value < -kTouching ? -1 : 0;
  };
  return sign(twice_area(s.a, s.b, t.a)) * sign(twice_area(s.a, s.b, t.b)) <= 0 &&
         sign(twice_area(t.a, t.b, s.a)) * sign(twice_area(t.a, t.b, s.b)) <= 0;
}

// Returns whether two segments that leave the same point have more points in common.
bool overlap_from(const glm::dvec2& start, const glm::dvec2& a, const glm::dvec2& b) {
  return std::abs(twice_area(start, a, b)) <= kTouching && glm::dot(a - start, b - start) > 0;
}

class Smoothing {
 public:
  Smoothing(const LabelFaces& faces, const BorderGraph& graph, double tolerance)
      : faces_(faces),
        graph_(graph),
        tolerance_(tolerance),
        arcs_(graph.arcs.size()),
        walks_(graph.walks()) {
    for (std::size_t i = 0; i < graph.arcs.size(); ++i) {
      const BorderArc& arc = graph.arcs[i];
      const bool is_frame = arc.left == kOutside || arc.right == kOutside;
      levels_.emplace_back(arc.chain.size(), is_frame ? kExact : std::uint8_t{0});
    }
    is_changed_.assign(graph.arcs.size(), 1);
    find_components();
    for (const std::vector<HalfArc>& walk : walks_) {
      double area = 0;
      for (const HalfArc half : walk) {
        const auto& chain = graph.arcs[half / 2].chain;
        double sum = 0;
        const std::size_t sides = chain.size() - (graph.arcs[half / 2].is_ring() ? 0 : 1);
        for (std::size_t k = 0; k < sides; ++k)
          sum += shoelace(glm::dvec2(chain[k]), glm::dvec2(chain[(k + 1) % chain.size()]));
        area += half % 2 == 0 ? sum : -sum;
      }
      is_outer_.push_back(area > 0 ? 1 : 0);
    }
  }

  Result<std::vector<SmoothArc>> find(const Progress& progress) {
    for (round_ = 0;; ++round_) {
      for (std::size_t i = 0; i < arcs_.size(); ++i) {
        if (is_changed_[i] == 0) continue;
        if (progress.cancelled()) return cancelled_problem();
        arcs_[i] = smooth_arc(graph_.arcs[i], levels_[i], tolerance_);
      }
      is_checked_again_ = std::exchange(is_changed_, std::vector<std::uint8_t>(arcs_.size()));
      raised_.clear();
      list_segments();
      const Buckets buckets(faces_, segments_);
      check_walks();
      STRATA_TRY(check_crossings(buckets, progress));
      check_nodes();
      if (raised_.empty()) check_components(buckets);
      if (raised_.empty()) return std::move(arcs_);
      if (raise()) continue;
      // A problem whose causes are elsewhere.
      for (std::size_t i = 0; i < arcs_.size(); ++i) {
        is_changed_[i] = 1;
        std::ranges::fill(levels_[i], kExact);
      }
    }
  }

 private:
  struct Raised {
    std::uint32_t arc;
    SmoothArc::Range range;
  };
  void raise_later(std::uint32_t arc, std::uint32_t segment) {
    raised_.push_back({arc, arcs_[arc].ranges[segment]});
  }
  void raise_later(std::uint32_t arc) {
    raised_.push_back({arc, {0, static_cast<std::uint32_t>(levels_[arc].size() - 1)}});
  }

  // Raises each level by one, even if several problems concern it. Returns false if all levels that
  // could be raised already are kExact.
  bool raise() {
    bool is_raised = false;
    std::ranges::sort(raised_, {}, [](const Raised& each) { return each.arc; });
    for (std::size_t i = 0; i < raised_.size();) {
      const std::uint32_t arc = raised_[i].arc;
      const std::vector<std::uint8_t> before = levels_[arc];
      const auto count = static_cast<std::uint32_t>(before.size());
      for (; i < raised_.size() && raised_[i].arc == arc; ++i) {
        const auto [first, last] = raised_[i].range;
        const std::uint32_t points = (last + count - first) % count + 1;
        for (std::uint32_t k = 0; k < points; ++k) {
          const std::uint32_t at = (first + k) % count;
          levels_[arc][at] = std::min<std::uint8_t>(before[at] + 1, kExact);
        }
      }
      if (round_ >= kGentleRounds) std::ranges::fill(levels_[arc], kExact);
      if (levels_[arc] == before) continue;
      is_changed_[arc] = 1;
      is_raised = true;
    }
    return is_raised;
  }

  void list_segments() {
    segments_.clear();
    for (std::uint32_t i = 0; i < arcs_.size(); ++i) {
      const auto& points = arcs_[i].points;
      for (std::uint32_t k = 0; k < arcs_[i].ranges.size(); ++k)
        segments_.push_back({points[k], points[(k + 1) % points.size()], i, k});
    }
  }

  // Twice the area of a polygon part, positive if it is on the left on the page.
  static double shoelace(const glm::dvec2& a, const glm::dvec2& b) { return b.x * a.y - a.x * b.y; }

  // Walks around faces keep their direction, so no face is turned inside out. Rings have at least
  // three points.
  void check_walks() {
    for (std::size_t i = 0; i < walks_.size(); ++i) {
      double area = 0;
      bool is_ring = true;
      for (const HalfArc half : walks_[i]) {
        const SmoothArc& arc = arcs_[half / 2];
        double sum = 0;
        for (std::size_t k = 0; k < arc.ranges.size(); ++k)
          sum += shoelace(arc.points[k], arc.points[(k + 1) % arc.points.size()]);
        area += half % 2 == 0 ? sum : -sum;
        const bool closes = graph_.arcs[half / 2].is_ring() ||
                            graph_.arcs[half / 2].from == graph_.arcs[half / 2].to;
        is_ring = is_ring && (!closes || arc.ranges.size() >= 3);
      }
      if (is_ring && (is_outer_[i] != 0 ? area > 0 : area < 0)) continue;
      for (const HalfArc half : walks_[i]) raise_later(half / 2);
    }
  }

  // Returns whether the segments follow each other, or leave the same node.
  bool are_joined_at(const glm::dvec2& point, const Segment& s, const Segment& t) const {
    const auto ends_at_node = [&](const Segment& each) {
      const SmoothArc& arc = arcs_[each.arc];
      return !graph_.arcs[each.arc].is_ring() &&
             ((each.number == 0 && point == arc.points.front()) ||
              (each.number + 1 == arc.ranges.size() && point == arc.points.back()));
    };
    if (s.arc == t.arc) {
      const auto count = static_cast<std::uint32_t>(arcs_[s.arc].ranges.size());
      const bool follows =
          (s.number + 1 == t.number && point == s.b) || (t.number + 1 == s.number && point == t.b);
      const bool wraps = graph_.arcs[s.arc].is_ring() &&
                         ((s.number + 1 == count && t.number == 0 && point == s.b) ||
                          (t.number + 1 == count && s.number == 0 && point == t.b));
      if (follows || wraps) return true;
    }
    return ends_at_node(s) && ends_at_node(t);
  }

  bool are_in_conflict(const Segment& s, const Segment& t) const {
    if (!meet(s, t)) return false;
    for (const auto& [start, end] : {std::pair(s.a, s.b), std::pair(s.b, s.a)})
      for (const auto& [other_start, other_end] : {std::pair(t.a, t.b), std::pair(t.b, t.a)})
        if (start == other_start && are_joined_at(start, s, t))
          return overlap_from(start, end, other_end);
    return true;
  }

  Result<void> check_crossings(const Buckets& buckets, const Progress& progress) {
    for (int row = 0; row < buckets.rows(); ++row) {
      if (progress.cancelled()) return cancelled_problem();
      for (int column = 0; column < buckets.columns(); ++column) {
        const auto there = buckets.in(column, row);
        for (std::size_t i = 0; i < there.size(); ++i)
          for (std::size_t k = i + 1; k < there.size(); ++k) {
            const Segment &s = segments_[there[i]], &t = segments_[there[k]];
            if (is_checked_again_[s.arc] == 0 && is_checked_again_[t.arc] == 0) continue;
            if (!are_in_conflict(s, t)) continue;
            raise_later(s.arc, s.number);
            raise_later(t.arc, t.number);
          }
      }
    }
    return {};
  }

  // The borders leave each node in their order.
  void check_nodes() {
    constexpr double kTurn = 6.283185307179586;
    for (const BorderNode& node : graph_.nodes) {
      std::vector<double> angles;
      for (const HalfArc half : node.leaving) {
        if (half == kNoHalfArc) continue;
        const auto& points = arcs_[half / 2].points;
        const glm::dvec2 along =
            half % 2 == 0 ? points[1] - points[0] : points[points.size() - 2] - points.back();
        angles.push_back(std::atan2(along.y, along.x));
      }
      double sum = 0;
      for (std::size_t i = 0; i < angles.size(); ++i) {
        const double between = angles[(i + 1) % angles.size()] - angles[i];
        sum += between > 0 ? between : between + kTurn;
      }
      if (angles.size() < 3 || sum < 1.5 * kTurn) continue;
      for (const HalfArc half : node.leaving)
        if (half != kNoHalfArc)
          raise_later(
              half / 2,
              half % 2 == 0 ? 0 : static_cast<std::uint32_t>(arcs_[half / 2].ranges.size() - 1));
    }
  }

  // Finds the connected components of the borders, and the face around each.
  void find_components() {
    std::vector<std::uint32_t> parent(graph_.nodes.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t node) {
      while (parent[node] != node) node = parent[node] = parent[parent[node]];
      return node;
    };
    for (const BorderArc& arc : graph_.arcs)
      if (!arc.is_ring()) parent[root(arc.from)] = root(arc.to);
    std::vector<std::uint32_t> of_root(graph_.nodes.size(), 0xffffffff);
    for (std::uint32_t i = 0; i < graph_.arcs.size(); ++i) {
      const BorderArc& arc = graph_.arcs[i];
      std::uint32_t component = static_cast<std::uint32_t>(components_.size());
      if (!arc.is_ring()) {
        std::uint32_t& known = of_root[root(arc.from)];
        if (known == 0xffffffff) known = component;
        component = known;
      }
      if (component == components_.size()) components_.emplace_back();
      components_[component].arcs.push_back(i);
      component_of_.push_back(component);
    }
    for (Component& component : components_) {
      glm::ivec2 left(std::numeric_limits<int>::max());
      for (const std::uint32_t i : component.arcs)
        for (const glm::ivec2& point : graph_.arcs[i].chain)
          if (point.y % 2 != 0 && point.x < left.x) left = point;  // middle of a vertical side
      component.around = faces_.at(left.x / 2 - 1, left.y / 2);
    }
  }

  // Each component is still in the same face.
  void check_components(const Buckets& buckets) {
    for (std::uint32_t number = 0; number < components_.size(); ++number) {
      const Component& component = components_[number];
      if (component.around == kOutside) continue;
      glm::dvec2 left(std::numeric_limits<double>::max());
      for (const std::uint32_t i : component.arcs)
        for (const glm::dvec2& point : arcs_[i].points)
          if (point.x < left.x) left = point;
      left.y += 1e-7;  // the ray then misses the ends of segments
      if (face_left_of(buckets, left, number) == component.around) continue;
      const int reach = static_cast<int>((tolerance_ + 2) / kBucket) + 1;
      const int column = Buckets::place(left.x, buckets.columns()),
                row = Buckets::place(left.y, buckets.rows());
      for (int y = std::max(0, row - reach); y <= std::min(buckets.rows() - 1, row + reach); ++y)
        for (int x = std::max(0, column - reach);
             x <= std::min(buckets.columns() - 1, column + reach); ++x)
          for (const std::uint32_t segment : buckets.in(x, y))
            raise_later(segments_[segment].arc, segments_[segment].number);
    }
  }

  // Returns the face at a point, according to the borders of other components.
  std::uint32_t face_left_of(const Buckets& buckets, const glm::dvec2& point,
                             std::uint32_t component) const {
    const int row = Buckets::place(point.y, buckets.rows());
    double nearest = -1;
    std::uint32_t face = kOutside;
    for (int column = Buckets::place(point.x, buckets.columns()); column >= 0; --column) {
      for (const std::uint32_t i : buckets.in(column, row)) {
        const Segment& segment = segments_[i];
        const auto& [a, b, arc, part] = segment;
        if (component_of_[arc] == component || (a.y <= point.y) == (b.y <= point.y)) continue;
        const double x = std::lerp(a.x, b.x, (point.y - a.y) / (b.y - a.y));
        if (x > point.x || x <= nearest) continue;
        nearest = x;
        // The left of a border that leads down the page is the right side of the page.
        face = b.y > a.y ? graph_.arcs[arc].left : graph_.arcs[arc].right;
      }
      if (nearest >= column * kBucket) break;
    }
    return face;
  }

  struct Component {
    std::vector<std::uint32_t> arcs;
    std::uint32_t around = kOutside;
  };

  const LabelFaces& faces_;
  const BorderGraph& graph_;
  const double tolerance_;
  std::vector<SmoothArc> arcs_;
  const std::vector<std::vector<HalfArc>> walks_;
  std::vector<std::uint8_t> is_outer_;  // by walk: whether it is the outer border of its face
  std::vector<std::vector<std::uint8_t>> levels_;            // by arc and point of its chain
  std::vector<std::uint8_t> is_changed_, is_checked_again_;  // by arc
  std::vector<Segment> segments_;
  std::vector<Raised> raised_;
  std::vector<Component> components_;
  std::vector<std::uint32_t> component_of_;  // by arc
  int round_ = 0;
};

}  // namespace

Result<std::vector<SmoothArc>> noncrossing_arcs(const LabelFaces& faces, const BorderGraph& graph,
                                                double tolerance, const Progress& progress) {
  return Smoothing(faces, graph, tolerance).find(progress);
}

}  // namespace strata::figure
