#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "render/renderer.h"
#include "render/view/depth_buffers.h"
#include "render/view/feature_pass.h"

namespace strata::render {

// The state of a view between frames: the g-buffer of its camera and its last frame, which partial
// frames update. A view without buffers is new or was evicted. An evicted view keeps the
// description of its last frame, so later partial frames are drawn into buffers that all such views
// share (GpuScene::take_shared_buffers).
struct View {
  ModelHandle model = 0;
  bool drawing = false;  // a frame is in progress, so it must not be evicted
  std::uint64_t last_used = 0;
  std::optional<std::chrono::steady_clock::time_point> acted;  // last frame of an acting user

  DepthKey key;
  std::vector<SurfaceImageStyle> images;  // images in the g-buffer
  Light lighting;
  bool gbuffer_complete = false;
  std::shared_ptr<DepthBuffer> depth;
  gl::Texture uv, light, picture;
  gl::Framebuffer gbuffer;
  gl::Framebuffer shading;  // renders to `picture` with the g-buffer's depth
  GpuMemory::Share share;

  bool picture_complete = false;
  // The requester has the frame that the members below and `key` describe, except for later changes
  // on the surface.
  bool returned = false;
  std::vector<LayerStyle> layers;  // layers in `picture`
  Background background;
  glm::vec2 background_rows{0, 1};
  double unit_mm = 0;
  FeaturesShown features;
  std::shared_ptr<const mesh::ContactShadow> contact_shadow;
  FeatureBuffer seen_features;  // the marks, tested with the g-buffer's camera

  bool has_buffers() const { return static_cast<bool>(picture); }
  bool has_buffers_of(int width, int height) const {
    return has_buffers() && picture.width() == width && picture.height() == height;
  }
  static std::uint64_t bytes_of_buffers(int width, int height);
  void drop_buffers();  // also drops many marks
  bool has_style(const FrameRequest& request) const;
  // Returns whether `picture` shows this request, except for changes on the surface.
  bool shows(const FrameRequest& request) const { return picture_complete && has_style(request); }
};

// Prepares the buffers of `view` for the size and the camera of `key`. If an edit uses the depth
// buffer, the view gets a new one.
Result<void> prepare_gbuffer(View& view, const DepthKey& key, DepthBuffers& depths,
                             GpuMemory& memory);

}  // namespace strata::render
