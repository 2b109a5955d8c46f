#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "domain/scene/model.h"

namespace strata::mesh {

// The continuation of a texture outside [0,1].
enum class Wrap : std::uint8_t { repeat, clamp, mirror };

// An image of a file, encoded as in the file, in any format of media/picture.h.
struct Texture {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

struct Material {
  std::string name = {};
  // sRGB, 0…1; multiplied with the texels of a texture in linear light
  glm::vec4 color{1};
  int texture = -1;  // of TriangleMesh::textures; -1: color only
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
};

constexpr std::uint16_t kNoMaterial = 0xffff;

// A mesh as files store it: plain arrays with double coordinates in world units. It has no OpenGL
// data and no connectivity.
struct TriangleMesh {
  std::vector<glm::dvec3> positions;
  std::vector<std::uint32_t> triangles;  // 3 position indices per triangle
  // empty, or 3 per triangle; the UV origin is the lower left corner of the material's texture
  std::vector<glm::vec2> corner_uvs;
  std::vector<std::uint32_t> vertex_colors;  // empty, or RGBA8 (red in the low byte) per position

  // empty, or one per triangle: an index of `materials`, or kNoMaterial
  std::vector<std::uint16_t> triangle_materials;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  // The end of each part's triangles, ascending. Parts share no position. Empty: one part.
  std::vector<std::uint32_t> part_ends;
  // vertex colors multiply materials (glTF); if false, a texture hides vertex colors
  bool colors_tint_materials = false;

  std::size_t triangle_count() const { return triangles.size() / 3; }
};

// Returns the sum of the triangle areas, in unit².
double surface_area(const TriangleMesh& mesh);

}  // namespace strata::mesh
