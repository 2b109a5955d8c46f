#include <algorithm>
#include <cmath>
#include <map>

#include "app/figures/class_names.h"
#include "app/figures/figures.h"
#include "app/reports/report_parts.h"
#include "domain/people/question.h"
#include "domain/scene/model.h"
#include "figure/paper.h"
#include "report/page.h"
#include "room/queries.h"
#include "room/room.h"

namespace strata::app {
namespace {

constexpr int kDpi = 200, kPlaceDpi = 150;
// Two wide drawings with their captions fit on a page.
constexpr glm::dvec2 kWide_mm{report::kMaxPictureWidth_mm, 110}, kTall_mm{kWide_mm.x, 200};
// An object is tall if its height is at least this many times its width.
constexpr double kTallShape = 1.1;
constexpr double kPlaceHeight_mm = 60;
// The drawing of a record shows this many times its size, and at least this share of the object.
constexpr double kAround = 3, kLeastOfObject = 0.1;

// Returns the size of the model's box along the axes of the drawing.
glm::dvec2 size_on(const figure::Plane& plane, const Model& model) {
  const glm::dvec3 size = model.bounds_max - model.bounds_min;
  return {glm::dot(glm::abs(plane.right), size), glm::dot(glm::abs(plane.up), size)};
}

void set_sheet(FigureRequest& figure, const glm::dvec2& size_mm, int dpi) {
  figure.sheet_mm = size_mm;
  figure.dpi = dpi;
  figure.format = figure::Format::png;
  figure.captions = {"", "", ""};
}

// The settings of a layer in a drawing, to change them.
room::LayerView& view_of(FigureRequest& figure, LayerId layer) {
  room::LayerView view = figure.shown.shown.of(layer);
  view.layer_id = layer;
  return figure.shown.shown.layers.emplace_back(std::move(view));
}

// Returns the labels of the records on a layer. Returns no labels for more records than a legend
// can show.
Result<RecordNames> labels_of(const ReportContext& context, const Layer& layer) {
  constexpr std::size_t kMaxKeys = 40;
  const auto places = STRATA_TRY(record_places(context, layer));
  if (places.size() > kMaxKeys) return RecordNames{};
  std::vector<std::int64_t> keys;
  for (const auto& [key, place] : places) keys.push_back(key);
  const auto at = records_at(context, layer);
  const auto names =
      STRATA_TRY(record_names(context.services.store, *layer.table, context.request.reader.role,
                              keys, at, context.words.tag));
  RecordNames labels;
  for (const std::int64_t key : keys) labels[key] = record_label(context.words, names, key);
  return labels;
}

// Gives the keys of records their names, so that the legend lists them. Leaves out layers with more
// keys than a legend can show.
Result<void> name_keys(const ReportContext& context, std::map<LayerId, RecordNames>& known,
                       FigureRequest& figure) {
  for (const Layer& layer : figure.layers) {
    const auto& own = figure.shown.shown.of(layer.id).palette;
    Palette palette = own ? *own : layer.palette;
    if (!layer.table || !lists_values(palette)) continue;
    auto found = known.find(layer.id);
    if (found == known.end()) {
      auto labels = STRATA_TRY(labels_of(context, layer));
      found = known.emplace(layer.id, std::move(labels)).first;
    }
    if (found->second.empty()) continue;
    std::vector<Palette::Point> points;
    for (const auto& [key, label] : found->second) {
      const auto value = static_cast<double>(key);
      const Palette::Point* listed = point_of(palette, value);
      Palette::Point point = listed && listed->at == value ? *listed : Palette::Point{};
      point.at = value;
      point.color = color_of(palette, value);
      point.label = label;
      points.push_back(std::move(point));
    }
    palette.points = std::move(points);
    view_of(figure, layer.id).palette = std::move(palette);
  }
  return {};
}

Result<std::shared_ptr<const TemporaryFile>> draw_figure(const ReportContext& context,
                                                         const FigureRequest& figure,
                                                         Progress& progress) {
  check_question();
  Progress drawing;  // its messages and fractions are not those of the report
  const Progress::WhenCancelled stop(progress, [&drawing] { drawing.cancel(); });
  return make_figure(context.services, context.budget, figure, context.folder, drawing);
}

}  // namespace

std::uint64_t drawing_bytes() {
  const glm::dvec2 pixels = glm::ceil(kTall_mm / figure::kInch_mm * double(kDpi));
  return std::uint64_t{4} * static_cast<std::uint64_t>(pixels.x * pixels.y);
}

Result<Blocks> figures_part(const ReportContext& context, Progress& progress) {
  Blocks blocks;
  const auto& figures = context.request.figures;
  const Model model = context.request.room->model();
  std::map<LayerId, RecordNames> labels;  // of the layers of earlier figures
  for (std::size_t i = 0; i < figures.size(); ++i) {
    if (progress.cancelled()) return cancelled_problem();
    progress.report(
        static_cast<double>(i) / static_cast<double>(figures.size()),
        "Drawing figure " + std::to_string(i + 1) + " of " + std::to_string(figures.size()));
    FigureRequest figure = figures[i].request;
    const glm::dvec2 size = size_on(figure.plane, model);
    const glm::dvec2& sheet = size.y > kTallShape * size.x ? kTall_mm : kWide_mm;
    set_sheet(figure, sheet, kDpi);
    STRATA_TRY(name_keys(context, labels, figure));
    auto file = draw_figure(context, figure, progress);
    if (!file) {
      Error problem = std::move(file.error());
      if (problem.code == ErrorCode::invalid) problem.field = "figures[" + std::to_string(i) + "]";
      return tl::unexpected(std::move(problem));
    }
    context.files.push_back(*file);
    blocks.emplace_back(report::Picture{
        (*file)->path, sheet.x, model.name + ", " + figures[i].caption, figures[i].caption});
  }
  return blocks;
}

Result<std::shared_ptr<const TemporaryFile>> place_picture(const ReportContext& context,
                                                           const Layer& layer, std::int64_t key,
                                                           const query::KeyArea& place,
                                                           Progress& progress) {
  const ReportRequest& request = context.request;
  const auto nearest =
      STRATA_TRY(request.room->queries().position((place.bounds_min + place.bounds_max) / 2.0, {}));
  if (!nearest.hit) return nullptr;
  const Model model = request.room->model();
  FigureRequest figure;
  figure.room = request.room;
  figure.role = request.reader.role;
  figure.shown = request.shown;
  figure.layers = request.layers;
  figure.plane = figure::plane_square_to(glm::dvec3(nearest.normal), model.up);
  figure.from = "record";
  figure.center = nearest.position;
  figure.legend = false;
  view_of(figure, layer.id).highlight =
      room::Highlight{std::vector{static_cast<std::uint32_t>(key)}, false};
  set_sheet(figure, {kPlaceWidth_mm, kPlaceHeight_mm}, kPlaceDpi);
  const glm::dvec3 size = place.bounds_max - place.bounds_min,
                   object = model.bounds_max - model.bounds_min;
  const double shown = std::max(kAround * std::max({size.x, size.y, size.z}),
                                kLeastOfObject * std::max({object.x, object.y, object.z}));
  figure.scale =
      figure::fitting_scale(glm::dvec2(shown), {kPlaceHeight_mm, kPlaceHeight_mm}, model.metres());
  return draw_figure(context, figure, progress);
}

}  // namespace strata::app
