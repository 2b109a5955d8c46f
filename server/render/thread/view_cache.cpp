#include "render/thread/view_cache.h"

#include <algorithm>

namespace strata::render {
namespace {

constexpr std::size_t kMostBytesOfMarksKept = 64 * 1024;

}  // namespace

std::uint64_t View::bytes_of_buffers(int width, int height) {
  constexpr std::uint64_t kBytesPerPixel = 16;  // texture coordinates, light, frame, depth
  return kBytesPerPixel * static_cast<unsigned>(width) * static_cast<unsigned>(height);
}

// Keeps few marks, because partial frames need them. Many marks take as much memory as the buffers,
// and the memory ledger does not contain them. Without them, the next frame is a whole one.
void View::drop_buffers() {
  if (seen_features.segments.buffer().size() > kMostBytesOfMarksKept) {
    seen_features = {};
    returned = false;
  }
  gbuffer = {};
  shading = {};
  uv = {};
  light = {};
  picture = {};
  depth.reset();
  share.reset();
  gbuffer_complete = picture_complete = false;
}

bool View::has_style(const FrameRequest& request) const {
  return unit_mm == request.style.unit_mm && background == request.style.background &&
         background_rows == request.background_rows && layers == request.style.layers &&
         features == request.style.features && contact_shadow == request.style.contact_shadow;
}

Result<void> prepare_gbuffer(View& view, const DepthKey& key, DepthBuffers& depths,
                             GpuMemory& memory) {
  view.gbuffer_complete = view.picture_complete = view.returned = false;
  if (view.has_buffers() && !view.has_buffers_of(key.width, key.height)) view.drop_buffers();
  if (!view.has_buffers()) {
    const auto pixels = static_cast<std::uint64_t>(key.width) * static_cast<unsigned>(key.height);
    auto share = STRATA_TRY(memory.reserve(pixels * 12, "a view"));
    auto uv = STRATA_TRY(gl::Texture::create_2d(GL_R32UI, key.width, key.height, "view uv"));
    auto light = STRATA_TRY(gl::Texture::create_2d(GL_RGBA8, key.width, key.height, "view light"));
    auto picture =
        STRATA_TRY(gl::Texture::create_2d(GL_RGBA8, key.width, key.height, "view picture"));
    view.uv = std::move(uv);
    view.light = std::move(light);
    view.picture = std::move(picture);
    view.share = std::move(share);
  }
  if (!view.depth || view.depth.use_count() > 1) {
    auto depth = STRATA_TRY(depths.make(key));
    auto gbuffer =
        gl::Framebuffer::create({&view.uv, &view.light}, &depth->texture, "view g-buffer");
    if (!gbuffer) return tl::unexpected(gbuffer.error());
    auto shading = gl::Framebuffer::create({&view.picture}, &depth->texture, "view shading");
    if (!shading) return tl::unexpected(shading.error());
    view.depth = std::move(depth);
    view.gbuffer = std::move(*gbuffer);
    view.shading = std::move(*shading);
  }
  view.depth->start(key);
  view.key = key;
  depths.offer(view.depth);
  return {};
}

}  // namespace strata::render
