#pragma once

#include <glm/glm.hpp>

#include "mesh/io/gltf/gltf_document.h"

namespace strata::mesh {

// A node with more instances is refused, because users cannot paint on so many instances
// individually.
constexpr std::uint64_t kMaxInstances = 1'000'000;

// Returns the transform of glTF: translation, rotation (a quaternion x y z w of any length) and
// scale.
glm::dmat4 gltf_transform(const glm::dvec3& translation, const glm::dvec4& rotation,
                          const glm::dvec3& scale);

// The transforms with which EXT_mesh_gpu_instancing repeats the mesh of a node.
class GltfInstances {
 public:
  // A node without the extension has one instance, at the node. Fails like `refuse_file` for counts
  // that differ, number types that the extension does not allow, and more than kMaxInstances
  // instances.
  static Result<GltfInstances> read(GltfDocument& document, const nlohmann::json& node);

  std::uint64_t count() const { return count_; }
  glm::dmat4 node_from_instance(std::uint64_t i) const;

 private:
  std::uint64_t count_ = 1;
  GltfDocument::Values translations_, rotations_, scales_;  // `count_` values each, or empty
};

}  // namespace strata::mesh
