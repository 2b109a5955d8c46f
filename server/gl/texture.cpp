#include "gl/texture.h"

#include <algorithm>
#include <cassert>

#include "gl/debug_messages.h"

namespace strata::gl {

std::size_t bytes_per_texel(GLenum format) {
  switch (format) {
    case GL_R8UI:
    case GL_R8: return 1;
    case GL_R16UI: return 2;
    case GL_RGBA16:
    case GL_RG32UI: return 8;
    case GL_RGBA32F: return 16;
    default: return 4;  // R32UI, R32F, RGBA8, DEPTH_COMPONENT32F
  }
}

Result<Texture> Texture::create_2d(GLenum format, int width, int height, std::string_view label) {
  return make_2d(format, width, height, 1, label);
}

Result<Texture> Texture::create_mipmapped(GLenum format, int width, int height, int levels,
                                          std::string_view label) {
  auto texture = STRATA_TRY(make_2d(format, width, height, levels, label));
  glTextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return texture;
}

Result<Texture> Texture::make_2d(GLenum format, int width, int height, int levels,
                                 std::string_view label) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &id);
  Texture texture;
  texture.object_ = Object<Traits>(id);
  texture.format_ = format;
  texture.width_ = width;
  texture.height_ = height;
  texture.layers_ = 1;
  texture.levels_ = levels;
  glTextureStorage2D(id, levels, format, width, height);
  return finish(std::move(texture), label);
}

Result<Texture> Texture::create_array(GLenum format, int width, int height, int layers,
                                      std::string_view label) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
  Texture texture;
  texture.object_ = Object<Traits>(id);
  texture.format_ = format;
  texture.width_ = width;
  texture.height_ = height;
  texture.layers_ = layers;
  glTextureStorage3D(id, 1, format, width, height, layers);
  return finish(std::move(texture), label);
}

Result<Texture> Texture::finish(Texture texture, std::string_view label) {
  STRATA_TRY(check_memory(label, texture.bytes()));
  const GLuint id = texture.id();
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  texture.object_.label(label);
  return texture;
}

std::size_t Texture::bytes() const {
  std::size_t texels = 0;
  for (int level = 0; level < levels_; ++level) {
    texels += static_cast<std::size_t>(std::max(1, width_ >> level)) *
              static_cast<std::size_t>(std::max(1, height_ >> level)) *
              static_cast<std::size_t>(layers_);
  }
  return bytes_per_texel(format_) * texels;
}

void Texture::bind_image(GLuint unit, GLenum access) const {
  glBindImageTexture(unit, id(), 0, GL_TRUE, 0, access, format_);
}

}  // namespace strata::gl
