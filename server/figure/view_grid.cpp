#include "figure/view_grid.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

#include "figure/drawing.h"

namespace strata::figure {
namespace {

// Views are at least this wide and high, so that their titles have room.
constexpr double kLeast_mm = 25;
constexpr double kMargin = 1.02;  // around the content, as in figures of one view

struct Lengths {
  std::vector<double> columns, rows;
};

// Returns the widths of columns and the heights of rows that the views need at a common scale.
// Views with their own scale count at most as `most_own`.
Lengths lengths_at(double scale, const std::vector<ViewSize>& views, std::size_t columns,
                   const glm::dvec2& most_own) {
  const std::size_t rows = (views.size() + columns - 1) / columns;
  Lengths lengths{std::vector<double>(columns, kLeast_mm), std::vector<double>(rows, kLeast_mm)};
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewSize& view = views[i];
    glm::dvec2 size = view.life_mm * (kMargin / view.scale.value_or(scale)) + 2.0 * view.border_mm;
    if (view.scale) size = glm::min(size, most_own);
    double &width = lengths.columns[i % columns], &height = lengths.rows[i / columns];
    width = std::max(width, size.x);
    height = std::max(height, size.y);
  }
  return lengths;
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

ViewGrid grid_of(const std::vector<ViewSize>& views, std::size_t columns, const Box& area,
                 const ViewSpacing& spacing, std::optional<double> scale) {
  const std::size_t rows = (views.size() + columns - 1) / columns;
  const glm::dvec2 between(static_cast<double>(columns - 1) * spacing.gap_mm,
                           static_cast<double>(rows - 1) * spacing.gap_mm +
                               static_cast<double>(rows) * spacing.below_mm);
  const glm::dvec2 room = glm::max(area.size - between, 1.0);
  const auto tightness = [&](const Lengths& lengths) {
    return std::max(sum(lengths.columns) / room.x, sum(lengths.rows) / room.y);
  };
  ViewGrid grid;
  Lengths lengths;
  // Views whose own scale is too large for the area get an equal share of it, so that the others
  // fit.
  const glm::dvec2 equal = room / glm::dvec2(columns, rows);
  for (const glm::dvec2& most_own : {glm::dvec2(std::numeric_limits<double>::max()), equal}) {
    for (const double each : scale ? std::span(&*scale, 1) : round_scales()) {
      grid.scale = each;
      lengths = lengths_at(each, views, columns, most_own);
      if (tightness(lengths) <= 1) break;
    }
    if (tightness(lengths) <= 1) break;
  }
  grid.tightness = tightness(lengths);
  const glm::dvec2 share = room / glm::dvec2(sum(lengths.columns), sum(lengths.rows));
  glm::dvec2 at = area.corner;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const glm::dvec2 size =
        share * glm::dvec2(lengths.columns[i % columns], lengths.rows[i / columns]);
    grid.boxes.push_back({at, size});
    at.x += size.x + spacing.gap_mm;
    if (i % columns + 1 < columns) continue;
    at = {area.corner.x, at.y + size.y + spacing.below_mm + spacing.gap_mm};
  }
  return grid;
}

}  // namespace

ViewGrid arrange_views(const std::vector<ViewSize>& views, const Box& area,
                       const ViewSpacing& spacing, std::optional<double> scale) {
  std::optional<ViewGrid> best;
  for (std::size_t columns = 1; columns <= views.size(); ++columns) {
    const std::size_t rows = (views.size() + columns - 1) / columns;
    if (columns > (views.size() + rows - 1) / rows) continue;  // the last column would be empty
    ViewGrid grid = grid_of(views, columns, area, spacing, scale);
    if (!best || std::pair(grid.scale, grid.tightness) < std::pair(best->scale, best->tightness))
      best = std::move(grid);
  }
  return best.value_or(ViewGrid{});
}

}  // namespace strata::figure
