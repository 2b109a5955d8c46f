#include "room/pipeline/seen_texels.h"

#include <glm/gtc/matrix_transform.hpp>

#include "room/caches/await.h"

namespace strata::room {
namespace {

constexpr double kMargin_px = 1;  // rounding must not cut off texels at the border of the box

// Returns a stroke of a square brush that covers exactly a box. The square is as wide as the
// shorter side of the box, and its path is parallel to the longer side.
StrokeBatch box_stroke(const Camera& camera, const glm::dvec2& low, const glm::dvec2& high) {
  const glm::dvec2 window(camera.width, camera.height);
  const glm::dvec2 from = glm::clamp(low - kMargin_px, glm::dvec2(-kMargin_px), window);
  const glm::dvec2 to = glm::clamp(high + kMargin_px, glm::dvec2(0), window + kMargin_px);
  const glm::dvec2 extent = glm::max(to - from, glm::dvec2(kMargin_px));
  StrokeBatch stroke;
  stroke.camera = camera;
  stroke.shape = ToolShape::square;
  stroke.radius_px = std::min(extent.x, extent.y) / 2;
  stroke.path = {from + stroke.radius_px, from + extent - stroke.radius_px};
  return stroke;
}

}  // namespace

Result<TileMasks> seen_texels(render::Renderer& renderer, render::ModelHandle model, int resolution,
                              const Camera& camera, const glm::dvec2& low, const glm::dvec2& high,
                              bool through) {
  // An erasure on an empty layer changes nothing and needs no page, but its result still contains
  // the covered texels.
  auto scratch = STRATA_TRY(await<render::LayerHandle>(
      [&](auto done) { renderer.add_layer(model, ValueType::u8, resolution, std::move(done)); }));
  StrokeBatch stroke = box_stroke(camera, low, high);
  stroke.erase = true;
  stroke.through = through;
  const auto outcome = await<render::StrokeOutcome>(
      [&](auto done) { renderer.paint(scratch, std::move(stroke), std::move(done)); });
  renderer.remove_layer(scratch);
  if (!outcome) return tl::unexpected(outcome.error());
  TileMasks seen;
  for (const render::WrittenTile& tile : outcome->tiles) seen[tile.address] = tile.written;
  return seen;
}

WindowProjection::WindowProjection(const Camera& camera, const glm::dvec3& origin)
    : clip_from_model_(camera.projection * camera.view * glm::translate(glm::dmat4(1.0), origin)),
      half_window_(camera.width / 2.0, camera.height / 2.0) {}

glm::dvec2 WindowProjection::operator()(const glm::vec3& position) const {
  const glm::dvec4 clip = clip_from_model_ * glm::dvec4(position, 1);
  return half_window_ + half_window_ * glm::dvec2(clip.x, -clip.y) / clip.w;
}

}  // namespace strata::room
