#include "mesh/gltf_draco.h"

#include <draco/compression/decode.h>
#include <draco/core/decoder_buffer.h>

#include "mesh/load_formats.h"

namespace strata::mesh {

Result<DracoPrimitive> decode_draco(std::span<const std::uint8_t> bytes,
                                    const std::map<std::string, std::uint32_t>& ids, std::uint64_t most_triangles) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    return refuse_file("The Draco data of the glTF cannot be decoded: " + decoded.status().error_msg_string() + ".");
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
  DracoPrimitive primitive;
  primitive.points = mesh->num_points();
  if (mesh->num_faces() > most_triangles)
    return refuse_file("The Draco data of the glTF makes " + std::to_string(mesh->num_faces()) +
                       " triangles, more than the glTF announces.");
  primitive.indices.reserve(3 * std::size_t{mesh->num_faces()});
  for (draco::FaceIndex face(0); face < mesh->num_faces(); ++face)
    for (int k = 0; k < 3; ++k) primitive.indices.push_back(mesh->face(face)[k].value());
  for (const auto& [name, id] : ids) {
    const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(id);
    if (attribute == nullptr || attribute->num_components() < 1 || attribute->num_components() > 4)
      return refuse_file("The Draco data of the glTF has no attribute " + name + ".");
    DracoPrimitive::Attribute& out = primitive.attributes[name];
    out.components = attribute->num_components();
    out.numbers.resize(primitive.points * out.components);
    for (draco::PointIndex point(0); point < mesh->num_points(); ++point) {
      const auto value = attribute->mapped_index(point);
      if (value.value() >= attribute->size() ||
          !attribute->ConvertValue(value, static_cast<std::int8_t>(out.components),
                                   &out.numbers[std::size_t{point.value()} * out.components]))
        return refuse_file("The Draco data of the glTF is damaged: " + name + " has values that are missing.");
    }
  }
  return primitive;
}

}  // namespace strata::mesh
