#include "render/thread/paint_job.h"

#include <cmath>

#include "render/edit/compute_painter.h"
#include "render/edit/kernel_painter.h"

namespace strata::render {
namespace {

std::uint32_t bits_of_width(std::uint32_t bits, int bytes) {
  return bytes == 4 ? bits : bits & ((1u << (bytes * 8)) - 1u);
}

}  // namespace

Result<void> validate(const StrokeBatch& stroke) {
  STRATA_TRY(validate(stroke.camera));
  if (stroke.path.empty() || stroke.path.size() > kMaxPathPoints) {
    return fail(ErrorCode::invalid, "Path length out of range",
                "A stroke must have 1 to " + std::to_string(kMaxPathPoints) +
                    " points. Send a longer stroke in parts.",
                "path");
  }
  for (const auto& point : stroke.path) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) {
      return fail(ErrorCode::invalid, "Path not finite",
                  "Every coordinate of the path must be a finite number.", "path");
    }
  }
  if (!stroke.widths.empty() && stroke.widths.size() != stroke.path.size())
    return fail(ErrorCode::invalid, "Wrong number of widths",
                "Send one width for each point of the path, or no widths.", "widths");
  for (const double width : stroke.widths)
    if (!(width > 0 && width <= 1))
      return fail(ErrorCode::invalid, "Width out of range",
                  "A width is a fraction of the radius: more than 0, and at most 1.", "widths");
  const double radius = stroke.radius_px > 0 ? stroke.radius_px : stroke.radius_world;
  if (!std::isfinite(radius) || radius <= 0) {
    return fail(ErrorCode::invalid, "Radius out of range",
                "Send radius_px or radius_world as a number above 0.", "radius");
  }
  if (stroke.shape == ToolShape::texture && !stroke.texture)
    return fail(ErrorCode::invalid, "Shape missing",
                "A stroke with a custom shape needs the texture of the shape.", "shape");
  if (const auto angle = stroke.max_angle_deg) {
    if (!(*angle > 0 && *angle <= 90))
      return fail(ErrorCode::invalid, "Angle out of range",
                  "Send the largest angle in degrees: more than 0, and at most 90.",
                  "max_angle_deg");
    if (stroke.through)
      return fail(ErrorCode::invalid, "Angle for hidden surfaces",
                  "The largest angle applies only to visible surfaces. Send either `through` or "
                  "`max_angle_deg`, but not both.",
                  "max_angle_deg");
  }
  if (const auto bias = stroke.fixed_depth_bias; bias && !(*bias >= 0 && *bias <= 1)) {
    return fail(ErrorCode::invalid, "Depth bias out of range",
                "A fixed depth bias is a fraction of the depth of the window, from 0 to 1. "
                "Leave it out to let the server compute it from the surface.",
                "depth_bias");
  }
  return {};
}

Step PaintJob::step(GpuScene& scene) {
  auto found = target(scene);
  auto step = found ? advance(scene, *found) : tl::unexpected(found.error());
  if (step) return *step;
  abort(step.error());
  return Step::done;
}

Result<PaintTarget> PaintJob::target(GpuScene& scene) {
  auto layer = STRATA_TRY(scene.layer(layer_));
  auto model = STRATA_TRY(scene.model(layer->model()));
  LayerTextures& textures = layer->textures();
  const auto map = model->maps.find(textures.resolution());
  if (map == model->maps.end()) {
    return fail(ErrorCode::conflict, "Surface map missing",
                "The surface map with a resolution of " + std::to_string(textures.resolution()) +
                    " is not on the GPU yet. Try again in a moment.");
  }
  return PaintTarget{model->mesh(), *map->second, textures};
}

Result<Step> PaintJob::advance(GpuScene& scene, const PaintTarget& target) {
  switch (stage_) {
    case Stage::layer: {
      auto layer = STRATA_TRY(scene.layer(layer_));
      if (!layer_use_) layer_use_ = layer->use(scene.next_use());
      auto here = STRATA_TRY(layer->bring());
      if (!here) return Step::yield;
      stage_ = Stage::begin;
      return Step::more;
    }
    case Stage::begin:
      STRATA_TRY(begin(scene, target));
      stage_ = Stage::depth;
      return Step::more;
    case Stage::depth:
      if (depth_ && !depth_->complete) {
        auto complete =
            STRATA_TRY(scene.depths().draw_slice(depth_, target.mesh, stroke_.camera, drawn_));
        if (!complete) return Step::yield;
      }
      // The shader does not know the parts of texels.
      if (scene.edits_on_cpu() || stroke_.camera.hidden_parts.any())
        painter_ = std::make_unique<KernelPainter>(stroke_, depth_);
      else
        painter_ = std::make_unique<ComputePainter>(stroke_, depth_);
      stage_ = Stage::painting;
      return Step::more;
    case Stage::painting: {
      auto step = painter_->step(scene, target);
      if (step && *step == Step::done) finish(scene);
      return step;
    }
  }
  return Step::done;
}

Result<void> PaintJob::begin(GpuScene& scene, const PaintTarget& target) {
  STRATA_TRY(validate(stroke_));
  stroke_.value_bits = bits_of_width(stroke_.value_bits, target.layer.pool().texel_bytes());
  return find_depth(scene);
}

Result<void> PaintJob::find_depth(GpuScene& scene) {
  if (stroke_.through && stroke_.radius_px > 0) return {};
  const Camera& camera = stroke_.camera;
  const auto key = depth_key((*scene.layer(layer_))->model(), camera, camera.width, camera.height);
  depth_ = scene.depths().find(key);
  if (depth_) return {};
  auto started = STRATA_TRY(scene.depths().start(key));
  depth_ = std::move(started);
  return {};
}

void PaintJob::finish(GpuScene& scene) {
  // After a reset between dispatch and read-back, the mapped memory contains undefined data.
  if (scene.lost()) {
    abort({ErrorCode::gpu_lost,
           "GPU lost",
           "The server lost the GPU context and is restoring it, so it did not paint the "
           "stroke. Send the stroke again.",
           {}});
    return;
  }
  done_(painter_->take_outcome());
}

}  // namespace strata::render
