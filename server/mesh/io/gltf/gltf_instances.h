#pragma once

#include <glm/glm.hpp>

#include "mesh/io/gltf/gltf_document.h"

namespace strata::mesh {

// More of one node are refused: nobody paints on them one by one.
constexpr std::uint64_t kMaxInstances = 1'000'000;

// Translation, rotation (a quaternion x y z w, of any length) and scale, as glTF applies them.
glm::dmat4 gltf_transform(const glm::dvec3& translation, const glm::dvec4& rotation,
                          const glm::dvec3& scale);

// Where EXT_mesh_gpu_instancing repeats the mesh of a node.
class GltfInstances {
 public:
  // Of a node without the extension: one, where the node is. Refused as by `refuse_file`: counts
  // that differ, numbers of other types than the extension has, more than kMaxInstances.
  static Result<GltfInstances> read(GltfDocument& document, const nlohmann::json& node);

  std::uint64_t count() const { return count_; }
  glm::dmat4 node_from_instance(std::uint64_t i) const;

 private:
  std::uint64_t count_ = 1;
  GltfDocument::Values translations_, rotations_, scales_;  // `count_` each, or none
};

}  // namespace strata::mesh
