#pragma once

#include <memory>
#include <span>
#include <vector>

#include "domain/layers/palette.h"
#include "gl/buffer.h"
#include "gl/texture.h"
#include "shared/shade.h"

namespace strata::render {

std::uint32_t packed(const Rgba& color);  // red is in the low byte

// Palettes on the GPU. Linear palettes are rows of one texture. The points of stepped and
// categorical palettes are in one storage buffer, because thresholds and keys must be exact.
// Entries stay until there is no more room.
class PaletteTextures {
 public:
  static Result<PaletteTextures> create();

  struct Entry {
    std::shared_ptr<const Palette> palette;
    ValueType type;
    std::uint32_t row = 0, points = 0, point_count = 0;
    bool patterned = false;  // at least one point is not solid
  };
  // Removes all entries if there may be no room for these palettes. Entries that `find` returns are
  // then valid until the next call. Returns the Error `out_of_memory` if the driver has no memory.
  Result<void> make_room(std::span<const std::shared_ptr<const Palette>> palettes);
  Entry find(const std::shared_ptr<const Palette>& palette, ValueType type);

  // The largest number of palettes in one call of `make_room`.
  static constexpr std::size_t kMaxPalettes = shader::kMaxShadeLayers;

  void bind(GLuint texture_unit, GLuint points_binding) const;

 private:
  gl::Texture rows_;
  gl::Buffer points_;
  std::vector<Entry> entries_;
  std::uint32_t next_row_ = 0, next_point_ = 0;
};

}  // namespace strata::render
