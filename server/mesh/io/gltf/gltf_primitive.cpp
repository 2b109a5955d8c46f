#include "mesh/io/gltf/gltf_primitive.h"

#include <algorithm>
#include <array>

#include "mesh/io/gltf/gltf_draco.h"
#include "mesh/io/gltf/gltf_numbers.h"
#include "mesh/io/load_formats.h"

namespace strata::mesh {
namespace {

using nlohmann::json;
using Values = GltfDocument::Values;

constexpr std::uint32_t kUnused = 0xffffffffu;

// The required form of an attribute. With KHR_mesh_quantization, positions and texture
// coordinates can be integers. They are read even if the file does not name the extension.
struct Attribute {
  std::string name;
  Values* values;
  int least_components, most_components;
  bool is_color;
};

class PrimitiveReader {
 public:
  PrimitiveReader(GltfDocument& document, const json& source, const GltfMaterial& material,
                  std::size_t max_triangles, GltfRemarks& remarks)
      : document_(document),
        source_(source),
        accessors_(object_in(source, "attributes")),
        max_triangles_(max_triangles),
        remarks_(remarks),
        attributes_{
            {{"POSITION", &primitive_.positions, 3, 3, false},
             {"TEXCOORD_" + std::to_string(material.texcoord), &primitive_.uvs, 2, 2, false},
             {"COLOR_0", &primitive_.colors, 3, 4, true}}} {}

  Result<std::optional<GltfPrimitive>> read() {
    const auto mode = STRATA_TRY(whole_number(source_, "mode", kTriangles));
    primitive_.mode = mode;
    if (mode > kTriangleFan)
      return refuse_file("A primitive of the glTF has mode " + std::to_string(mode) +
                         ", which glTF does not define.");
    if (mode < kTriangles) {
      ++remarks_.points_and_lines;
      return std::nullopt;
    }
    const auto& draco = object_in(object_in(source_, "extensions"), "KHR_draco_mesh_compression");
    if (!accessors_.contains("POSITION") && !object_in(draco, "attributes").contains("POSITION")) {
      // glTF allows this; an extension that is not supported here may supply positions
      ++remarks_.without_positions;
      return std::nullopt;
    }
    STRATA_TRY(draco.empty() ? Result<void>() : read_draco(draco));
    for (const Attribute& attribute : attributes_) STRATA_TRY(read_plain(attribute));
    if (draco.empty()) STRATA_TRY(read_indices());
    STRATA_TRY(check());
    keep_used_vertices();
    return std::move(primitive_);
  }

 private:
  // Checks the number type of this accessor. Returns true for integers that should be normalized
  // but are not declared as normalized.
  Result<bool> must_normalize(const Attribute& attribute, std::uint64_t accessor,
                              const GltfDocument::Form& form) {
    const std::string name =
        "Accessor " + std::to_string(accessor) + " of the glTF (" + attribute.name + ")";
    const int type = form.component_type;
    if (form.components < attribute.least_components || form.components > attribute.most_components)
      return refuse_file(
          name + " has " + std::to_string(form.components) + " numbers per vertex; " +
          std::to_string(attribute.least_components) +
          (attribute.is_color ? " or " + std::to_string(attribute.most_components) : "") +
          " are required.");
    const bool is_signed = type == kByte || type == kShort;
    if (type == kUnsignedInt || (attribute.is_color && is_signed))
      return refuse_file(name + " contains " + name_of_component(type) +
                         ", which glTF does not allow here. Export it with " +
                         (attribute.is_color ? "UNSIGNED_BYTE, UNSIGNED_SHORT or FLOAT."
                                             : "FLOAT, or with numbers of KHR_mesh_quantization."));
    // Integer colors can only be shares of 255 or 65535.
    const bool taken = attribute.is_color && type != kFloat && !form.normalized;
    remarks_.colors_taken_as_normalized += taken;
    return taken;
  }

  // Attributes of a Draco primitive that are not in its stream are read as usual.
  Result<void> read_plain(const Attribute& attribute) {
    if (attribute.values->components != 0 || !accessors_.contains(attribute.name)) return {};
    const auto accessor = STRATA_TRY(whole_number(accessors_, attribute.name.c_str()));
    const auto form = STRATA_TRY(document_.form(accessor, attribute.name));
    const auto normalize = STRATA_TRY(must_normalize(attribute, accessor, form));
    auto found = STRATA_TRY(document_.values(accessor, attribute.name, normalize));
    *attribute.values = std::move(found);
    return {};
  }

  Result<void> read_draco(const json& extension) {
    const auto& ids = object_in(extension, "attributes");
    std::map<std::string, DracoRequest> requests;
    for (const Attribute& attribute : attributes_) {
      if (!ids.contains(attribute.name)) continue;
      const auto id = STRATA_TRY(whole_number(ids, attribute.name.c_str()));
      DracoRequest& request = requests[attribute.name];
      request.id = static_cast<std::uint32_t>(id);
      if (!accessors_.contains(attribute.name)) continue;
      const auto accessor = STRATA_TRY(whole_number(accessors_, attribute.name.c_str()));
      const auto form = STRATA_TRY(document_.form(accessor, attribute.name));
      const auto normalize = STRATA_TRY(must_normalize(attribute, accessor, form));
      request.form = form;
      request.normalize = normalize;
    }
    std::uint64_t most = max_triangles_;
    if (source_.contains("indices")) {
      const auto accessor = STRATA_TRY(whole_number(source_, "indices"));
      const auto form = STRATA_TRY(document_.form(accessor, "indices"));
      // Draco stores a strip as separate triangles.
      const std::uint64_t announced = primitive_.mode == kTriangles ? form.count / 3 : form.count;
      most = std::min(most, announced);
    }
    const auto view_index = STRATA_TRY(whole_number(extension, "bufferView"));
    const auto view = STRATA_TRY(document_.view(view_index));
    auto decoded = STRATA_TRY(decode_draco(view.bytes, requests, most));
    for (const Attribute& attribute : attributes_)
      if (const auto found = decoded.attributes.find(attribute.name);
          found != decoded.attributes.end())
        *attribute.values = std::move(found->second);
    primitive_.indices = std::move(decoded.indices);
    primitive_.mode = kTriangles;
    return {};
  }

  Result<void> read_indices() {
    if (!source_.contains("indices")) {
      if (primitive_.positions.count > 3 * std::uint64_t{max_triangles_})
        return refuse_file("The glTF has too many vertices.");
      primitive_.indices.resize(primitive_.positions.count);
      for (std::uint32_t i = 0; i < primitive_.indices.size(); ++i) primitive_.indices[i] = i;
      return {};
    }
    const auto accessor = STRATA_TRY(whole_number(source_, "indices"));
    auto indices = STRATA_TRY(document_.indices(accessor));
    primitive_.indices = std::move(indices);
    return {};
  }

  Result<void> check() const {
    const std::uint64_t count = primitive_.positions.count;
    for (const Attribute& attribute : attributes_) {
      const Values& values = *attribute.values;
      if (values.components == 0) continue;
      if (values.components < attribute.least_components ||
          values.components > attribute.most_components)
        return refuse_file("A primitive of the glTF has " + std::to_string(values.components) +
                           " numbers per vertex for " + attribute.name + ".");
      if (values.count == count) continue;
      return refuse_file("A primitive of the glTF has " + std::to_string(count) +
                         " positions, but " + std::to_string(values.count) + " values of " +
                         attribute.name + ".");
    }
    for (const std::uint32_t index : primitive_.indices)
      if (index >= count)
        return refuse_file("A triangle of the glTF refers to vertex " + std::to_string(index) +
                           ", but the number of vertices of its primitive is " +
                           std::to_string(count) + ".");
    return {};
  }

  // Primitives share accessors. Each primitive keeps only the vertices that its triangles use.
  void keep_used_vertices() {
    std::vector<std::uint32_t> number(primitive_.positions.count, kUnused), used;
    for (std::uint32_t& index : primitive_.indices) {
      if (number[index] == kUnused) {
        number[index] = static_cast<std::uint32_t>(used.size());
        used.push_back(index);
      }
      index = number[index];
    }
    for (const Attribute& attribute : attributes_) {
      Values& values = *attribute.values;
      if (values.components == 0) continue;
      const auto n = static_cast<std::size_t>(values.components);
      std::vector<float> retained(used.size() * n);
      for (std::size_t i = 0; i < used.size(); ++i)
        std::copy_n(values.numbers.begin() + static_cast<std::ptrdiff_t>(used[i] * n), n,
                    retained.begin() + static_cast<std::ptrdiff_t>(i * n));
      values.numbers = std::move(retained);
      values.count = used.size();
    }
  }

  GltfDocument& document_;
  const json &source_, &accessors_;
  const std::size_t max_triangles_;
  GltfRemarks& remarks_;
  GltfPrimitive primitive_;
  std::array<Attribute, 3> attributes_;
};

}  // namespace

Result<std::optional<GltfPrimitive>> read_gltf_primitive(GltfDocument& document, const json& source,
                                                         const GltfMaterial& material,
                                                         std::size_t max_triangles,
                                                         GltfRemarks& remarks) {
  return PrimitiveReader(document, source, material, max_triangles, remarks).read();
}

}  // namespace strata::mesh
