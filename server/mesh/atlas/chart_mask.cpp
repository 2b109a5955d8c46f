#include "mesh/atlas/chart_mask.h"

#include <algorithm>
#include <cmath>

namespace strata::mesh {
namespace {

// Collects the texels of each row that a chart touches. These are the texels under its rim, and the
// texels between two crossings of the row's center line if the rim winds around them.
class Rows {
 public:
  Rows(int width, int height) : width_(width), rim_(height), crossings_(height) {}

  void add(glm::dvec2 a, glm::dvec2 b) {
    const int direction = a.y < b.y ? 1 : -1;
    if (direction < 0) std::swap(a, b);
    const int height = static_cast<int>(rim_.size());
    const int first = std::max(static_cast<int>(a.y - kNear), 0);
    const int last = std::min(static_cast<int>(b.y + kNear), height - 1);
    const double slope = b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0;
    for (int y = first; y <= last; ++y) {
      const double x0 = y - kNear <= a.y ? a.x : a.x + slope * (y - kNear - a.y);
      const double x1 = y + 1 + kNear >= b.y ? b.x : a.x + slope * (y + 1 + kNear - a.y);
      const std::int16_t begin = column(std::min(x0, x1) - kNear),
                         end = column(std::max(x0, x1) + kNear);
      rim_[y].push_back({begin, static_cast<std::int16_t>(end + 1)});
      if (a.y <= y + 0.5 && y + 0.5 < b.y)
        crossings_[y].push_back(
            {column(a.x + slope * (y + 0.5 - a.y)), static_cast<std::int16_t>(direction)});
    }
  }

  ChartMask mask() {
    ChartMask mask;
    mask.width = width_, mask.height = static_cast<int>(rim_.size());
    mask.first_run.push_back(0);
    for (std::size_t y = 0; y < rim_.size(); ++y) {
      auto& runs = rim_[y];
      add_inner(crossings_[y], runs);
      // A row can be empty only because of rounding. Such a row is treated as full.
      if (runs.empty()) runs.push_back({0, static_cast<std::int16_t>(width_)});
      std::sort(runs.begin(), runs.end(),
                [](const auto& a, const auto& b) { return a.begin < b.begin; });
      ChartMask::Run open = runs.front();
      for (const auto& run : runs) {
        if (run.begin > open.end) mask.runs.push_back(std::exchange(open, run));
        open.end = std::max(open.end, run.end);
      }
      mask.runs.push_back(open);
      mask.first_run.push_back(static_cast<std::uint32_t>(mask.runs.size()));
    }
    return mask;
  }

 private:
  struct Crossing {
    std::int16_t column, direction;
  };
  std::int16_t column(double x) const {
    return static_cast<std::int16_t>(std::clamp(static_cast<int>(x), 0, width_ - 1));
  }
  static void add_inner(std::vector<Crossing>& crossings, std::vector<ChartMask::Run>& runs) {
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
      return a.column != b.column ? a.column < b.column : a.direction < b.direction;
    });
    int winding = 0;
    for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
      winding += crossings[i].direction;
      if (winding != 0)
        runs.push_back(
            {crossings[i].column, static_cast<std::int16_t>(crossings[i + 1].column + 1)});
    }
  }

  const int width_;
  std::vector<std::vector<ChartMask::Run>> rim_;
  std::vector<std::vector<Crossing>> crossings_;
};

ChartMask with_columns_reversed(ChartMask mask) {
  const auto width = static_cast<std::int16_t>(mask.width);
  for (int y = 0; y < mask.height; ++y) {
    const auto begin = mask.runs.begin() + mask.first_run[y],
               end = mask.runs.begin() + mask.first_run[y + 1];
    for (auto run = begin; run != end; ++run)
      *run = {static_cast<std::int16_t>(width - run->end),
              static_cast<std::int16_t>(width - run->begin)};
    std::reverse(begin, end);
  }
  return mask;
}

ChartMask with_rows_reversed(const ChartMask& mask) {
  ChartMask result;
  result.width = mask.width, result.height = mask.height;
  result.first_run.push_back(0);
  for (int y = mask.height - 1; y >= 0; --y) {
    result.runs.insert(result.runs.end(), mask.row(y).begin(), mask.row(y).end());
    result.first_run.push_back(static_cast<std::uint32_t>(result.runs.size()));
  }
  return result;
}

}  // namespace

ChartShape make_shape(const Outline& outline, double density) {
  ChartShape shape;
  shape.box = glm::ivec2(glm::floor(glm::dvec2(outline.size) * density + 2 * kNear)) + 1;
  Rows rows(shape.box.x, shape.box.y), columns(shape.box.y, shape.box.x);
  const glm::dvec2 largest = glm::dvec2(shape.box) - 1e-9;
  for (std::size_t i = 0; i + 1 < outline.segments.size(); i += 2) {
    const glm::dvec2 a =
        glm::clamp(glm::dvec2(outline.segments[i]) * density + kNear, glm::dvec2(0), largest);
    const glm::dvec2 b =
        glm::clamp(glm::dvec2(outline.segments[i + 1]) * density + kNear, glm::dvec2(0), largest);
    rows.add(a, b);
    columns.add({a.y, a.x}, {b.y, b.x});
  }
  // A quarter turn maps (x, y) to (height - y, x). The rows of the result are the columns of the
  // source, read from top to bottom.
  const ChartMask upright = rows.mask(), transposed = columns.mask();
  shape.turned[0] = upright;
  shape.turned[1] = with_columns_reversed(transposed);
  shape.turned[2] = with_rows_reversed(with_columns_reversed(upright));
  shape.turned[3] = with_rows_reversed(transposed);
  return shape;
}

}  // namespace strata::mesh
