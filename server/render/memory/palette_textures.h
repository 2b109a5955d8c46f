#pragma once

#include <memory>
#include <span>
#include <vector>

#include "domain/layers/palette.h"
#include "gl/buffer.h"
#include "gl/texture.h"
#include "shared/shade.h"

namespace strata::render {

std::uint32_t packed(const Rgba& color);  // red in the low byte

// Palettes on the GPU: linear ones as rows of one texture; the points of stepped and categorical
// ones in one storage buffer, because thresholds and keys must be exact. Entries are kept as long
// as there is room.
class PaletteTextures {
 public:
  static Result<PaletteTextures> create();

  struct Entry {
    std::shared_ptr<const Palette> palette;
    ValueType type;
    std::uint32_t row = 0, points = 0, point_count = 0;
    bool patterned = false;  // some point is not solid
  };
  // Drops old entries if these palettes might not fit with them; entries found after it stay until
  // the next call. An Error `out_of_memory` if the driver has no memory.
  Result<void> make_room(std::span<const std::shared_ptr<const Palette>> palettes);
  Entry find(const std::shared_ptr<const Palette>& palette, ValueType type);

  // the largest number of palettes in one call
  static constexpr std::size_t kMaxPalettes = shader::kMaxShadeLayers;

  void bind(GLuint texture_unit, GLuint points_binding) const;

 private:
  gl::Texture rows_;
  gl::Buffer points_;
  std::vector<Entry> entries_;
  std::uint32_t next_row_ = 0, next_point_ = 0;
};

}  // namespace strata::render
