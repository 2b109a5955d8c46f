#include "app/figures/figures.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "app/figures/figure_file.h"
#include "app/figures/figure_legend.h"
#include "app/figures/figure_vectors.h"
#include "domain/scene/compass.h"
#include "mesh/surface/geometry.h"
#include "room/pictures.h"
#include "room/surface.h"
#include "store/tables/records.h"

namespace strata::app {
namespace {

constexpr glm::dvec2 kLabelCell_mm{1.5, 1.5};
constexpr std::size_t kMaxPlaces = 64;  // tested positions per label
constexpr std::size_t kMaxLabels = 2000;

// The grid cells in which a key is visible. The cells farthest from other keys come first.
struct Area {
  std::size_t cells = 0;
  std::vector<std::pair<int, int>> places;  // distance to the border of the area, and the cell
};
std::map<std::uint32_t, Area> areas_of(const std::vector<std::optional<std::uint32_t>>& keys,
                                       int columns, int rows) {
  // Computes the chessboard distance in two passes over the grid. The area outside the grid is
  // treated as another key.
  std::vector<int> inside(keys.size(), 0);
  const auto at = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(x);
  };
  const auto pass = [&](int x, int y, int step) {
    int least = std::max(columns, rows);
    for (const auto& [dx, dy] : {std::pair{-step, 0}, {0, -step}, {-step, -step}, {step, -step}}) {
      const int nx = x + dx, ny = y + dy;
      const bool same =
          nx >= 0 && ny >= 0 && nx < columns && ny < rows && keys[at(nx, ny)] == keys[at(x, y)];
      least = std::min(least, same ? inside[at(nx, ny)] + 1 : 1);
    }
    return least;
  };
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) inside[at(x, y)] = pass(x, y, 1);
  std::map<std::uint32_t, Area> areas;
  for (int y = rows - 1; y >= 0; --y)
    for (int x = columns - 1; x >= 0; --x) {
      const std::size_t cell = at(x, y);
      inside[cell] = std::min(inside[cell], pass(x, y, -1));
      if (!keys[cell]) continue;
      Area& area = areas[*keys[cell]];
      ++area.cells;
      area.places.emplace_back(inside[cell], static_cast<int>(cell));
    }
  return areas;
}

Result<std::map<std::uint32_t, std::string>> texts_of(store::Store& store,
                                                      const FigureRequest& request) {
  const Column& column = request.labels->column;
  const auto found = store.records().texts(*request.labels->layer.table, request.role, column.slug,
                                           "labels.column");
  if (!found) return tl::unexpected(found.error());
  std::map<std::uint32_t, std::string> texts;
  std::map<std::string, std::string> terms;  // labels of terms, by key
  if (column.kind == ColumnKind::term && column.target) {
    const auto labels =
        store.records().texts(*column.target, request.role, "label", "labels.column");
    if (!labels) return tl::unexpected(labels.error());
    for (const auto& [key, text] : *labels) terms[std::to_string(key)] = text;
  }
  for (const auto& [key, text] : *found) {
    const auto term = terms.find(text);
    std::string words = term == terms.end() ? text : term->second;
    if (!column.unit.empty()) words += " " + column.unit;
    texts[static_cast<std::uint32_t>(key)] = std::move(words);
  }
  return texts;
}

Result<std::vector<figure::Label>> labels_of(store::Store& store, const FigureRequest& request,
                                             const figure::Drawing& drawing,
                                             const glm::dvec2& drawing_mm) {
  if (!request.labels) return std::vector<figure::Label>{};
  const int columns = std::max(1, static_cast<int>(drawing_mm.x / kLabelCell_mm.x));
  const int rows = std::max(1, static_cast<int>(drawing_mm.y / kLabelCell_mm.y));
  const glm::dvec2 cell_mm = drawing_mm / glm::dvec2(columns, rows);
  const auto keys = request.room->pictures().seen_keys(
      request.labels->layer.slug, figure::camera_of(drawing), columns, rows, request.shown.at);
  if (!keys) return tl::unexpected(keys.error());
  const auto texts = STRATA_TRY(texts_of(store, request));
  auto areas = areas_of(*keys, columns, rows);
  std::vector<std::pair<std::size_t, std::uint32_t>> by_size;
  for (const auto& [key, area] : areas)
    if (texts.contains(key)) by_size.emplace_back(area.cells, key);
  std::ranges::sort(by_size, std::greater());
  if (by_size.size() > kMaxLabels) by_size.resize(kMaxLabels);
  std::vector<figure::LabelRequest> requests;
  for (const auto& [size, key] : by_size) {
    auto& places = areas[key].places;
    const std::size_t tried = std::min(places.size(), kMaxPlaces);
    std::partial_sort(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(tried),
                      places.end(), [](const auto& a, const auto& b) {
                        return a.first != b.first ? a.first > b.first : a.second < b.second;
                      });
    figure::LabelRequest label{texts.at(key), {}};
    for (std::size_t i = 0; i < tried; ++i)
      label.places.push_back(
          (glm::dvec2(places[i].second % columns, places[i].second / columns) + 0.5) * cell_mm);
    requests.push_back(std::move(label));
  }
  return figure::place_labels(requests, drawing_mm);
}

// Returns the direction of true north on the paper. Returns nothing if the angle between north and
// the paper is too large.
std::optional<glm::dvec2> north_on(const figure::Plane& plane, const Model& model) {
  const Compass compass(model);
  if (!compass.is_known) return std::nullopt;
  const glm::dvec3 drawn = plane.of(compass.true_north());
  const glm::dvec2 flat(drawn.x, -drawn.y);
  constexpr double kFlattest = 0.7;
  if (glm::length(flat) < kFlattest) return std::nullopt;
  return glm::normalize(flat);
}

// Uses fewer samples per pixel for a higher resolution because more than 1200 samples per inch are
// not visible on paper.
int samples_of(int dpi) {
  constexpr int kSamplesPerInch = 1200, kMin = 4, kMax = 16;
  return std::clamp(kSamplesPerInch * kSamplesPerInch / (dpi * dpi), kMin, kMax);
}

// Draws the layers and marks that are not vectors.
Result<Picture> draw(const FigureRequest& request, const figure::Drawing& drawing,
                     Progress& progress) {
  Picture picture{drawing.width, drawing.height, {}};
  picture.rgba.resize(std::size_t{4} * picture.width * picture.height);
  const auto parts = figure::parts_of(drawing);
  std::vector<room::PicturePart> picture_parts;
  for (const auto& part : parts)
    picture_parts.push_back(
        {part.camera, static_cast<double>(part.width + 2 * part.margin) / part.camera.width});
  room::PictureRequest shown = request.shown;
  shown.samples = samples_of(drawing.dpi);
  shown.on_floor = false;  // a drawing shows only the object
  if (request.outline_tolerance_mm) {
    shown.marks = false;
    for (const std::size_t i : outlined_layers(request))
      std::erase(*shown.layers, to_string(request.layers[i].id));
  }
  auto drawn = request.room->pictures().draw(
      shown, picture_parts, [&](std::size_t i, const room::PictureBand& band) -> Result<void> {
        const figure::Part& part = parts[i];
        const auto columns = static_cast<std::size_t>(std::min(part.width, picture.width - part.x));
        const std::size_t stride = std::size_t{4} * static_cast<std::size_t>(band.width);
        for (int row = 0; row < band.rows; ++row) {
          const int inner = band.top + row - part.margin;  // row in the part
          const int y = part.y + inner;
          if (inner < 0) continue;
          if (inner >= part.height || y >= picture.height) break;
          const std::uint8_t* from = band.rgba.data() + stride * static_cast<std::size_t>(row) +
                                     std::size_t{4} * static_cast<std::size_t>(part.margin);
          const std::size_t to =
              static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
              static_cast<std::size_t>(part.x);
          std::memcpy(picture.rgba.data() + 4 * to, from, 4 * columns);
        }
        if (band.top + band.rows == band.height)
          progress.report(
              static_cast<double>(i + 1) / static_cast<double>(parts.size()),
              "Drawing part " + std::to_string(i + 1) + " of " + std::to_string(parts.size()));
        if (progress.cancelled()) return cancelled_problem();
        return {};
      });
  if (!drawn) return tl::unexpected(drawn.error());
  return picture;
}

}  // namespace

Result<std::shared_ptr<const TemporaryFile>> make_figure(store::Store& store, ByteBudget& budget,
                                                         const FigureRequest& request,
                                                         const std::filesystem::path& folder,
                                                         Progress& progress) {
  progress.begin_stage(0, 0.05);
  progress.report(0, "Measuring");
  const Model model = request.room->model();
  const auto geometry = request.room->surface().geometry();
  const auto extent = figure::extent_of(geometry->positions, request.plane, request.section);
  if (!extent)
    return fail(ErrorCode::invalid, "Nothing to draw",
                "The section removes the whole model from the figure. Move or remove its planes.",
                "camera.section");
  const glm::dvec2 size =
      request.center
          ? 2.0 * glm::max(glm::abs(glm::dvec2(extent->max - request.plane.of(*request.center))),
                           glm::abs(glm::dvec2(request.plane.of(*request.center) - extent->min)))
          : glm::dvec2(extent->max - extent->min);
  const auto drawing_on = [&](const ChosenSheet& composed) {
    figure::Drawing drawing;
    drawing.plane = request.plane;
    drawing.center = request.center ? glm::dvec2(request.plane.of(*request.center))
                                    : glm::dvec2(extent->min + extent->max) / 2.0;
    const double depth = std::max(extent->max.z - extent->min.z,
                                  1e-3 * glm::length(model.bounds_max - model.bounds_min));
    drawing.near = extent->min.z - 0.01 * depth;
    drawing.far = extent->max.z + 0.01 * depth;
    drawing.scale = composed.scale;
    drawing.metres_per_unit = model.metres();
    drawing.dpi = request.dpi;
    drawing.width = composed.layout.drawing_width();
    drawing.height = composed.layout.drawing_height();
    drawing.section = request.section;
    return drawing;
  };
  std::vector<figure::Legend> legends;
  if (request.legend) {
    // Without a legend, the drawing is largest. The legend therefore lists the content of this
    // largest drawing.
    auto seen = STRATA_TRY(
        legends_of(store, request, drawing_on(choose_sheet(request, {}, size, model.metres()))));
    legends = std::move(seen);
  }
  const ChosenSheet composed = choose_sheet(request, legends, size, model.metres());
  const figure::SheetLayout& layout = composed.layout;
  const figure::Drawing drawing = drawing_on(composed);

  const auto labels = STRATA_TRY(labels_of(store, request, drawing, layout.drawing_mm()));
  FigureVectors vectors;
  if (request.outline_tolerance_mm) {
    auto found =
        STRATA_TRY(figure_vectors(store, budget, request, drawing, layout.drawing(), progress));
    vectors = std::move(found);
  }
  if (request.format == figure::Format::dxf) {
    const auto is_empty = [](const figure::LayerVectors& layer) {
      return layer.areas.empty() && layer.marks.empty();
    };
    if (std::ranges::all_of(vectors.areas, is_empty) &&
        std::ranges::all_of(vectors.marks, is_empty) && labels.empty())
      return fail(ErrorCode::invalid, "Nothing to draw",
                  "A DXF file contains only classes and records, and the drawing has none. Show a "
                  "layer with classes or records, or choose another format.",
                  "format");
    const double mm_per_unit = model.metres() * 1000;
    const glm::dvec2 half_mm = layout.drawing_mm() * (drawing.scale / 2);
    const figure::DxfDrawing dxf{std::move(vectors.areas),
                                 std::move(vectors.marks),
                                 labels,
                                 layout.drawing(),
                                 drawing.scale,
                                 drawing.center * mm_per_unit + glm::dvec2(-half_mm.x, half_mm.y)};
    return write_dxf_file(request, dxf, folder, progress);
  }
  const auto held = STRATA_TRY(budget.take(std::uint64_t{4} * drawing.width * drawing.height));
  progress.begin_stage(request.outline_tolerance_mm ? 0.45 : 0.05, 0.75);
  const auto picture = STRATA_TRY(draw(request, drawing, progress));
  progress.begin_stage(0.75, 1);
  auto sheet = layout.finish(drawing.scale, north_on(request.plane, model), labels);
  std::vector<figure::Group> groups;  // below all others
  for (figure::LayerVectors& layer : vectors.areas)
    groups.push_back(figure::area_group(std::move(layer)));
  for (figure::LayerVectors& layer : vectors.marks)
    groups.push_back(figure::mark_group(std::move(layer)));
  sheet.groups.insert(sheet.groups.begin(), std::make_move_iterator(groups.begin()),
                      std::make_move_iterator(groups.end()));
  return write_figure_file(request, sheet, picture, drawing.scale, folder, progress);
}

}  // namespace strata::app
