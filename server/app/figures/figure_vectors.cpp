#include "app/figures/figure_vectors.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "app/figures/class_names.h"
#include "app/figures/figure_legend.h"
#include "app/figures/record_marks.h"
#include "core/text/csv.h"
#include "domain/tables/label_text.h"
#include "figure/pattern.h"
#include "room/caches/record_colors.h"
#include "room/pictures.h"

namespace strata::app {
namespace {

constexpr double kCellsOfBand = 500'000;
constexpr std::uint64_t kBytesOfCell = 24;  // labels, faces, and the part of the outlines
// As in the image, a line is tested at these distances, and short hidden parts are drawn.
constexpr double kMarkStep_mm = 0.5;
constexpr int kClosedSteps = 3;

bool has_classes(const FigureRequest& request, const Layer& layer) {
  if (layer.table) return true;
  return !is_float(layer.type) && palette_of(request, layer).mode != PaletteMode::linear;
}

// Returns the palette by value.
Result<std::shared_ptr<const Palette>> colors_of(store::Store& store, const FigureRequest& request,
                                                 const Layer& layer) {
  auto palette = std::make_shared<const Palette>(palette_of(request, layer));
  const auto& own = request.shown.shown.of(layer.id).highlight;
  const auto highlight = own ? std::make_shared<const room::Highlight>(*own) : nullptr;
  if (!layer.table || !room::RecordColors::needs_records(*palette, highlight)) return palette;
  return room::RecordColors::make(store,
                                  {*layer.table, sight_of(request.role), palette, highlight});
}

// Returns the value of a texel from its form in Pictures::seen_keys.
double value_of(const Layer& layer, std::uint32_t key) {
  const bool is_signed =
      layer.type == ValueType::i8 || layer.type == ValueType::i16 || layer.type == ValueType::i32;
  return is_signed ? static_cast<double>(static_cast<std::int32_t>(key)) : key;
}

// Gives the values of a layer labels. Values in the same step of a palette have the same label.
class Classes {
 public:
  Classes(const Layer& layer, const Palette& palette) : layer_(layer), palette_(palette) {}

  std::uint32_t label_of(std::uint32_t key) {
    const auto [known, is_new] = labels_.try_emplace(key, figure::kNoLabel);
    if (!is_new) return known->second;
    const double value = value_of(layer_, key);
    const Palette::Point* point = point_of(palette_, value);
    figure::ClassArea found;
    found.color = color_of(palette_, value);
    if (found.color[3] == 0) return figure::kNoLabel;
    found.value = value;
    if (point) {
      found.pattern = point->pattern;
      found.angle = point->angle;
      found.spacing_mm = point->spacing_mm;  // on the object so far
      if (palette_.mode == PaletteMode::step) {
        found.value = point->at;
        found.name = point->label;
      }
    }
    const auto same = palette_.mode == PaletteMode::step
                          ? std::ranges::find(areas_, found.value, &figure::ClassArea::value)
                          : areas_.end();
    if (same == areas_.end()) {
      areas_.push_back(std::move(found));
      known->second = static_cast<std::uint32_t>(areas_.size());
    } else {
      known->second = static_cast<std::uint32_t>(same - areas_.begin()) + 1;
    }
    return known->second;
  }

  // The class with the label i + 1 is at i. The classes have no polygons.
  std::vector<figure::ClassArea> take() { return std::move(areas_); }

 private:
  const Layer& layer_;
  const Palette& palette_;
  std::unordered_map<std::uint32_t, std::uint32_t> labels_;
  std::vector<figure::ClassArea> areas_;
};

Result<void> name_classes(store::Store& store, const FigureRequest& request, const Layer& layer,
                          const Palette& palette, std::vector<figure::ClassArea>& areas) {
  if (!layer.table && palette.mode == PaletteMode::step) {
    for (figure::ClassArea& area : areas)
      if (area.name.empty()) area.name = csv_number(area.value, ',');
    return {};
  }
  std::optional<std::int64_t> at;
  if (layer.table) {
    auto then = STRATA_TRY(table_sequence(store, request, layer));
    at = then;
  }
  std::vector<double> values;
  for (const figure::ClassArea& area : areas) values.push_back(area.value);
  Layer with_palette = layer;  // labels come from the palette of the view
  with_palette.palette = palette_of(request, layer);
  auto names =
      STRATA_TRY(class_names(store, with_palette, request.role, values, at, request.language));
  for (std::size_t i = 0; i < areas.size(); ++i) areas[i].name = std::move(names[i]);
  return {};
}

struct Grid {
  int columns = 1, rows = 1;
  glm::dvec2 cell_mm{1};
};
Grid grid_over(const glm::dvec2& size_mm, double tolerance_mm) {
  const double wanted = std::max(std::min(kOutlineCell_mm, tolerance_mm),
                                 std::sqrt(size_mm.x * size_mm.y / kMaxOutlineCells));
  Grid grid;
  grid.columns = std::max(1, static_cast<int>(size_mm.x / wanted));
  grid.rows = std::max(1, static_cast<int>(size_mm.y / wanted));
  grid.cell_mm = size_mm / glm::dvec2(grid.columns, grid.rows);
  return grid;
}

Result<figure::LabelGrid> labels_on(const FigureRequest& request, const figure::Drawing& drawing,
                                    const Grid& grid, const Layer& layer, Classes& classes,
                                    Progress& progress) {
  figure::LabelGrid found{grid.columns, grid.rows, {}};
  found.labels.reserve(static_cast<std::size_t>(grid.columns) *
                       static_cast<std::size_t>(grid.rows));
  const int step = std::max(1, static_cast<int>(kCellsOfBand / grid.columns));
  for (int row = 0; row < grid.rows; row += step) {
    if (progress.cancelled()) return cancelled_problem();
    const int rows = std::min(step, grid.rows - row);
    const Camera camera = figure::camera_over(drawing, {0, row * grid.cell_mm.y},
                                              glm::dvec2(grid.columns, rows) * grid.cell_mm);
    const auto keys = STRATA_TRY(request.room->pictures().seen_keys(
        layer.slug, camera, grid.columns, rows, request.shown.at));
    for (const auto& key : keys)
      found.labels.push_back(key ? classes.label_of(*key) : figure::kNoLabel);
    progress.report(0.8 * (row + rows) / grid.rows, "Outlines of " + layer.name);
  }
  return found;
}

figure::LayerVectors vectors_of(const FigureRequest& request, const Layer& layer) {
  figure::LayerVectors vectors;
  vectors.id = layer.slug;
  vectors.name = label_or(layer.labels, request.language, layer.name);
  vectors.opacity = opacity_of(request, layer);
  return vectors;
}

Result<figure::LayerVectors> areas_of(store::Store& store, const FigureRequest& request,
                                      const figure::Drawing& drawing, const figure::Box& area,
                                      const Layer& layer, Progress& progress) {
  const auto palette = STRATA_TRY(colors_of(store, request, layer));
  const Grid grid = grid_over(area.size, *request.outline_tolerance_mm);
  Classes classes(layer, *palette);
  auto labels = STRATA_TRY(labels_on(request, drawing, grid, layer, classes, progress));
  figure::OutlineSettings settings;
  settings.tolerance = *request.outline_tolerance_mm / std::max(grid.cell_mm.x, grid.cell_mm.y);
  settings.smallest_area = std::pow(kSmallestPiece * settings.tolerance, 2);
  auto outlines = STRATA_TRY(figure::label_outlines(std::move(labels), settings, progress));
  figure::LayerVectors vectors = vectors_of(request, layer);
  std::vector<figure::ClassArea> areas = classes.take();
  STRATA_TRY(name_classes(store, request, layer, *palette, areas));
  for (auto& [label, polygons] : outlines.areas) {
    figure::ClassArea& of_class = areas[label - 1];
    of_class.polygons = std::move(polygons);
    for (figure::OutlinePolygon& polygon : of_class.polygons)
      for (figure::OutlineRing& ring : polygon.rings)
        for (glm::dvec2& point : ring) point = area.corner + point * grid.cell_mm;
    // The scale of the drawing, as the shader uses it.
    of_class.spacing_mm = figure::pattern_spacing(of_class.spacing_mm / drawing.scale);
    vectors.areas.push_back(std::move(of_class));
  }
  std::ranges::sort(vectors.areas, {}, &figure::ClassArea::value);
  return vectors;
}

// Adds the parts of a line or the point that the drawing shows.
Result<void> add_marks(const MarkSight& sight, const KeyFeature& feature, const Rgba& color,
                       const std::function<glm::dvec2(const glm::dvec3&)>& on_sheet,
                       std::vector<figure::RecordMark>& marks) {
  const auto& places = feature.feature.places;
  if (places.size() == 1) {
    const bool is_seen = STRATA_TRY(sight.sees(places[0]));
    if (is_seen) marks.push_back({feature.key, color, {on_sheet(places[0])}});
    return {};
  }
  std::vector<glm::dvec2> points;  // of the part so far
  std::size_t seen = 0;            // number of its points up to the last visible one
  int hidden = 0;
  const auto end_part = [&] {
    points.resize(seen);
    if (seen > 1) marks.push_back({feature.key, color, points});
    points.clear();
    seen = 0;
  };
  const auto visit = [&](const glm::dvec3& place) -> Result<void> {
    const bool is_seen = STRATA_TRY(sight.sees(place));
    hidden = is_seen ? 0 : hidden + 1;
    if (hidden > kClosedSteps) end_part();
    if (is_seen || !points.empty()) points.push_back(on_sheet(place));
    if (is_seen) seen = points.size();
    return {};
  };
  STRATA_TRY(visit(places[0]));
  for (std::size_t i = 1; i < places.size(); ++i) {
    const double length = glm::distance(on_sheet(places[i - 1]), on_sheet(places[i]));
    constexpr double kMostSteps = 10'000;
    const int steps =
        static_cast<int>(std::clamp(std::ceil(length / kMarkStep_mm), 1.0, kMostSteps));
    for (int step = 1; step <= steps; ++step)
      STRATA_TRY(visit(glm::mix(places[i - 1], places[i], static_cast<double>(step) / steps)));
  }
  end_part();
  return {};
}

Result<figure::LayerVectors> marks_of(store::Store& store, const FigureRequest& request,
                                      const Camera& camera, const figure::Box& area,
                                      const Layer& layer, const Progress& progress) {
  figure::LayerVectors vectors = vectors_of(request, layer);
  const auto features = STRATA_TRY(features_in(store, request, layer));
  if (features.empty()) return vectors;
  const auto palette = STRATA_TRY(colors_of(store, request, layer));
  const MarkSight sight(request, camera);
  const glm::dvec2 pixel_mm = area.size / glm::dvec2(camera.width, camera.height);
  const auto on_sheet = [&](const glm::dvec3& place) {
    return area.corner + sight.pixel_of(place) * pixel_mm;
  };
  for (const KeyFeature& feature : features) {
    if (progress.cancelled()) return cancelled_problem();
    const Rgba color = color_of(*palette, static_cast<double>(feature.key));
    if (color[3] != 0) STRATA_TRY(add_marks(sight, feature, color, on_sheet, vectors.marks));
  }
  return vectors;
}

}  // namespace

std::vector<std::size_t> outlined_layers(const FigureRequest& request) {
  std::vector<std::size_t> found;
  for (std::size_t i = request.layers.size(); i-- > 0;) {
    const Layer& layer = request.layers[i];
    const bool fits_above = has_classes(request, layer) && layer.blend == LayerBlend::normal &&
                            !request.shown.provisional.contains(layer.id);
    if (request.format == figure::Format::dxf) {
      if (!has_classes(request, layer)) continue;
    } else if (!fits_above) {
      break;
    }
    found.push_back(i);
  }
  std::ranges::reverse(found);
  return found;
}

Result<FigureVectors> figure_vectors(store::Store& store, ByteBudget& budget,
                                     const FigureRequest& request, const figure::Drawing& drawing,
                                     const figure::Box& area, Progress& progress) {
  FigureVectors vectors;
  const Grid grid = grid_over(area.size, *request.outline_tolerance_mm);
  const auto held = STRATA_TRY(budget.take(kBytesOfCell * static_cast<std::uint64_t>(grid.columns) *
                                           static_cast<std::uint64_t>(grid.rows)));
  const auto outlined = outlined_layers(request);
  for (std::size_t i = 0; i < outlined.size(); ++i) {
    progress.begin_stage(
        0.05 + 0.4 * static_cast<double>(i) / static_cast<double>(outlined.size()),
        0.05 + 0.4 * static_cast<double>(i + 1) / static_cast<double>(outlined.size()));
    auto found =
        STRATA_TRY(areas_of(store, request, drawing, area, request.layers[outlined[i]], progress));
    vectors.areas.push_back(std::move(found));
  }
  const Camera camera = figure::camera_of(drawing);
  for (const Layer& layer : request.layers) {
    if (!layer.table) continue;
    auto found = STRATA_TRY(marks_of(store, request, camera, area, layer, progress));
    vectors.marks.push_back(std::move(found));
  }
  return vectors;
}

}  // namespace strata::app
