#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace strata::mesh {

// A material of an MTL file, as far as it says what a surface looks like in white light.
struct MtlMaterial {
  std::string name;
  glm::vec4 color{1};      // Kd, d; sRGB
  std::string texture;     // of map_Kd, as written; empty: none
  bool clamp = false;      // -clamp on
  glm::vec2 uv_scale{1};   // -s
  glm::vec2 uv_offset{0};  // -o
};

// Reads what it knows and passes over the rest: an MTL says nothing without which a mesh cannot be
// used. Lines may go on after a backslash and end as those of an OBJ; the text may be UTF-16; names
// may hold blanks. At most `most` materials.
std::vector<MtlMaterial> parse_mtl(std::span<const std::uint8_t> bytes, std::size_t most);

}  // namespace strata::mesh
