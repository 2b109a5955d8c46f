#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "mesh/io/gltf/gltf_document.h"
#include "mesh/io/load.h"

namespace strata::mesh {

// How a primitive of a glTF material finds its base colour.
struct GltfMaterial {
  std::uint16_t material = kNoMaterial;  // of TriangleMesh::materials
  int texcoord = 0;                      // which of its sets of texture coordinates
  glm::dmat2 uv_matrix{1};               // KHR_texture_transform
  glm::dvec2 uv_offset{0};

  // glTF counts v from the top.
  glm::vec2 texture_uv(const glm::dvec2& uv) const {
    const glm::dvec2 at = uv_matrix * uv + uv_offset;
    return {at.x, 1 - at.y};
  }
};

// All materials of the document, in its order: the base colour of metallic-roughness, or the
// diffuse one of KHR_materials_pbrSpecularGlossiness. Puts them and their pictures into the mesh;
// pictures that cannot be read are noted.
Result<std::vector<GltfMaterial>> read_gltf_materials(GltfDocument& document,
                                                      const InputFiles& files, LoadedMesh& loaded);

}  // namespace strata::mesh
