#include "app/figures/plane_view.h"

#include <algorithm>
#include <cstring>

#include "app/figures/figure_legend.h"
#include "app/figures/record_labels.h"
#include "app/reports/report_words.h"
#include "domain/scene/compass.h"
#include "mesh/surface/geometry.h"
#include "room/pictures.h"
#include "room/surface.h"

namespace strata::app {
namespace {

constexpr double kMmPerMetre = 1000;

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

}  // namespace

Result<std::unique_ptr<PlaneView>> PlaneView::make(const Services& services, ByteBudget& budget,
                                                   const FigureRequest& request) {
  const auto geometry = request.room->surface().geometry();
  const auto extent =
      request.hidden_parts.none()
          ? figure::extent_of(geometry->positions, request.plane, request.section)
          : figure::extent_of(mesh::positions_without(*geometry, request.hidden_parts),
                              request.plane, request.section);
  if (!extent && request.hidden_parts.any())
    return fail(ErrorCode::invalid, "Nothing to draw",
                "The hidden parts and the section remove the whole model from the figure. Show "
                "more parts, or move the planes of the section.",
                "camera.hidden_parts");
  if (!extent)
    return fail(ErrorCode::invalid, "Nothing to draw",
                "The section removes the whole model from the figure. Move or remove its planes.",
                "camera.section");
  return std::unique_ptr<PlaneView>(new PlaneView(services, budget, request, *extent));
}

PlaneView::PlaneView(const Services& services, ByteBudget& budget, const FigureRequest& request,
                     const figure::Extent& extent)
    : services_(services), budget_(budget), request_(request) {
  const Model model = request.room->model();
  const glm::dvec2 min(extent.min), max(extent.max);
  drawing_.plane = request.plane;
  drawing_.center =
      request.center ? glm::dvec2(request.plane.of(*request.center)) : (min + max) / 2.0;
  size_ = request.center
              ? 2.0 * glm::max(glm::abs(max - drawing_.center), glm::abs(drawing_.center - min))
              : max - min;
  const double depth = std::max(extent.max.z - extent.min.z,
                                1e-3 * glm::length(model.bounds_max - model.bounds_min));
  drawing_.near = extent.min.z - 0.01 * depth;
  drawing_.far = extent.max.z + 0.01 * depth;
  drawing_.metres_per_unit = model.metres();
  drawing_.dpi = request.dpi;
  drawing_.section = request.section;
  drawing_.hidden_parts = request.hidden_parts;
}

figure::ViewSize PlaneView::size() const {
  return {size_ * (drawing_.metres_per_unit * kMmPerMetre), {}, request_.scale};
}

void PlaneView::place(const figure::ViewPlace& place) {
  place_ = place;
  drawing_.scale = place.scale;
  drawing_.width = place.width;
  drawing_.height = place.height;
}

Result<std::vector<query::SeenLayer>> PlaneView::seen_layers(Progress&) const {
  return layers_in(services_.store, request_, drawing_);
}

Result<std::vector<figure::Label>> PlaneView::labels() const {
  return record_labels(services_.store, request_, drawing_, place_.box.size);
}

std::vector<figure::Dimension> PlaneView::dimensions() const {
  const ReportWords& words = words_in(ReportLanguage::en);
  const double mm_per_unit = drawing_.metres_per_unit * kMmPerMetre / drawing_.scale;
  const auto on_sheet = [&](const glm::dvec3& world) {
    const glm::dvec2 apart = glm::dvec2(drawing_.plane.of(world)) - drawing_.center;
    return place_.box.corner + place_.box.size / 2.0 + mm_per_unit * glm::dvec2(apart.x, -apart.y);
  };
  std::vector<figure::DimensionPoints> points;
  for (const auto& wanted : request_.dimensions) {
    figure::DimensionPoints& each = points.emplace_back(
        figure::DimensionPoints{on_sheet(wanted.from), on_sheet(wanted.to), wanted.direction});
    each.text = length_in(words, figure::measured_mm(each) * drawing_.scale / kMmPerMetre);
  }
  return figure::place_dimensions(points, place_.box);
}

Result<FigureVectors> PlaneView::vectors(const Stage& stage, Progress& progress) const {
  return figure_vectors(services_.store, budget_, request_, drawing_, place_.box, stage, progress);
}

Result<ViewContent> PlaneView::content(const Stage& stage, Progress& progress) const {
  ViewContent content;
  content.north = north_on(request_.plane, request_.room->model());
  auto labels = STRATA_TRY(this->labels());
  content.labels = std::move(labels);
  if (request_.outline_tolerance_mm) {
    auto found = STRATA_TRY(vectors(stage, progress));
    for (figure::LayerVectors& layer : found.areas)
      content.below.push_back(figure::area_group(std::move(layer), place_.box));
    for (figure::LayerVectors& layer : found.marks)
      content.below.push_back(figure::mark_group(std::move(layer), place_.box));
    content.held = std::move(found.held);
  }
  if (const auto placed = dimensions(); !placed.empty())
    content.below.push_back(figure::dimension_group(placed, place_.box));
  return content;
}

Result<void> PlaneView::draw(Picture& sheet, Progress& progress) const {
  const auto parts = figure::parts_of(drawing_);
  std::vector<room::PicturePart> picture_parts;
  for (const auto& part : parts)
    picture_parts.push_back(
        {part.camera, static_cast<double>(part.width + 2 * part.margin) / part.camera.width});
  room::PictureRequest shown = request_.shown;
  shown.samples = samples_of(drawing_.dpi);
  shown.on_floor = false;  // a drawing shows only the object
  if (request_.outline_tolerance_mm) {
    shown.marks = false;
    for (const std::size_t i : outlined_layers(request_))
      std::erase(*shown.layers, to_string(request_.layers[i].id));
  }
  return request_.room->pictures().draw(
      shown, picture_parts, [&](std::size_t i, const room::PictureBand& band) -> Result<void> {
        const figure::Part& part = parts[i];
        const auto columns = static_cast<std::size_t>(std::min(part.width, place_.width - part.x));
        const std::size_t stride = std::size_t{4} * static_cast<std::size_t>(band.width);
        for (int row = 0; row < band.rows; ++row) {
          const int inner = band.top + row - part.margin;  // row in the part
          const int y = part.y + inner;
          if (inner < 0) continue;
          if (inner >= part.height || y >= place_.height) break;
          const std::uint8_t* from = band.rgba.data() + stride * static_cast<std::size_t>(row) +
                                     std::size_t{4} * static_cast<std::size_t>(part.margin);
          const std::size_t to =
              static_cast<std::size_t>(place_.y + y) * static_cast<std::size_t>(sheet.width) +
              static_cast<std::size_t>(place_.x + part.x);
          std::memcpy(sheet.rgba.data() + 4 * to, from, 4 * columns);
        }
        if (band.top + band.rows == band.height)
          progress.report(
              static_cast<double>(i + 1) / static_cast<double>(parts.size()),
              "Drawing part " + std::to_string(i + 1) + " of " + std::to_string(parts.size()));
        if (progress.cancelled()) return cancelled_problem();
        return {};
      });
}

}  // namespace strata::app
