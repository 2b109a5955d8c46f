#include <algorithm>
#include <utility>

#include "mesh/io/gltf/gltf_document.h"
#include "mesh/io/gltf/gltf_numbers.h"
#include "mesh/io/load_formats.h"

namespace strata::mesh {
namespace {

using nlohmann::json;

// An accessor without a buffer view contains only zeros, which take no bytes in the file. It may
// have this many values independent of the file sizes.
constexpr std::uint64_t kZerosAlways = 1u << 20;

int components_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  return type == "VEC4" ? 4 : 0;
}

std::string name_of_accessor(std::uint64_t accessor, const std::string& what) {
  return "Accessor " + std::to_string(accessor) + " of the glTF (" + what + ")";
}

}  // namespace

Result<GltfDocument::Form> GltfDocument::form(std::uint64_t accessor,
                                              const std::string& what) const {
  const auto found = STRATA_TRY(element("accessors", accessor));
  const auto type = whole_number(*found, "componentType"), count = whole_number(*found, "count");
  if (!type) return tl::unexpected(type.error());
  if (!count) return tl::unexpected(count.error());
  Form form;
  form.component_type = static_cast<int>(std::min<std::uint64_t>(*type, 1u << 30));
  const std::string shape = text_of(*found, "type");
  form.components = components_of(shape);
  form.count = *count;
  const auto normalized = found->find("normalized");
  form.normalized =
      normalized != found->end() && normalized->is_boolean() && normalized->get<bool>();
  if (bytes_of_component(form.component_type) == 0)
    return refuse_file(name_of_accessor(accessor, what) + " contains " +
                       name_of_component(form.component_type) + ", which glTF does not define.");
  if (form.components == 0)
    return refuse_file(name_of_accessor(accessor, what) + " contains elements of type \"" +
                       shape.substr(0, 20) + "\", which are not allowed here.");
  return form;
}

Result<GltfDocument::Layout> GltfDocument::layout(std::uint64_t accessor, const std::string& what) {
  const auto form = this->form(accessor, what);
  if (!form) return tl::unexpected(form.error());
  const json& source = **element("accessors", accessor);
  const auto offset = STRATA_TRY(whole_number(source, "byteOffset", 0));
  const std::string name = name_of_accessor(accessor, what);
  Layout layout{*form, {}, 0};
  const std::uint64_t size =
      static_cast<std::uint64_t>(bytes_of_component(form->component_type)) * form->components;
  layout.stride = size;
  if (!source.contains("bufferView")) {  // all zeros, which sparse values may replace
    std::uint64_t most = kZerosAlways;
    for (const auto& file : files_->all()) most += file.bytes.size();
    if (form->count > most)
      return refuse_file(name + " has more values than the file can contain.");
    return layout;
  }
  const auto index = STRATA_TRY(whole_number(source, "bufferView"));
  const auto bytes = STRATA_TRY(view(index));
  if (bytes.stride != 0) layout.stride = bytes.stride;
  if (layout.stride < size)
    return refuse_file(name + " has a stride that is smaller than its values.");
  const std::uint64_t room = bytes.bytes.size(), count = form->count;
  if (offset > room ||
      (count > 0 && (room - offset < size || (room - offset - size) / layout.stride < count - 1)))
    return refuse_file(
        name + " declares " + std::to_string(count) +
        " values, but its buffer view is too short: the file is incomplete or damaged.");
  layout.bytes = bytes.bytes.subspan(offset);
  return layout;
}

template <class Put>
Result<void> GltfDocument::for_each_element(std::uint64_t accessor, const std::string& what,
                                            const Layout& layout, Put&& put) {
  if (!layout.bytes.empty())
    for (std::uint64_t i = 0; i < layout.form.count; ++i)
      put(i, layout.bytes.data() + i * layout.stride);
  const json& sparse = object_in(**element("accessors", accessor), "sparse");
  if (sparse.empty()) return {};
  const std::string name = name_of_accessor(accessor, what);
  const json &where = object_in(sparse, "indices"), &values = object_in(sparse, "values");
  const auto count = whole_number(sparse, "count"), index_view = whole_number(where, "bufferView"),
             index_offset = whole_number(where, "byteOffset", 0),
             index_type = whole_number(where, "componentType"),
             value_view = whole_number(values, "bufferView"),
             value_offset = whole_number(values, "byteOffset", 0);
  for (const auto* number :
       {&count, &index_view, &index_offset, &index_type, &value_view, &value_offset})
    if (!*number) return tl::unexpected(number->error());
  const int type = static_cast<int>(std::min<std::uint64_t>(*index_type, 1u << 30));
  if (!is_index_type(type))
    return refuse_file(name + " uses " + name_of_component(type) +
                       " as indices of its sparse values, but glTF requires unsigned whole "
                       "numbers.");
  const auto index_bytes = view(*index_view), value_bytes = view(*value_view);
  if (!index_bytes) return tl::unexpected(index_bytes.error());
  if (!value_bytes) return tl::unexpected(value_bytes.error());
  const std::uint64_t index_size = bytes_of_component(type);
  const std::uint64_t value_size =
      static_cast<std::uint64_t>(bytes_of_component(layout.form.component_type)) *
      layout.form.components;
  const auto holds = [&](std::span<const std::uint8_t> bytes, std::uint64_t offset,
                         std::uint64_t each) {
    return offset <= bytes.size() && *count <= (bytes.size() - offset) / each;
  };
  if (!holds(index_bytes->bytes, *index_offset, index_size) ||
      !holds(value_bytes->bytes, *value_offset, value_size))
    return refuse_file(name + " has sparse values beyond their buffer views.");
  for (std::uint64_t i = 0; i < *count; ++i) {
    const std::uint64_t at =
        stored_index(index_bytes->bytes.data() + *index_offset + i * index_size, type);
    if (at >= layout.form.count) return refuse_file(name + " has sparse values beyond its end.");
    put(at, value_bytes->bytes.data() + *value_offset + i * value_size);
  }
  return {};
}

Result<GltfDocument::Values> GltfDocument::values(std::uint64_t accessor, const std::string& what,
                                                  bool normalize) {
  const auto layout = this->layout(accessor, what);
  if (!layout) return tl::unexpected(layout.error());
  const int type = layout->form.component_type, components = layout->form.components,
            size = bytes_of_component(type);
  const bool normalized = normalize || layout->form.normalized;
  Values values{layout->form.count, components, {}};
  values.numbers.resize(values.count * components);
  const auto put = [&](std::uint64_t i, const std::uint8_t* from) {
    for (int k = 0; k < components; ++k)
      values.numbers[i * components + k] =
          static_cast<float>(gltf_number(stored_number(from + k * size, type), type, normalized));
  };
  STRATA_TRY(for_each_element(accessor, what, *layout, put));
  return values;
}

Result<std::vector<std::uint32_t>> GltfDocument::indices(std::uint64_t accessor) {
  const auto layout = this->layout(accessor, "indices");
  if (!layout) return tl::unexpected(layout.error());
  const int type = layout->form.component_type;
  if (layout->form.components != 1 || !is_index_type(type))
    return refuse_file(name_of_accessor(accessor, "indices") +
                       " does not contain unsigned whole numbers.");
  std::vector<std::uint32_t> indices(layout->form.count);
  const auto put = [&](std::uint64_t i, const std::uint8_t* from) {
    indices[i] = stored_index(from, type);
  };
  STRATA_TRY(for_each_element(accessor, "indices", *layout, put));
  return indices;
}

}  // namespace strata::mesh
