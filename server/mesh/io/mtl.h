#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace strata::mesh {

// The properties of an MTL material that determine the appearance of a surface in white light.
struct MtlMaterial {
  std::string name;
  glm::vec4 color{1};      // Kd, d; sRGB
  std::string texture;     // of map_Kd, as written; empty: no texture
  bool clamp = false;      // -clamp on
  glm::vec2 uv_scale{1};   // -s
  glm::vec2 uv_offset{0};  // -o
};

// Reads the known statements and skips all others, because a mesh is usable without them. Line ends
// and continued lines are as in an OBJ. The text may be UTF-16, and names may contain blanks.
// Returns at most `most` materials.
std::vector<MtlMaterial> parse_mtl(std::span<const std::uint8_t> bytes, std::size_t most);

}  // namespace strata::mesh
