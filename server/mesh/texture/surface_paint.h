#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "media/picture.h"
#include "mesh/atlas/atlas.h"
#include "mesh/surface/triangle_mesh.h"
#include "mesh/texture/texture_sampler.h"

namespace strata::mesh {

// Paints the colors of a mesh's materials, textures and vertices on its atlas. Stores references to
// the mesh and the atlas.
class SurfacePaint {
 public:
  SurfacePaint(const TriangleMesh& mesh, const Atlas& atlas) : mesh_(mesh), atlas_(atlas) {}

  const Material& material_of(std::size_t triangle) const;

  // Paints all texels of the triangles. `source` is their texture, or empty for the material's
  // color only. Alpha is 255 if a triangle covers a texel's center, and slightly less if it only
  // claims the texel. Uses two threads.
  void paint(std::span<const std::uint32_t> triangles, const Picture& source,
             Picture& picture) const;

  // Paints the triangles of `atlas.moved` into an image of the file's own texture, and `ring`
  // texels around them that belong to no triangle. Triangles without coordinates mix the colors of
  // their corners on neighboring triangles. Beyond its edges, the image continues as defined by the
  // materials of `texture`.
  void paint_moved(int texture, int ring, Picture& picture) const;

 private:
  template <class Put>
  void raster(std::uint32_t t, glm::ivec2 size, int row_begin, int row_end, Put put) const;
  glm::dvec2 atlas_uv(std::size_t triangle, int k) const {
    return atlas_.corner_uvs[3 * triangle + k];
  }
  glm::dvec2 texture_uv(std::size_t triangle, int k) const {
    return mesh_.corner_uvs.empty() ? glm::dvec2(0)
                                    : glm::dvec2(mesh_.corner_uvs[3 * triangle + k]);
  }
  void shade(std::uint32_t t, const Material& material, const glm::dvec3& weights,
             const TextureSampler* sampler, std::uint8_t* out) const;

  const TriangleMesh& mesh_;
  const Atlas& atlas_;
};

// Multiplies rgb by `color` in linear light.
void multiply_light(std::uint8_t* rgb, const glm::vec4& color);

}  // namespace strata::mesh
