#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace strata::mesh {

// The properties of an MTL material for the appearance of a surface in white light.
struct MtlMaterial {
  std::string name;
  glm::vec4 color{1};      // Kd, d; sRGB
  std::string texture;     // of map_Kd, as written; empty: none
  bool clamp = false;      // -clamp on
  glm::vec2 uv_scale{1};   // -s
  glm::vec2 uv_offset{0};  // -o
};

// Reads the known statements and skips the rest: a mesh is usable without any of them. Lines may
// continue after a backslash and end as in an OBJ; the text may be UTF-16; names may contain
// blanks. At most `most` materials.
std::vector<MtlMaterial> parse_mtl(std::span<const std::uint8_t> bytes, std::size_t most);

}  // namespace strata::mesh
