#include "render/memory/surface_image_texture.h"

#include <algorithm>

namespace strata::render {
namespace {

constexpr std::size_t kSliceBytes = std::size_t{4} << 20;  // ≈ 1 ms of copying
// Keeps slanted surfaces sharp. Not used with software renderers, because each sample takes time.
constexpr float kAnisotropy = 8;

}  // namespace

Result<std::unique_ptr<SurfaceImageTexture>> SurfaceImageTexture::create(
    std::shared_ptr<const MipmappedPicture> image, bool software, GpuMemory& memory) {
  auto made = std::make_unique<SurfaceImageTexture>();
  made->image_ = std::move(image);
  auto share = memory.reserve(made->image_->bytes(), "a model's picture");
  if (!share) return tl::unexpected(share.error());
  made->share_ = std::move(*share);
  const auto& finest = made->image_->levels.front();
  auto texture = gl::Texture::create_mipmapped(
      GL_RGBA8, finest.width, finest.height, static_cast<int>(made->image_->levels.size()), "look");
  if (!texture) return tl::unexpected(texture.error());
  made->texture_ = std::move(*texture);
  if (!software && epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic"))
    glTextureParameterf(made->texture_.id(), GL_TEXTURE_MAX_ANISOTROPY_EXT, kAnisotropy);
  return made;
}

bool SurfaceImageTexture::upload_slice() {
  if (!image_) return true;
  for (std::size_t room = kSliceBytes; level_ < image_->levels.size();) {
    const auto& level = image_->levels[level_];
    const std::size_t row_bytes = std::size_t{4} * static_cast<std::size_t>(level.width);
    const int rows = static_cast<int>(
        std::min<std::size_t>(room / row_bytes, static_cast<std::size_t>(level.height - row_)));
    if (rows == 0) return false;
    glTextureSubImage2D(texture_.id(), static_cast<GLint>(level_), 0, row_, level.width, rows,
                        GL_RGBA, GL_UNSIGNED_BYTE,
                        &level.rgba[row_bytes * static_cast<std::size_t>(row_)]);
    room -= row_bytes * static_cast<std::size_t>(rows);
    row_ += rows;
    if (row_ == level.height) {
      row_ = 0;
      ++level_;
    }
  }
  image_.reset();
  return true;
}

}  // namespace strata::render
