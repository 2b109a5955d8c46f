#include "mesh/io/gltf/gltf_document.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/text/percent.h"
#include "mesh/io/gltf/gltf_uri.h"
#include "mesh/io/gltf/meshopt_stream.h"
#include "mesh/io/load_formats.h"

namespace strata::mesh {
namespace {

using nlohmann::json;

constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;
constexpr std::size_t kMaxJson = std::size_t{256} << 20;
// The limit for the bytes of all decompressed views together. It is twice as much as the largest
// mesh needs.
constexpr std::uint64_t kMaxDecoded = std::uint64_t{4} << 30;

// Extensions that a file may require. The reader supports them, or they only change the appearance.
constexpr std::array<std::string_view, 12> kKnownExtensions{
    "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression",
    "KHR_mesh_quantization",      "EXT_mesh_gpu_instancing", "KHR_texture_transform",
    "KHR_lights_punctual",        "KHR_texture_basisu",      "EXT_texture_webp",
    "MSFT_texture_dds",           "EXT_texture_avif",        "KHR_animation_pointer"};

std::uint32_t little_endian(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace

Result<std::uint64_t> whole_number(const json& object, const char* name, std::uint64_t otherwise) {
  const auto found = object.find(name);
  if (found == object.end()) return otherwise;
  if (found->is_number_unsigned()) return found->get<std::uint64_t>();
  if (found->is_number_float() && *found >= 0.0 && *found < 9e15 &&
      std::floor(found->get<double>()) == *found)
    return static_cast<std::uint64_t>(found->get<double>());
  return refuse_file("In the glTF, \"" + std::string(name) +
                     "\" is not a whole number of 0 or more.");
}

Result<std::uint64_t> whole_number(const json& object, const char* name) {
  if (!object.contains(name))
    return refuse_file("In the glTF, \"" + std::string(name) + "\" is missing.");
  return whole_number(object, name, 0);
}

Result<std::vector<double>> real_numbers(const json& object, const char* name,
                                         const std::vector<double>& otherwise) {
  const auto found = object.find(name);
  if (found == object.end()) return otherwise;
  std::vector<double> numbers;
  if (found->is_array() && found->size() == otherwise.size())
    for (const json& number : *found)
      if (number.is_number() && std::isfinite(number.get<double>()))
        numbers.push_back(number.get<double>());
  if (numbers.size() == otherwise.size()) return numbers;
  return refuse_file("In the glTF, \"" + std::string(name) + "\" is not a list of " +
                     std::to_string(otherwise.size()) + " finite numbers.");
}

std::string text_of(const json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

const json& object_in(const json& object, const char* name) {
  static const json empty = json::object();
  const auto found = object.find(name);
  return found != object.end() && found->is_object() ? *found : empty;
}

Result<GltfDocument> GltfDocument::open(const InputFiles& files) {
  GltfDocument document(files);
  STRATA_TRY(document.read_container());
  STRATA_TRY(document.check_version_and_extensions());
  return document;
}

Result<void> GltfDocument::read_container() {
  std::span<const std::uint8_t> text = files_->scan().bytes;
  if (text.size() >= 4 && little_endian(text, 0) == kGlbMagic) {
    const auto file = text;
    text = {};
    if (file.size() < 20)
      return refuse_file("The GLB ends within its header: the file is incomplete.");
    if (little_endian(file, 4) != 2)
      return refuse_file("The version of the GLB is " + std::to_string(little_endian(file, 4)) +
                         ". The server can read only version 2.");
    const std::uint64_t length = little_endian(file, 8);
    if (length > file.size())
      return refuse_file("The GLB should have " + std::to_string(length) + " bytes, but has " +
                         std::to_string(file.size()) +
                         ": the file is incomplete. Export or upload it again.");
    for (std::uint64_t at = 12; at + 8 <= length;) {
      const std::uint64_t size = little_endian(file, at), type = little_endian(file, at + 4);
      if (size > length - at - 8)
        return refuse_file("A chunk of the GLB should have " + std::to_string(size) +
                           " bytes, but only " + std::to_string(length - at - 8) + " are left.");
      if (type == kJsonChunk && text.empty()) text = file.subspan(at + 8, size);
      if (type == kBinaryChunk && !has_glb_binary_) {
        glb_binary_ = file.subspan(at + 8, size);
        has_glb_binary_ = true;
      }
      at += 8 + size;
    }
    if (text.empty()) return refuse_file("The GLB has no JSON chunk.");
  }
  if (text.size() > kMaxJson) return refuse_file("The JSON of the glTF is larger than 256 MB.");
  json_ = json::parse(text.begin(), text.end(), nullptr, false);
  if (!json_.is_object())
    return refuse_file("This is not a glTF file: its text is not a JSON object.");
  return {};
}

bool GltfDocument::uses_required(const std::string& extension) const {
  const auto required = json_.find("extensionsRequired");
  return required != json_.end() && required->is_array() &&
         std::find(required->begin(), required->end(), extension) != required->end();
}

Result<void> GltfDocument::check_version_and_extensions() const {
  const std::string version = text_of(object_in(json_, "asset"), "version");
  if (!version.starts_with("2."))
    return refuse_file(version.empty()
                           ? "This is not a glTF file: it has no \"asset\" with a version."
                           : "The version of the glTF is not 2. Export it as glTF 2.0.");
  const auto required = json_.find("extensionsRequired");
  if (required == json_.end()) return {};
  if (!required->is_array())
    return refuse_file("In the glTF, \"extensionsRequired\" is not a list.");
  for (const json& name : *required) {
    if (!name.is_string())
      return refuse_file(
          "In the glTF, \"extensionsRequired\" contains an element that is not a name.");
    const auto& text = name.get_ref<const std::string&>();
    const bool known =
        text.starts_with("KHR_materials_") ||
        std::find(kKnownExtensions.begin(), kKnownExtensions.end(), text) != kKnownExtensions.end();
    if (!known)
      return refuse_file("The glTF requires the extension " + text.substr(0, 60) +
                         ", which the server does not support. Export the file without it.");
  }
  return {};
}

Result<const json*> GltfDocument::element(const char* array, std::uint64_t index) const {
  const auto found = json_.find(array);
  const std::size_t size = found != json_.end() && found->is_array() ? found->size() : 0;
  if (index < size && (*found)[index].is_object()) return &(*found)[index];
  return refuse_file("The glTF refers to index " + std::to_string(index) + " of \"" + array +
                     "\", but the number of elements is " + std::to_string(size) + ".");
}

Result<std::span<const std::uint8_t>> GltfDocument::buffer(std::uint64_t index) {
  const auto found = STRATA_TRY(element("buffers", index));
  const auto length = STRATA_TRY(whole_number(*found, "byteLength"));
  const std::string uri = text_of(*found, "uri"),
                    name = "Buffer " + std::to_string(index) + " of the glTF";
  std::span<const std::uint8_t> bytes;
  if (uri.empty()) {
    if (index != 0 || !has_glb_binary_)
      return refuse_file(name +
                         " has no data, neither in the file nor in another file of the upload.");
    bytes = glb_binary_;
  } else if (is_data_uri(uri)) {
    auto decoded = decoded_buffers_.find(index);
    if (decoded == decoded_buffers_.end()) {
      auto data = decode_data_uri(uri);
      if (!data) return refuse_file(name + " is a data URI that cannot be decoded.");
      decoded = decoded_buffers_.emplace(index, std::move(*data)).first;
    }
    bytes = decoded->second;
  } else {
    const std::string path = percent_decode_leniently(uri);
    const auto* file = files_->find(path);
    if (!file)
      return refuse_file(
          "The glTF stores its data in \"" + path.substr(0, 200) +
          "\", but the upload does not contain this file. Send this file too, or export a GLB "
          "file.");
    bytes = file->bytes;
  }
  if (length > bytes.size())
    return refuse_file(name + " should have " + std::to_string(length) + " bytes, but has " +
                       std::to_string(bytes.size()) +
                       ": the file is incomplete, or it is a different file.");
  return bytes.first(length);
}

Result<GltfDocument::View> GltfDocument::view(std::uint64_t index) {
  const auto found = STRATA_TRY(element("bufferViews", index));
  const json& view = *found;
  for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    if (const json& compressed = object_in(object_in(view, "extensions"), extension);
        !compressed.empty())
      return decompress(view, compressed, extension, index);
  const auto buffer_index = whole_number(view, "buffer"),
             offset = whole_number(view, "byteOffset", 0),
             length = whole_number(view, "byteLength"),
             stride = whole_number(view, "byteStride", 0);
  for (const auto* number : {&buffer_index, &offset, &length, &stride})
    if (!*number) return tl::unexpected(number->error());
  const auto bytes = STRATA_TRY(buffer(*buffer_index));
  if (*offset > bytes.size() || *length > bytes.size() - *offset)
    return refuse_file("Buffer view " + std::to_string(index) +
                       " of the glTF extends beyond the end of its buffer.");
  return View{bytes.subspan(*offset, *length), *stride};
}

Result<GltfDocument::View> GltfDocument::decompress(const json& view, const json& extension,
                                                    const std::string& extension_name,
                                                    std::uint64_t index) {
  const auto buffer_index = whole_number(extension, "buffer"),
             offset = whole_number(extension, "byteOffset", 0),
             length = whole_number(extension, "byteLength"),
             stride = whole_number(extension, "byteStride"),
             count = whole_number(extension, "count");
  for (const auto* number : {&buffer_index, &offset, &length, &stride, &count})
    if (!*number) return tl::unexpected(number->error());
  const std::string name = "Buffer view " + std::to_string(index) + " of the glTF";
  const View shape{{}, view.contains("byteStride") ? *stride : 0};
  if (const auto done = decoded_views_.find(index); done != decoded_views_.end())
    return View{done->second, shape.stride};
  const auto whole = STRATA_TRY(buffer(*buffer_index));
  if (*offset > whole.size() || *length > whole.size() - *offset)
    return refuse_file(name + " extends beyond the end of its buffer.");
  auto out =
      decode_meshopt(whole.subspan(*offset, *length),
                     {text_of(extension, "mode"), text_of(extension, "filter"), *count, *stride},
                     kMaxDecoded - decoded_bytes_);
  if (!out)
    return refuse_file(name + " is not valid data of " + extension_name + ": " + out.error() + ".");
  decoded_bytes_ += out->size();
  return View{decoded_views_.emplace(index, std::move(*out)).first->second, shape.stride};
}

Result<GltfDocument::Image> GltfDocument::image(std::uint64_t index) {
  const auto found = STRATA_TRY(element("images", index));
  const json& source = *found;
  Image image{text_of(source, "name"), {}, false};
  const std::string uri = text_of(source, "uri");
  if (is_data_uri(uri)) {
    auto data = decode_data_uri(uri);
    if (!data)
      return refuse_file("Image " + std::to_string(index) +
                         " of the glTF is a data URI that cannot be decoded.");
    image.bytes = std::move(*data);
  } else if (!uri.empty()) {
    const std::string path = percent_decode_leniently(uri);
    if (const auto* file = files_->find(path); file) {
      image.bytes.assign(file->bytes.begin(), file->bytes.end());
    } else {
      image.missing = true;
    }
    if (image.name.empty()) image.name = path;
  } else {
    const auto number = STRATA_TRY(whole_number(source, "bufferView"));
    const auto bytes = STRATA_TRY(view(number));
    image.bytes.assign(bytes.bytes.begin(), bytes.bytes.end());
  }
  return image;
}

}  // namespace strata::mesh
