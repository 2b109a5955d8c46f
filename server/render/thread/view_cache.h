#pragma once

#include <memory>

#include "render/renderer.h"
#include "render/view/depth_buffers.h"
#include "render/view/feature_pass.h"

namespace strata::render {

// What a view keeps between frames: the g-buffer of its camera and its last picture, which partial
// frames add to. Without buffers (new, or evicted) it is only a name.
struct View {
  ModelHandle model = 0;
  bool drawing = false;  // a frame is under way: not to be evicted
  std::uint64_t last_used = 0;

  DepthKey key;
  std::vector<SurfaceImageStyle> images;  // of the g-buffer, as is the lighting
  Light lighting;
  bool gbuffer_complete = false;
  std::shared_ptr<DepthBuffer> depth;
  gl::Texture uv, light, picture;
  gl::Framebuffer gbuffer;
  gl::Framebuffer shading;  // the picture and the g-buffer's depth
  GpuMemory::Share share;

  bool picture_complete = false;
  std::vector<LayerStyle> layers;  // of the picture
  Background background;
  glm::vec2 background_rows{0, 1};
  double unit_mm = 0;
  FeaturesShown features;
  FeatureBuffer seen_features;  // the marks, as the camera of the g-buffer sees them

  bool has_buffers() const { return static_cast<bool>(picture); }
  void drop_buffers();
  // Whether the picture shows this request, but for what changed on the surface.
  bool shows(const FrameRequest& request) const;
};

// Makes `view`'s buffers fit the size and the camera of `key`, as new: a depth buffer that an edit
// uses is left to it.
Result<void> prepare_gbuffer(View& view, const DepthKey& key, DepthBuffers& depths,
                             GpuMemory& memory);

}  // namespace strata::render
