#include "mesh/io/gltf/gltf_instances.h"

#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "mesh/io/gltf/gltf_numbers.h"
#include "mesh/io/load_formats.h"

namespace strata::mesh {
namespace {

using nlohmann::json;

constexpr const char* kExtension = "EXT_mesh_gpu_instancing";

glm::dvec3 vector_at(const GltfDocument::Values& values, std::uint64_t i, double otherwise) {
  if (values.components == 0) return glm::dvec3(otherwise);
  return {values.numbers[3 * i], values.numbers[3 * i + 1], values.numbers[3 * i + 2]};
}

}  // namespace

glm::dmat4 gltf_transform(const glm::dvec3& translation, const glm::dvec4& rotation,
                          const glm::dvec3& scale) {
  glm::dquat turn(rotation.w, rotation.x, rotation.y, rotation.z);
  const double length = glm::length(turn);
  turn = length > 0 ? turn / length : glm::dquat(1, 0, 0, 0);
  glm::dmat4 matrix = glm::mat4_cast(turn);
  for (int k = 0; k < 3; ++k) matrix[k] *= scale[k];
  matrix[3] = glm::dvec4(translation, 1);
  return matrix;
}

Result<GltfInstances> GltfInstances::read(GltfDocument& document, const json& node) {
  GltfInstances instances;
  const json& extension = object_in(object_in(node, "extensions"), kExtension);
  if (extension.empty()) return instances;
  const json& attributes = object_in(extension, "attributes");
  std::optional<std::uint64_t> count;
  struct Part {
    const char* name;
    GltfDocument::Values* values;
    int components;
  };
  for (const Part& part :
       {Part{"TRANSLATION", &instances.translations_, 3},
        Part{"ROTATION", &instances.rotations_, 4}, Part{"SCALE", &instances.scales_, 3}}) {
    if (!attributes.contains(part.name)) continue;
    const auto accessor = STRATA_TRY(whole_number(attributes, part.name));
    const auto form = STRATA_TRY(document.form(accessor, part.name));
    const std::string name = std::string(part.name) + " of " + kExtension;
    const bool whole = form.component_type == kByte || form.component_type == kShort;
    const bool allowed =
        form.component_type == kFloat || (part.components == 4 && whole && form.normalized);
    if (form.components != part.components || !allowed)
      return refuse_file(name + " in the glTF does not contain " + std::to_string(part.components) +
                         (part.components == 4
                              ? " numbers of type FLOAT, or of normalized BYTE or SHORT."
                              : " numbers of type FLOAT."));
    if (form.count > kMaxInstances)
      return refuse_file("The glTF repeats a mesh " + std::to_string(form.count) + " times with " +
                         kExtension + ". At most " + std::to_string(kMaxInstances) +
                         " repetitions are allowed. Export the parts that you need as meshes.");
    if (count && *count != form.count)
      return refuse_file(name + " in the glTF has " + std::to_string(form.count) +
                         " values, but another attribute has " + std::to_string(*count) + ".");
    count = form.count;
    auto values = STRATA_TRY(document.values(accessor, part.name));
    *part.values = std::move(values);
  }
  instances.count_ = count.value_or(1);
  return instances;
}

glm::dmat4 GltfInstances::node_from_instance(std::uint64_t i) const {
  glm::dvec4 rotation(0, 0, 0, 1);
  if (rotations_.components == 4)
    for (int k = 0; k < 4; ++k) rotation[k] = rotations_.numbers[4 * i + k];
  return gltf_transform(vector_at(translations_, i, 0), rotation, vector_at(scales_, i, 1));
}

}  // namespace strata::mesh
