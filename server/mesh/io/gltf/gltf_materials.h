#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "mesh/io/gltf/gltf_document.h"
#include "mesh/io/load.h"

namespace strata::mesh {

// The source of the base color of a primitive with a glTF material.
struct GltfMaterial {
  std::uint16_t material = kNoMaterial;  // of TriangleMesh::materials
  int texcoord = 0;                      // index of the set of texture coordinates
  glm::dmat2 uv_matrix{1};               // KHR_texture_transform
  glm::dvec2 uv_offset{0};

  // In glTF, v begins at the top.
  glm::vec2 texture_uv(const glm::dvec2& uv) const {
    const glm::dvec2 at = uv_matrix * uv + uv_offset;
    return {at.x, 1 - at.y};
  }
};

// Reads all materials of the document in their order: the base color of metallic-roughness, or the
// diffuse color of KHR_materials_pbrSpecularGlossiness. Adds the materials and their images to the
// mesh, and notes images that cannot be read.
Result<std::vector<GltfMaterial>> read_gltf_materials(GltfDocument& document,
                                                      const InputFiles& files, LoadedMesh& loaded);

}  // namespace strata::mesh
