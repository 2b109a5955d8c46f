#include <algorithm>
#include <cstring>

#include "mesh/gltf_document.h"
#include "mesh/load_formats.h"

namespace strata::mesh {
namespace {

using nlohmann::json;

int bytes_of_component(int type) {
  switch (type) {
    case 5120:
    case 5121: return 1;
    case 5122:
    case 5123: return 2;
    case 5125:
    case 5126: return 4;
    default: return 0;
  }
}

int components_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  return type == "VEC4" ? 4 : 0;
}

template <class Number>
Number load_number(const std::uint8_t* at) {
  Number value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

float component(const std::uint8_t* at, int type, bool normalized) {
  switch (type) {
    case 5120: {
      const float value = load_number<std::int8_t>(at);
      return normalized ? std::max(value / 127.f, -1.f) : value;
    }
    case 5121: return normalized ? at[0] / 255.f : at[0];
    case 5122: {
      const float value = load_number<std::int16_t>(at);
      return normalized ? std::max(value / 32767.f, -1.f) : value;
    }
    case 5123: {
      const float value = load_number<std::uint16_t>(at);
      return normalized ? value / 65535.f : value;
    }
    case 5125: return static_cast<float>(load_number<std::uint32_t>(at));
    default: return load_number<float>(at);
  }
}

std::uint32_t index_at(const std::uint8_t* at, int type) {
  if (type == 5121) return at[0];
  return type == 5123 ? load_number<std::uint16_t>(at) : load_number<std::uint32_t>(at);
}

}  // namespace

Result<std::uint64_t> GltfDocument::count(std::uint64_t accessor) const {
  const auto found = element("accessors", accessor);
  if (!found) return tl::unexpected(found.error());
  return whole_number(**found, "count");
}

Result<GltfDocument::Layout> GltfDocument::layout(const json& accessor, const std::string& name) {
  const auto type = whole_number(accessor, "componentType"), count = whole_number(accessor, "count"),
             offset = whole_number(accessor, "byteOffset", 0);
  for (const auto* number : {&type, &count, &offset})
    if (!*number) return tl::unexpected(number->error());
  Layout layout;
  layout.component_type = static_cast<int>(std::min<std::uint64_t>(*type, 1u << 30));
  layout.components = components_of(text_of(accessor, "type"));
  layout.count = *count;
  const auto normalized = accessor.find("normalized");
  layout.normalized = normalized != accessor.end() && normalized->is_boolean() && normalized->get<bool>();
  const std::uint64_t size = static_cast<std::uint64_t>(bytes_of_component(layout.component_type)) * layout.components;
  if (size == 0) return refuse_file(name + " has a type that is not used for this.");
  layout.stride = size;
  if (!accessor.contains("bufferView")) {  // zeros, for sparse values to change
    if (*count > files_->scan().bytes.size()) return refuse_file(name + " has more values than the file can hold.");
    return layout;
  }
  const auto index = whole_number(accessor, "bufferView");
  if (!index) return tl::unexpected(index.error());
  const auto bytes = view(*index);
  if (!bytes) return tl::unexpected(bytes.error());
  if (bytes->stride != 0) layout.stride = bytes->stride;
  if (layout.stride < size) return refuse_file(name + " has a stride smaller than its values.");
  const std::uint64_t room = bytes->bytes.size();
  if (*offset > room || (*count > 0 && (room - *offset < size || (room - *offset - size) / layout.stride < *count - 1)))
    return refuse_file(name + " announces " + std::to_string(*count) +
                       " values, but its buffer view ends before them: the file is cut short or damaged.");
  layout.bytes = bytes->bytes.subspan(*offset);
  return layout;
}

Result<GltfDocument::Values> GltfDocument::values(std::uint64_t accessor, const std::string& what) {
  const auto found = element("accessors", accessor);
  if (!found) return tl::unexpected(found.error());
  const std::string name = "Accessor " + std::to_string(accessor) + " of the glTF (" + what + ")";
  const auto shape = layout(**found, name);
  if (!shape) return tl::unexpected(shape.error());
  Values values{shape->count, shape->components, {}};
  values.numbers.resize(shape->count * shape->components);
  const int size = bytes_of_component(shape->component_type);
  if (!shape->bytes.empty()) {
    float* out = values.numbers.data();
    for (std::uint64_t i = 0; i < shape->count; ++i)
      for (int k = 0; k < shape->components; ++k)
        *out++ =
            component(shape->bytes.data() + i * shape->stride + k * size, shape->component_type, shape->normalized);
  }
  if (auto done = apply_sparse(**found, *shape, name, values.numbers); !done) return tl::unexpected(done.error());
  return values;
}

Result<void> GltfDocument::apply_sparse(const json& accessor, const Layout& layout, const std::string& name,
                                        std::vector<float>& numbers) {
  const json& sparse = object_in(accessor, "sparse");
  if (sparse.empty()) return {};
  const json &where = object_in(sparse, "indices"), &what = object_in(sparse, "values");
  const auto count = whole_number(sparse, "count"), index_view = whole_number(where, "bufferView"),
             index_offset = whole_number(where, "byteOffset", 0), index_type = whole_number(where, "componentType"),
             value_view = whole_number(what, "bufferView"), value_offset = whole_number(what, "byteOffset", 0);
  for (const auto* number : {&count, &index_view, &index_offset, &index_type, &value_view, &value_offset})
    if (!*number) return tl::unexpected(number->error());
  const auto index_bytes = view(*index_view), value_bytes = view(*value_view);
  if (!index_bytes) return tl::unexpected(index_bytes.error());
  if (!value_bytes) return tl::unexpected(value_bytes.error());
  const bool known = *index_type == 5121 || *index_type == 5123 || *index_type == 5125;
  const std::uint64_t index_size = known ? bytes_of_component(static_cast<int>(*index_type)) : 0;
  const int size = bytes_of_component(layout.component_type);
  const std::uint64_t value_size = static_cast<std::uint64_t>(size) * layout.components;
  const auto holds = [&](std::span<const std::uint8_t> bytes, std::uint64_t offset, std::uint64_t each) {
    return offset <= bytes.size() && *count <= (bytes.size() - offset) / each;
  };
  if (!known || !holds(index_bytes->bytes, *index_offset, index_size) ||
      !holds(value_bytes->bytes, *value_offset, value_size))
    return refuse_file(name + " has sparse values beyond their buffer views.");
  for (std::uint64_t i = 0; i < *count; ++i) {
    const std::uint64_t at =
        index_at(index_bytes->bytes.data() + *index_offset + i * index_size, static_cast<int>(*index_type));
    if (at >= layout.count) return refuse_file(name + " has sparse values beyond its end.");
    for (int k = 0; k < layout.components; ++k)
      numbers[at * layout.components + k] =
          component(value_bytes->bytes.data() + *value_offset + i * value_size + k * size, layout.component_type,
                    layout.normalized);
  }
  return {};
}

Result<std::vector<std::uint32_t>> GltfDocument::indices(std::uint64_t accessor) {
  const auto found = element("accessors", accessor);
  if (!found) return tl::unexpected(found.error());
  const std::string name = "Accessor " + std::to_string(accessor) + " of the glTF (indices)";
  const auto shape = layout(**found, name);
  if (!shape) return tl::unexpected(shape.error());
  const int type = shape->component_type;
  if (shape->components != 1 || (type != 5121 && type != 5123 && type != 5125) || shape->bytes.empty())
    return refuse_file(name + " does not hold unsigned whole numbers.");
  std::vector<std::uint32_t> indices(shape->count);
  for (std::uint64_t i = 0; i < shape->count; ++i) indices[i] = index_at(shape->bytes.data() + i * shape->stride, type);
  return indices;
}

}  // namespace strata::mesh
