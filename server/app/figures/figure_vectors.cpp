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
constexpr std::uint64_t kBytesOfPoint = 2 * sizeof(glm::dvec2);  // of vectors and their patterns
// As in the image, a line is tested at these distances, and short hidden parts are drawn.
constexpr double kMarkStep_mm = 0.5;
constexpr int kClosedSteps = 3;
// In PDF and SVG, the outlines continue beyond the drawing by this length, so that areas that
// continue have no border at its edge. The writers clip them.
constexpr double kOverlap_mm = 2 * figure::kBorder;

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

// Returns the names of records or classes, in the order of `values`.
Result<std::vector<std::string>> names_of(store::Store& store, const FigureRequest& request,
                                          const Layer& layer, const std::vector<double>& values) {
  std::optional<std::int64_t> at;
  if (layer.table) {
    auto then = STRATA_TRY(table_sequence(store, request, layer));
    at = then;
  }
  Layer with_palette = layer;  // labels come from the palette of the view
  with_palette.palette = palette_of(request, layer);
  return class_names(store, with_palette, request.role, values, at, request.language);
}

Result<void> name_classes(store::Store& store, const FigureRequest& request, const Layer& layer,
                          const Palette& palette, std::vector<figure::ClassArea>& areas) {
  if (!layer.table && palette.mode == PaletteMode::step) {
    for (figure::ClassArea& area : areas)
      if (area.name.empty()) area.name = csv_number(area.value, ',');
    return {};
  }
  std::vector<double> values;
  for (const figure::ClassArea& area : areas) values.push_back(area.value);
  auto names = STRATA_TRY(names_of(store, request, layer, values));
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
                                    const figure::Box& area, const Grid& grid, const Layer& layer,
                                    Classes& classes, Progress& progress) {
  figure::LabelGrid found{grid.columns, grid.rows, {}};
  found.labels.reserve(static_cast<std::size_t>(grid.columns) *
                       static_cast<std::size_t>(grid.rows));
  const int step = std::max(1, static_cast<int>(kCellsOfBand / grid.columns));
  for (int row = 0; row < grid.rows; row += step) {
    if (progress.cancelled()) return cancelled_problem();
    const int rows = std::min(step, grid.rows - row);
    const Camera camera =
        figure::camera_over(drawing, area.corner + glm::dvec2(0, row * grid.cell_mm.y),
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
                                      const figure::Drawing& drawing, const glm::dvec2& corner,
                                      const figure::Box& area, const Grid& grid, const Layer& layer,
                                      Progress& progress) {
  const auto palette = STRATA_TRY(colors_of(store, request, layer));
  Classes classes(layer, *palette);
  auto labels = STRATA_TRY(labels_on(request, drawing, area, grid, layer, classes, progress));
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
        for (glm::dvec2& point : ring) point = corner + area.corner + point * grid.cell_mm;
    // The scale of the drawing, as the shader uses it.
    of_class.spacing_mm = figure::pattern_spacing(of_class.spacing_mm / drawing.scale);
    vectors.areas.push_back(std::move(of_class));
  }
  std::ranges::sort(vectors.areas, {}, &figure::ClassArea::value);
  return vectors;
}

using OnSheet = std::function<glm::dvec2(const glm::dvec3&)>;

// Collects the visible parts of a line. Parts have the corners of the line and their own ends as
// points.
class VisibleParts {
 public:
  explicit VisibleParts(std::vector<std::vector<glm::dvec2>>& parts) : parts_(parts) {}

  // Adds the next place of the line. A hidden piece of a few places does not divide the line.
  void add(const glm::dvec2& place, bool is_seen, bool is_corner) {
    if (!is_seen) {
      if (++hidden_ > kClosedSteps) end();
      if (is_corner && !points_.empty()) waiting_.push_back(place);
      return;
    }
    hidden_ = 0;
    points_.insert(points_.end(), waiting_.begin(), waiting_.end());
    waiting_.clear();
    if (is_corner || points_.empty()) points_.push_back(place);
    last_ = place;
  }
  void end() {
    if (!points_.empty() && points_.back() != last_) points_.push_back(last_);
    if (points_.size() > 1) parts_.push_back(std::move(points_));
    points_.clear();
    waiting_.clear();
    hidden_ = 0;
  }

 private:
  std::vector<std::vector<glm::dvec2>>& parts_;
  std::vector<glm::dvec2> points_, waiting_;  // corners after the last visible place wait
  glm::dvec2 last_{0};                        // the last visible place
  int hidden_ = 0;                            // number of places since then
};

// Returns the parts of a line or the point that the drawing shows.
Result<std::vector<std::vector<glm::dvec2>>> visible_parts(const MarkSight& sight,
                                                           const std::vector<glm::dvec3>& places,
                                                           const OnSheet& on_sheet,
                                                           const Progress& progress) {
  std::vector<std::vector<glm::dvec2>> parts;
  const double reach = sight.reach_of(places);
  if (places.size() == 1) {
    if (!sight.part_in_drawing(places[0], places[0])) return parts;
    const bool is_seen = STRATA_TRY(sight.sees(places[0], reach));
    if (is_seen) parts.push_back({on_sheet(places[0])});
    return parts;
  }
  VisibleParts line(parts);
  for (std::size_t i = 1; i < places.size(); ++i) {
    if (progress.cancelled()) return cancelled_problem();
    const glm::dvec3 &from = places[i - 1], &to = places[i];
    const auto part = sight.part_in_drawing(from, to);
    if (!part || part->first > 0) line.end();
    if (!part) continue;
    const auto [begin, end] = *part;
    const double length = glm::distance(on_sheet(from), on_sheet(to)) * (end - begin);
    const int steps = std::max(1, static_cast<int>(std::ceil(length / kMarkStep_mm)));
    // The previous segment has already added a common corner.
    for (int step = i > 1 && begin == 0 ? 1 : 0; step <= steps; ++step) {
      const double t =
          step == steps ? end : std::lerp(begin, end, static_cast<double>(step) / steps);
      const glm::dvec3 place = glm::mix(from, to, t);
      const bool is_seen = STRATA_TRY(sight.sees(place, reach));
      line.add(on_sheet(place), is_seen, t == 0 || t == 1);
    }
    if (end < 1) line.end();
  }
  line.end();
  return parts;
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
  std::vector<double> keys;  // of the visible features
  for (const KeyFeature& feature : features) {
    if (progress.cancelled()) return cancelled_problem();
    const Rgba color = color_of(*palette, static_cast<double>(feature.key));
    if (color[3] == 0) continue;
    auto parts = STRATA_TRY(visible_parts(sight, feature.feature.places, on_sheet, progress));
    if (!parts.empty()) keys.push_back(static_cast<double>(feature.key));
    for (auto& part : parts) vectors.marks.push_back({feature.key, {}, color, std::move(part)});
  }
  const auto names = STRATA_TRY(names_of(store, request, layer, keys));
  std::size_t feature = 0;
  for (figure::RecordMark& mark : vectors.marks) {
    while (keys[feature] != static_cast<double>(mark.key)) ++feature;
    mark.name = names[feature];
  }
  return vectors;
}

std::uint64_t points_of(const FigureVectors& vectors) {
  std::uint64_t points = 0;
  for (const figure::LayerVectors& layer : vectors.areas)
    for (const figure::ClassArea& area : layer.areas)
      for (const figure::OutlinePolygon& polygon : area.polygons)
        for (const figure::OutlineRing& ring : polygon.rings) points += ring.size();
  for (const figure::LayerVectors& layer : vectors.marks)
    for (const figure::RecordMark& mark : layer.marks) points += mark.points.size();
  return points;
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
                                     const figure::Box& area, const Stage& stage,
                                     Progress& progress) {
  FigureVectors vectors;
  // From the drawing's top left.
  const glm::dvec2 overlap(request.format == figure::Format::dxf ? 0 : kOverlap_mm);
  const figure::Box outlined_area{-overlap, area.size + 2.0 * overlap};
  const Grid grid = grid_over(outlined_area.size, *request.outline_tolerance_mm);
  const auto held = STRATA_TRY(budget.take(kBytesOfCell * static_cast<std::uint64_t>(grid.columns) *
                                           static_cast<std::uint64_t>(grid.rows)));
  const auto outlined = outlined_layers(request);
  for (std::size_t i = 0; i < outlined.size(); ++i) {
    const Stage of_layer = stage.part(i, outlined.size());
    progress.begin_stage(of_layer.from, of_layer.to);
    auto found = STRATA_TRY(areas_of(store, request, drawing, area.corner, outlined_area, grid,
                                     request.layers[outlined[i]], progress));
    vectors.areas.push_back(std::move(found));
  }
  const Camera camera = figure::camera_of(drawing);
  for (const Layer& layer : request.layers) {
    if (!layer.table) continue;
    auto found = STRATA_TRY(marks_of(store, request, camera, area, layer, progress));
    vectors.marks.push_back(std::move(found));
  }
  auto kept = STRATA_TRY(budget.take(kBytesOfPoint * points_of(vectors)));
  vectors.held = std::move(kept);
  return vectors;
}

}  // namespace strata::app
