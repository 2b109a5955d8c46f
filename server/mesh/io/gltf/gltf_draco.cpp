#include "mesh/io/gltf/gltf_draco.h"

#include <draco/compression/decode.h>
#include <draco/core/decoder_buffer.h>

#include "mesh/io/gltf/gltf_numbers.h"
#include "mesh/io/load_formats.h"

namespace strata::mesh {
namespace {

// Returns 0 for a type that accessors cannot have.
int component_type_of(draco::DataType type) {
  switch (type) {
    case draco::DT_INT8: return kByte;
    case draco::DT_BOOL:
    case draco::DT_UINT8: return kUnsignedByte;
    case draco::DT_INT16: return kShort;
    case draco::DT_UINT16: return kUnsignedShort;
    case draco::DT_UINT32: return kUnsignedInt;
    case draco::DT_FLOAT32: return kFloat;
    default: return 0;
  }
}

double raw_number(const std::uint8_t* at, draco::DataType type) {
  switch (type) {
    case draco::DT_INT32: return load_number<std::int32_t>(at);
    case draco::DT_INT64: return static_cast<double>(load_number<std::int64_t>(at));
    case draco::DT_UINT64: return static_cast<double>(load_number<std::uint64_t>(at));
    case draco::DT_FLOAT64: return load_number<double>(at);
    default: return stored_number(at, component_type_of(type));
  }
}

// Reads the stored numbers and converts them as declared by the accessor.
Result<GltfDocument::Values> read_attribute(const draco::Mesh& mesh, const std::string& name,
                                            const DracoRequest& request) {
  const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(request.id);
  if (attribute == nullptr)
    return refuse_file("The Draco data of the glTF has no attribute " + name + ".");
  const draco::DataType stored = attribute->data_type();
  const int components = attribute->num_components(), size = draco::DataTypeLength(stored);
  if (components < 1 || components > 4 || size < 1 || attribute->buffer() == nullptr)
    return refuse_file("The Draco data of the glTF stores " + name +
                       " in a number type that glTF does not define.");
  if (request.form && request.form->components != components)
    return refuse_file("The Draco data of the glTF has " + std::to_string(components) +
                       " numbers per vertex for " + name + ", but the accessor declares " +
                       std::to_string(request.form->components) + ".");
  const int type = request.form ? request.form->component_type : component_type_of(stored);
  const bool normalized =
      request.normalize || (request.form ? request.form->normalized : attribute->normalized());
  GltfDocument::Values values{mesh.num_points(), components, {}};
  values.numbers.resize(values.count * components);
  float* out = values.numbers.data();
  const std::uint8_t* bytes = attribute->buffer()->data();
  const std::uint64_t held = attribute->buffer()->data_size(),
                      each = static_cast<std::uint64_t>(components) * size;
  for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
    const auto value = attribute->mapped_index(point);
    const std::uint64_t at =
        value.value() < attribute->size() ? attribute->GetBytePos(value) : held;
    if (at > held || held - at < each)
      return refuse_file("The Draco data of the glTF is damaged: values of " + name +
                         " are missing.");
    for (int k = 0; k < components; ++k)
      *out++ = static_cast<float>(
          gltf_number(raw_number(bytes + at + k * size, stored), type, normalized));
  }
  return values;
}

}  // namespace

Result<DracoPrimitive> decode_draco(std::span<const std::uint8_t> bytes,
                                    const std::map<std::string, DracoRequest>& requests,
                                    std::uint64_t most_triangles) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    return refuse_file("The Draco data of the glTF cannot be decoded: " +
                       decoded.status().error_msg_string() + ".");
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  DracoPrimitive primitive;
  primitive.points = mesh->num_points();
  if (mesh->num_faces() > most_triangles)
    return refuse_file("The Draco data of the glTF contains " + std::to_string(mesh->num_faces()) +
                       " triangles, more than the glTF declares.");
  primitive.indices.reserve(3 * std::size_t{mesh->num_faces()});
  for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face)
    for (int k = 0; k < 3; ++k) primitive.indices.push_back(mesh->face(face)[k].value());
  for (const auto& [name, request] : requests) {
    auto values = STRATA_TRY(read_attribute(*mesh, name, request));
    primitive.attributes.emplace(name, std::move(values));
  }
  return primitive;
}

}  // namespace strata::mesh
