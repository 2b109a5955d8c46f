#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "domain/scene/model.h"

namespace strata::mesh {

// Continuation of a texture outside [0,1].
enum class Wrap : std::uint8_t { repeat, clamp, mirror };

// A picture of a file, encoded as in the file, in any format of media/picture.h.
struct Texture {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

struct Material {
  std::string name = {};
  // sRGB, 0…1; the texels of a texture are multiplied by it, in linear light
  glm::vec4 color{1};
  int texture = -1;  // of TriangleMesh::textures; -1: color only
  Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
};

constexpr std::uint16_t kNoMaterial = 0xffff;

// A mesh as files store it: plain arrays, double coordinates in world units. No GL, no
// connectivity.
struct TriangleMesh {
  std::vector<glm::dvec3> positions;
  std::vector<std::uint32_t> triangles;  // 3 position indices a triangle
  // empty, or 3 a triangle; uv origin lower left of the material's texture
  std::vector<glm::vec2> corner_uvs;
  std::vector<std::uint32_t> vertex_colors;  // empty, or RGBA8 (red in the low byte) a position

  // empty, or one a triangle: index of `materials`, or kNoMaterial
  std::vector<std::uint16_t> triangle_materials;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  // vertex colors multiply materials (glTF); otherwise a texture hides them
  bool colors_tint_materials = false;

  std::size_t triangle_count() const { return triangles.size() / 3; }
};

// Sum of triangle areas, unit².
double surface_area(const TriangleMesh& mesh);

}  // namespace strata::mesh
