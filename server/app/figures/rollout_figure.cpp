#include "app/figures/rollout_figure.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "app/figures/figure_file.h"
#include "app/figures/figure_legend.h"
#include "app/figures/rollout.h"
#include "domain/scene/model.h"
#include "figure/paper.h"
#include "figure/ruler.h"
#include "query/sampling/seen_layers.h"
#include "room/queries.h"
#include "room/surface.h"

namespace strata::app {
namespace {

constexpr double kMmPerMetre = 1000;
// The grid for the legend: the pixels of a camera of a figure, but at most this many cells.
constexpr double kMaxCells = 250'000;

RolloutRequest rollout_of(const FigureRequest& request) {
  RolloutRequest rollout;
  rollout.room = request.room;
  rollout.role = request.role;
  rollout.fit = request.rollout->fit;
  rollout.cut = request.rollout->cut;
  rollout.relief = request.rollout->relief;
  rollout.shown = request.shown.shown;
  rollout.layers = request.layers;
  rollout.at = request.shown.at;
  return rollout;
}

Result<mesh::FittedSheet> plan(const RolloutRequest& rollout) {
  auto found = plan_rollout(rollout);
  if (!found && !found.error().field.empty())
    found.error().field = "rollout." + found.error().field;
  return found;
}

// A rollout on a sheet of paper.
struct Placed {
  figure::UnrolledDrawing drawing;
  mesh::RolloutWindow window;  // over the whole area of the figure's drawing
  glm::ivec2 border{0};        // in pixels, on each side of the window, for the rulers
};

// Returns a window whose middle is a point of the sheet.
mesh::RolloutWindow window_around(const glm::dvec2& center, int width, int height,
                                  double units_per_pixel) {
  mesh::RolloutWindow window;
  window.top_left = center + glm::dvec2(-width, height) * (units_per_pixel / 2);
  window.units_per_pixel = units_per_pixel;
  window.width = width;
  window.height = height;
  return window;
}

Placed place(const ChosenSheet& chosen, const FigureRequest& request,
             const mesh::RolloutSheet& sheet, double metres_per_unit) {
  Placed placed;
  const double pixel_mm = figure::kInch_mm / request.dpi;
  placed.border = glm::ivec2(glm::ceil(figure::kRulerRoom_mm / pixel_mm));
  figure::UnrolledDrawing& drawing = placed.drawing;
  drawing.sheet = sheet;
  drawing.center = (sheet.min + sheet.max) / 2.0;
  drawing.mm_per_unit = metres_per_unit * kMmPerMetre;
  drawing.units_per_mm = chosen.scale / drawing.mm_per_unit;
  // The place of a fitted axis is arbitrary.
  drawing.zero_slant = request.rollout->fit.axis ? 0 : sheet.slant_from;
  const glm::dvec2 border_mm = glm::dvec2(placed.border) * pixel_mm;
  const figure::Box& whole = chosen.layout.drawing();
  drawing.area = {whole.corner + border_mm, glm::max(whole.size - 2.0 * border_mm, 0.0)};
  placed.window = window_around(drawing.center, chosen.layout.drawing_width(),
                                chosen.layout.drawing_height(), drawing.units_per_mm * pixel_mm);
  return placed;
}

// Returns the legends of the layers and classes in the drawing.
Result<std::vector<figure::Legend>> legends_on(store::Store& store, const FigureRequest& request,
                                               const Placed& placed, Progress& progress) {
  if (request.layers.empty()) return std::vector<figure::Legend>{};
  const auto geometry = request.room->surface().geometry();
  const auto tree = request.room->surface().search_tree();
  std::vector<query::LayerView> views;
  for (const Layer& layer : request.layers) {
    auto tiles = STRATA_TRY(request.room->queries().tiles(layer.slug, request.shown.at));
    views.push_back({layer, std::move(tiles)});
  }
  const auto covers = covers_of(request);
  const glm::dvec2 inches = placed.drawing.area.size / figure::kInch_mm;
  const double dpi = std::min<double>(figure::kCameraDpi,
                                      std::sqrt(kMaxCells / std::max(1e-6, inches.x * inches.y)));
  const mesh::RolloutWindow grid =
      window_around(placed.drawing.center, std::max(1, static_cast<int>(inches.x * dpi)),
                    std::max(1, static_cast<int>(inches.y * dpi)),
                    placed.drawing.units_per_mm * figure::kInch_mm / dpi);
  std::vector<query::SeenLayer> seen(views.size());
  std::mutex mutex;
  const auto see_row = [&](int, std::span<const std::optional<mesh::RolloutHit>> pixels) {
    std::vector<query::SeenLayer> in_row(views.size());
    for (const auto& pixel : pixels)
      if (pixel) query::see_point(pixel->hit.uv, views, covers, in_row);
    const std::lock_guard lock(mutex);
    query::merge(seen, std::move(in_row));
  };
  STRATA_TRY(mesh::trace_rollout(*tree, *geometry, placed.drawing.sheet, grid, see_row, progress));
  return legends_of(store, request, seen);
}

// Makes pixels without a surface and the border white.
void put_on_paper(Picture& picture, const glm::ivec2& border) {
  std::uint8_t* rgba = picture.rgba.data();
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x, rgba += 4) {
      const bool is_border = x < border.x || y < border.y || x >= picture.width - border.x ||
                             y >= picture.height - border.y;
      if (is_border || rgba[3] == 0) std::fill_n(rgba, 4, std::uint8_t{255});
    }
}

}  // namespace

Result<std::shared_ptr<const TemporaryFile>> make_rollout_figure(
    const Services& services, ByteBudget& budget, const FigureRequest& request,
    const std::filesystem::path& folder, Progress& progress) {
  progress.begin_stage(0, 0.1);
  progress.report(0, "Measuring");
  const RolloutRequest rollout = rollout_of(request);
  const mesh::FittedSheet planned = STRATA_TRY(plan(rollout));
  const mesh::RolloutSheet& surface = planned.sheet;
  const double metres = request.room->model().metres();
  const auto chosen_with = [&](const std::vector<figure::Legend>& legends) {
    return choose_sheet(request, legends, surface.max - surface.min, metres, figure::kRulerRoom_mm);
  };
  std::vector<figure::Legend> legends;
  if (request.legend) {
    // As in make_figure, the legend lists the content of the drawing without a legend.
    auto seen = STRATA_TRY(legends_on(services.store, request,
                                      place(chosen_with({}), request, surface, metres), progress));
    legends = std::move(seen);
  }
  const ChosenSheet chosen = chosen_with(legends);
  const Placed placed = place(chosen, request, surface, metres);
  const auto held =
      STRATA_TRY(budget.take(std::uint64_t{4} * static_cast<std::uint64_t>(placed.window.width) *
                             static_cast<std::uint64_t>(placed.window.height)));
  progress.begin_stage(0.1, 0.75);
  Picture picture = STRATA_TRY(draw_rollout(services, rollout, planned, placed.window, progress));
  put_on_paper(picture, placed.border);
  progress.begin_stage(0.75, 1);
  figure::Sheet sheet = chosen.layout.finish(chosen.scale, std::nullopt, {});
  for (figure::Group& group : figure::ruler_groups(placed.drawing))
    sheet.groups.push_back(std::move(group));
  return write_figure_file(request, sheet, picture, chosen.scale, folder, progress);
}

}  // namespace strata::app
