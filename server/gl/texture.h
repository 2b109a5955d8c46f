#pragma once

#include <cstddef>
#include <string_view>

#include "core/error.h"
#include "gl/object.h"

namespace strata::gl {

// A 2D texture or 2D texture array with immutable storage, clamped at its edges. It has either one
// level and the nearest filter (also for integer formats), or mipmaps and linear filters.
class Texture {
 public:
  Texture() = default;
  // Return the Error `out_of_memory` if the driver has no memory for the texture.
  static Result<Texture> create_2d(GLenum format, int width, int height, std::string_view label);
  static Result<Texture> create_mipmapped(GLenum format, int width, int height, int levels,
                                          std::string_view label);
  static Result<Texture> create_array(GLenum format, int width, int height, int layers,
                                      std::string_view label);

  GLuint id() const { return object_.id(); }
  explicit operator bool() const { return static_cast<bool>(object_); }
  int width() const { return width_; }
  int height() const { return height_; }
  int layers() const { return layers_; }
  GLenum format() const { return format_; }
  std::size_t bytes() const;

  void bind(GLuint unit) const { glBindTextureUnit(unit, id()); }
  // Binds all layers of an array.
  void bind_image(GLuint unit, GLenum access) const;

 private:
  struct Traits {
    static constexpr GLenum kIdentifier = GL_TEXTURE;
    static void destroy(GLuint id) { glDeleteTextures(1, &id); }
  };
  static Result<Texture> make_2d(GLenum format, int width, int height, int levels,
                                 std::string_view label);
  static Result<Texture> finish(Texture texture, std::string_view label);

  Object<Traits> object_;
  GLenum format_ = GL_NONE;
  int width_ = 0, height_ = 0, layers_ = 0, levels_ = 1;
};

// Returns the bytes per texel of a sized format. Covers the formats in use.
std::size_t bytes_per_texel(GLenum format);

}  // namespace strata::gl
