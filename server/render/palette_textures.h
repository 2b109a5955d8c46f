#pragma once

#include <memory>
#include <vector>

#include "core/palette.h"
#include "gl/buffer.h"
#include "gl/texture.h"
#include "shared/shade.h"

namespace strata::render {

// Palettes on the GPU: linear ones as rows of one texture; the points of stepped and categorical ones in one storage buffer,
// because thresholds and keys must hit exactly. Entries are kept as long as there is room.
class PaletteTextures {
 public:
  static Result<PaletteTextures> create();

  struct Entry {
    std::shared_ptr<const Palette> palette;
    ValueType type;
    std::uint32_t row = 0, points = 0, point_count = 0;
  };
  // Forgets old entries when `count` more might not fit; entries found after it stay until the next call.
  void make_room(std::size_t count);
  Entry find(const std::shared_ptr<const Palette>& palette, ValueType type);

  static constexpr std::size_t kMaxPoints = 4096;                       // a palette
  static constexpr std::size_t kMaxPalettes = shader::kMaxShadeLayers;  // that there can be room for

  void bind(GLuint texture_unit, GLuint points_binding) const;

 private:
  gl::Texture rows_;
  gl::Buffer points_;
  std::vector<Entry> entries_;
  std::uint32_t next_row_ = 0, next_point_ = 0;
};

}  // namespace strata::render
