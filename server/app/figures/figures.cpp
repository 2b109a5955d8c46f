#include "app/figures/figures.h"

#include <algorithm>
#include <cmath>

#include "app/figures/figure_file.h"
#include "app/figures/figure_legend.h"
#include "app/figures/plane_view.h"
#include "app/figures/rollout_view.h"

namespace strata::app {
namespace {

constexpr Stage kMeasuring{0, 0.05}, kOutlines{0.05, 0.45}, kWriting{0.75, 1};

using Views = std::vector<std::unique_ptr<SheetView>>;

Result<std::unique_ptr<SheetView>> make_view(const Services& services, ByteBudget& budget,
                                             const FigureRequest& request) {
  if (request.rollout) return make_rollout_view(services, request);
  auto view = STRATA_TRY(PlaneView::make(services, budget, request));
  return std::unique_ptr<SheetView>(std::move(view));
}

// The error of one of several views names the view.
Result<Views> make_views(const Services& services, ByteBudget& budget,
                         const FigureRequest& request) {
  Views views;
  const std::span<const FigureRequest> requests =
      request.views.empty() ? std::span(&request, 1) : std::span(request.views);
  for (std::size_t i = 0; i < requests.size(); ++i) {
    auto view = make_view(services, budget, requests[i]);
    if (!view && !request.views.empty() && !view.error().field.empty())
      view.error().field = "views[" + std::to_string(i) + "]." + view.error().field;
    if (!view) return tl::unexpected(std::move(view.error()));
    views.push_back(std::move(*view));
  }
  return views;
}

ChosenSheet choose(const FigureRequest& request, const Views& views,
                   const std::vector<figure::Legend>& legends) {
  std::vector<figure::ViewSize> sizes;
  for (const auto& view : views) sizes.push_back(view->size());
  ChosenSheet chosen = choose_sheet(request, legends, sizes);
  for (std::size_t i = 0; i < views.size(); ++i) views[i]->place(chosen.views.places[i]);
  return chosen;
}

Result<std::vector<figure::Legend>> legends_for(store::Store& store, const Views& views,
                                                Progress& progress) {
  std::vector<SeenView> seen_views;
  for (const auto& view : views) {
    auto seen = STRATA_TRY(view->seen_layers(progress));
    seen_views.push_back({&view->request(), std::move(seen)});
  }
  return legends_of(store, seen_views);
}

Result<std::shared_ptr<const TemporaryFile>> make_dxf(const Services& services, ByteBudget& budget,
                                                      const FigureRequest& request,
                                                      const std::filesystem::path& folder,
                                                      Progress& progress) {
  const auto view = STRATA_TRY(PlaneView::make(services, budget, request));
  view->place(choose_sheet(request, {}, {view->size()}).views.places.front());
  const figure::Drawing& drawing = view->drawing();
  auto labels = STRATA_TRY(view->labels());
  auto vectors = STRATA_TRY(view->vectors(kOutlines, progress));
  auto dimensions = view->dimensions();
  const auto is_empty = [](const figure::LayerVectors& layer) {
    return layer.areas.empty() && layer.marks.empty();
  };
  if (std::ranges::all_of(vectors.areas, is_empty) &&
      std::ranges::all_of(vectors.marks, is_empty) && labels.empty() && dimensions.empty())
    return fail(ErrorCode::invalid, "Nothing to draw",
                "A DXF file contains only classes, records and dimensions, and the drawing has "
                "none. Show a layer with classes or records, or choose another format.",
                "format");
  const figure::Box& box = view->placed().box;
  const double mm_per_unit = drawing.metres_per_unit * 1000;
  const glm::dvec2 half_mm = box.size * (drawing.scale / 2);
  const figure::DxfDrawing dxf{std::move(vectors.areas),
                               std::move(vectors.marks),
                               std::move(labels),
                               std::move(dimensions),
                               box,
                               drawing.scale,
                               drawing.center * mm_per_unit + glm::dvec2(-half_mm.x, half_mm.y)};
  return write_dxf_file(request, dxf, folder, progress);
}

// Returns the scale that all views have, if any.
std::optional<double> common_scale(const Views& views) {
  const double scale = views.front()->placed().scale;
  const bool is_common =
      std::ranges::all_of(views, [&](const auto& view) { return view->placed().scale == scale; });
  return is_common ? std::optional(scale) : std::nullopt;
}

// Makes the ids of a view different from those of the other views.
void add_suffix(figure::Group& group, const std::string& suffix) {
  group.id += suffix;
  for (figure::Group& part : group.parts) add_suffix(part, suffix);
}

// Moves the content of all views to the sheet.
figure::Sheet sheet_of(const ChosenSheet& chosen, const Views& views,
                       std::vector<ViewContent>& contents) {
  std::vector<figure::PlacedView> placed;
  for (std::size_t i = 0; i < views.size(); ++i)
    placed.push_back({views[i]->placed(), views[i]->request().view_title, contents[i].north,
                      std::move(contents[i].labels)});
  figure::Sheet sheet = chosen.layout.finish(placed);
  std::vector<figure::Group> groups;
  const auto add = [&](std::vector<figure::Group>& more, std::size_t view) {
    for (figure::Group& group : more) {
      if (view > 0) add_suffix(group, "-view-" + std::to_string(view + 1));
      groups.push_back(std::move(group));
    }
  };
  for (std::size_t i = 0; i < views.size(); ++i) add(contents[i].below, i);
  for (figure::Group& group : sheet.groups) groups.push_back(std::move(group));
  for (std::size_t i = 0; i < views.size(); ++i) add(contents[i].above, i);
  sheet.groups = std::move(groups);
  return sheet;
}

}  // namespace

Result<std::shared_ptr<const TemporaryFile>> make_figure(const Services& services,
                                                         ByteBudget& budget,
                                                         const FigureRequest& request,
                                                         const std::filesystem::path& folder,
                                                         Progress& progress) {
  progress.begin_stage(kMeasuring.from, kMeasuring.to);
  progress.report(0, "Measuring");
  if (request.format == figure::Format::dxf)
    return make_dxf(services, budget, request, folder, progress);
  const Views views = STRATA_TRY(make_views(services, budget, request));
  std::vector<figure::Legend> legends;
  if (request.legend) {
    // Without a legend, the drawing is largest. The legend therefore lists the content of this
    // largest drawing.
    choose(request, views, {});
    auto seen = STRATA_TRY(legends_for(services.store, views, progress));
    legends = std::move(seen);
  }
  const ChosenSheet chosen = choose(request, views, legends);
  std::vector<ViewContent> contents;
  for (std::size_t i = 0; i < views.size(); ++i) {
    auto content = STRATA_TRY(views[i]->content(kOutlines.part(i, views.size()), progress));
    contents.push_back(std::move(content));
  }
  const int width = chosen.layout.drawing_width(), height = chosen.layout.drawing_height();
  const std::uint64_t bytes =
      std::uint64_t{4} * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  const auto held = STRATA_TRY(budget.take(bytes));
  Picture picture{width, height, std::vector<std::uint8_t>(bytes, 255)};  // white
  const Stage drawing{request.outline_tolerance_mm ? kOutlines.to : kMeasuring.to, kWriting.from};
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Stage stage = drawing.part(i, views.size());
    progress.begin_stage(stage.from, stage.to);
    STRATA_TRY(views[i]->draw(picture, progress));
  }
  progress.begin_stage(kWriting.from, kWriting.to);
  const figure::Sheet sheet = sheet_of(chosen, views, contents);
  return write_figure_file(request, sheet, picture, common_scale(views), folder, progress);
}

}  // namespace strata::app
