#include "app/figures/rollout_view.h"

#include <algorithm>
#include <cmath>
#include <mutex>

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

class RolloutView : public SheetView {
 public:
  RolloutView(const Services& services, const FigureRequest& request, RolloutRequest rollout,
              mesh::FittedSheet planned)
      : services_(services),
        request_(request),
        rollout_(std::move(rollout)),
        planned_(std::move(planned)),
        mm_per_unit_(request.room->model().metres() * kMmPerMetre) {}

  const FigureRequest& request() const override { return request_; }
  figure::ViewSize size() const override {
    return {(planned_.sheet.max - planned_.sheet.min) * mm_per_unit_, figure::kRulerRoom_mm,
            request_.scale};
  }
  void place(const figure::ViewPlace& place) override;
  const figure::ViewPlace& placed() const override { return place_; }
  Result<std::vector<query::SeenLayer>> seen_layers(Progress& progress) const override;
  Result<ViewContent> content(const Stage&, Progress&) const override {
    ViewContent content;
    content.above = figure::ruler_groups(drawing_);
    return content;
  }
  Result<void> draw(Picture& sheet, Progress& progress) const override;

 private:
  const Services& services_;
  const FigureRequest& request_;
  const RolloutRequest rollout_;
  const mesh::FittedSheet planned_;
  const double mm_per_unit_;
  figure::ViewPlace place_;
  figure::UnrolledDrawing drawing_;
  mesh::RolloutWindow window_;  // over the whole box of the view
  glm::ivec2 border_{0};        // in pixels, on each side of the window, for the rulers
};

void RolloutView::place(const figure::ViewPlace& place) {
  place_ = place;
  const mesh::RolloutSheet& sheet = planned_.sheet;
  const double pixel_mm = figure::kInch_mm / request_.dpi;
  border_ = glm::ivec2(glm::ceil(figure::kRulerRoom_mm / pixel_mm));
  drawing_.sheet = sheet;
  drawing_.center = (sheet.min + sheet.max) / 2.0;
  drawing_.mm_per_unit = mm_per_unit_;
  drawing_.units_per_mm = place.scale / mm_per_unit_;
  // The place of a fitted axis is arbitrary.
  drawing_.zero_slant = request_.rollout->fit.axis ? 0 : sheet.slant_from;
  const glm::dvec2 border_mm = glm::dvec2(border_) * pixel_mm;
  drawing_.area = {place.box.corner + border_mm, glm::max(place.box.size - 2.0 * border_mm, 0.0)};
  window_ =
      window_around(drawing_.center, place.width, place.height, drawing_.units_per_mm * pixel_mm);
}

Result<std::vector<query::SeenLayer>> RolloutView::seen_layers(Progress& progress) const {
  std::vector<query::LayerView> views;
  for (const Layer& layer : request_.layers) {
    auto tiles = STRATA_TRY(request_.room->queries().tiles(layer.slug, request_.shown.at));
    views.push_back({layer, std::move(tiles)});
  }
  std::vector<query::SeenLayer> seen(views.size());
  if (views.empty()) return seen;
  const auto geometry = request_.room->surface().geometry();
  const auto tree = request_.room->surface().search_tree();
  const auto covers = covers_of(request_);
  const glm::dvec2 inches = drawing_.area.size / figure::kInch_mm;
  const double dpi = std::min<double>(figure::kCameraDpi,
                                      std::sqrt(kMaxCells / std::max(1e-6, inches.x * inches.y)));
  const mesh::RolloutWindow grid =
      window_around(drawing_.center, std::max(1, static_cast<int>(inches.x * dpi)),
                    std::max(1, static_cast<int>(inches.y * dpi)),
                    drawing_.units_per_mm * figure::kInch_mm / dpi);
  std::mutex mutex;
  const auto see_row = [&](int, std::span<const std::optional<mesh::RolloutHit>> pixels) {
    std::vector<query::SeenLayer> in_row(views.size());
    for (const auto& pixel : pixels)
      if (pixel) query::see_point(pixel->hit.uv, views, covers, in_row);
    const std::lock_guard lock(mutex);
    query::merge(seen, std::move(in_row));
  };
  STRATA_TRY(mesh::trace_rollout(*tree, *geometry, drawing_.sheet, grid, see_row, progress));
  return seen;
}

Result<void> RolloutView::draw(Picture& sheet, Progress& progress) const {
  const auto put_row = [&](int row, std::span<const std::uint8_t> rgba) {
    if (row < border_.y || row >= place_.height - border_.y) return;
    std::uint8_t* to = &sheet.rgba[4 * (static_cast<std::size_t>(place_.y + row) *
                                            static_cast<std::size_t>(sheet.width) +
                                        static_cast<std::size_t>(place_.x))];
    // The border and pixels without a surface stay white.
    for (int x = border_.x; x < place_.width - border_.x; ++x) {
      const std::size_t at = 4 * static_cast<std::size_t>(x);
      if (rgba[at + 3] != 0) std::copy_n(&rgba[at], 4, to + at);
    }
  };
  return draw_rollout(services_, rollout_, planned_, window_, put_row, progress);
}

}  // namespace

Result<std::unique_ptr<SheetView>> make_rollout_view(const Services& services,
                                                     const FigureRequest& request) {
  RolloutRequest rollout = rollout_of(request);
  auto planned = STRATA_TRY(plan(rollout));
  return std::unique_ptr<SheetView>(
      std::make_unique<RolloutView>(services, request, std::move(rollout), std::move(planned)));
}

}  // namespace strata::app
