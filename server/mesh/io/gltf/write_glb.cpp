#include "mesh/io/gltf/write_glb.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <limits>
#include <span>

#include "core/version.h"

namespace strata::mesh {
namespace {

static_assert(std::endian::native == std::endian::little);

// The constants of the glTF 2.0 specification.
constexpr std::uint32_t kMagic = 0x46546c67, kVersion = 2, kJson = 0x4e4f534a, kBin = 0x004e4942;
constexpr int kFloat = 5126, kUnsignedInt = 5125, kArrayBuffer = 34962, kElementArray = 34963;
constexpr int kNearest = 9728, kLinear = 9729, kLinearMipmapLinear = 9987, kClampToEdge = 33071;
constexpr std::size_t kHeaderBytes = 12, kChunkBytes = 8;

// Position, normal and texture coordinates of a vertex.
constexpr std::size_t kVertexBytes = 8 * sizeof(float);
constexpr std::size_t kNormalOffset = 3 * sizeof(float), kUvOffset = 6 * sizeof(float);
// The required alignment of properties with 64 bits. All views have it.
constexpr std::size_t kAlignment = 8;
constexpr std::size_t kPieceBytes = 1u << 18;
constexpr std::size_t kMaxBytes = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t kMaxOtherBytes = std::size_t{1} << 30;  // textures and features

std::size_t aligned(std::size_t bytes) {
  return (bytes + kAlignment - 1) / kAlignment * kAlignment;
}

// Returns the matrix of the node, column by column.
nlohmann::json matrix_of(const GlbModel& model) {
  const auto rows = scene_axes(model);
  nlohmann::json matrix = nlohmann::json::array();
  const auto put = [&](double value) { matrix.push_back(value == 0 ? 0.0 : value); };  // no -0
  for (int column = 0; column < 3; ++column) {
    for (const glm::dvec3& row : rows) put(row[column] * model.metres_per_unit);
    put(0);
  }
  for (const glm::dvec3& row : rows)
    put(glm::dot(row, model.geometry->origin) * model.metres_per_unit);
  put(1);
  return matrix;
}

tl::unexpected<Error> unwritable() {
  return fail(ErrorCode::storage_full, "Model not written",
              "The disk of the server is full or not writable, so the file was not made. Free "
              "disk space, or choose a smaller texture.");
}

// The JSON of the file and the sizes of its buffer views.
class Document {
 public:
  explicit Document(const GlbModel& model) : model_(model) {
    const Geometry& geometry = *model.geometry;
    const std::size_t vertices = add_view({{"byteStride", kVertexBytes}, {"target", kArrayBuffer}},
                                          geometry.vertices.size() * kVertexBytes);
    const std::size_t indices =
        add_view({{"target", kElementArray}}, geometry.indices.size() * sizeof(std::uint32_t));
    add_accessors(vertices, indices);
    add_sampler(kLinear, kLinearMipmapLinear);
    add_image(model.color, "color");
    nlohmann::json material{
        {"name", model.name},
        {"pbrMetallicRoughness",
         {{"baseColorTexture", {{"index", 0}}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}},
        {"doubleSided", true}};
    if (model.unlit) {
      material["extensions"]["KHR_materials_unlit"] = nlohmann::json::object();
      extensions_.push_back("KHR_materials_unlit");
    }
    json_["materials"].push_back(std::move(material));
    nlohmann::json primitive{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}},
                             {"indices", 3},
                             {"material", 0}};
    if (model.features) primitive["extensions"] = add_features(*model.features);
    nlohmann::json mesh{{"name", model.name}};
    mesh["primitives"].push_back(std::move(primitive));
    json_["meshes"].push_back(std::move(mesh));
    json_["nodes"].push_back({{"name", model.name}, {"mesh", 0}, {"matrix", matrix_of(model)}});
    json_["scenes"].push_back({{"nodes", nlohmann::json::array({0})}});
    json_["scene"] = 0;
    json_["asset"] = {{"version", "2.0"}, {"generator", "Strata " + std::string(version())}};
    if (!model.copyright.empty()) json_["asset"]["copyright"] = model.copyright;
    if (!extensions_.empty()) json_["extensionsUsed"] = extensions_;
    json_["bufferViews"] = std::move(views_);
    json_["buffers"].push_back({{"byteLength", bytes_}});
  }

  std::size_t buffer_bytes() const { return bytes_; }
  const std::vector<std::vector<std::uint8_t>>& property_views() const { return properties_; }

  // Returns the text, padded so that the buffer has the alignment of its views in the file.
  std::string text() const {
    std::string text = json_.dump();
    const std::size_t before = kHeaderBytes + 2 * kChunkBytes;
    text.append(aligned(before + text.size()) - before - text.size(), ' ');
    return text;
  }

 private:
  std::size_t add_view(nlohmann::json view, std::size_t bytes) {
    view["buffer"] = 0;
    view["byteOffset"] = bytes_;
    view["byteLength"] = bytes;
    bytes_ += aligned(bytes);
    views_.push_back(std::move(view));
    return views_.size() - 1;
  }

  void add_accessors(std::size_t vertices, std::size_t indices) {
    const Geometry& geometry = *model_.geometry;
    glm::vec3 lowest(std::numeric_limits<float>::infinity()), highest = -lowest;
    for (const Vertex& vertex : geometry.vertices) {
      lowest = glm::min(lowest, vertex.position);
      highest = glm::max(highest, vertex.position);
    }
    const auto numbers = [](const glm::vec3& place) {
      return nlohmann::json::array({place.x, place.y, place.z});
    };
    const auto accessor = [&](std::size_t offset, const char* type) {
      return nlohmann::json{{"bufferView", vertices},
                            {"byteOffset", offset},
                            {"componentType", kFloat},
                            {"count", geometry.vertices.size()},
                            {"type", type}};
    };
    nlohmann::json position = accessor(0, "VEC3");
    position["min"] = numbers(lowest);
    position["max"] = numbers(highest);
    json_["accessors"].push_back(std::move(position));
    json_["accessors"].push_back(accessor(kNormalOffset, "VEC3"));
    json_["accessors"].push_back(accessor(kUvOffset, "VEC2"));
    json_["accessors"].push_back({{"bufferView", indices},
                                  {"componentType", kUnsignedInt},
                                  {"count", geometry.indices.size()},
                                  {"type", "SCALAR"}});
  }

  void add_sampler(int enlarged, int reduced) {
    json_["samplers"].push_back({{"magFilter", enlarged},
                                 {"minFilter", reduced},
                                 {"wrapS", kClampToEdge},
                                 {"wrapT", kClampToEdge}});
  }

  // Adds the image and its texture with the last sampler.
  void add_image(const SceneImage& image, const std::string& name) {
    const std::size_t view = add_view(nlohmann::json::object(), image.bytes.size());
    json_["images"].push_back(
        {{"name", name}, {"bufferView", view}, {"mimeType", image.media_type}});
    json_["textures"].push_back(
        {{"source", json_["images"].size() - 1}, {"sampler", json_["samplers"].size() - 1}});
  }

  // Adds the features to the file, and returns the extensions of the primitive.
  nlohmann::json add_features(const GlbFeatures& features) {
    add_sampler(kNearest, kNearest);
    add_image(features.ids, "feature ids");
    PropertyTable table =
        property_table(features.name, features.count, features.properties, views_.size());
    properties_ = std::move(table.views);
    for (const auto& bytes : properties_) add_view(nlohmann::json::object(), bytes.size());
    json_["extensions"]["EXT_structural_metadata"] = std::move(table.extension);
    extensions_.insert(extensions_.end(), {"EXT_mesh_features", "EXT_structural_metadata"});
    nlohmann::json channels = nlohmann::json::array();
    for (int channel = 0; channel < features.channels; ++channel) channels.push_back(channel);
    nlohmann::json ids{
        {"featureCount", features.count},
        {"nullFeatureId", features.none},
        {"texture",
         {{"index", json_["textures"].size() - 1}, {"texCoord", 0}, {"channels", channels}}},
        {"propertyTable", 0}};
    nlohmann::json extensions;
    extensions["EXT_mesh_features"]["featureIds"].push_back(std::move(ids));
    return extensions;
  }

  const GlbModel& model_;
  nlohmann::json json_ = nlohmann::json::object(), views_ = nlohmann::json::array();
  std::vector<std::string> extensions_;
  std::vector<std::vector<std::uint8_t>> properties_;
  std::size_t bytes_ = 0;
};

// Collects small values, and writes them in pieces.
class Output {
 public:
  Output(const std::filesystem::path& file, Progress& progress)
      : out_(file, std::ios::binary), progress_(progress) {}

  template <class T>
  void put(const T& value) {
    const auto* bytes = reinterpret_cast<const char*>(&value);
    piece_.insert(piece_.end(), bytes, bytes + sizeof value);
  }
  void put_bytes(std::span<const std::uint8_t> bytes) {
    send();
    out_.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    sent_ += bytes.size();
  }
  void put_text(const std::string& text) { piece_.insert(piece_.end(), text.begin(), text.end()); }
  // Adds zeros up to the next view.
  void align() { piece_.resize(piece_.size() + aligned(written()) - written(), 0); }
  // Writes a full piece. Returns false if the rest of the file is not needed.
  bool continues() {
    if (piece_.size() < kPieceBytes) return true;
    send();
    return out_.good() && !progress_.cancelled();
  }
  std::size_t written() const { return sent_ + piece_.size(); }

  Result<std::uint64_t> finish() {
    send();
    out_.close();
    if (progress_.cancelled()) return cancelled_problem();
    if (!out_) return unwritable();
    return sent_;
  }

 private:
  void send() {
    out_.write(piece_.data(), static_cast<std::streamsize>(piece_.size()));
    sent_ += piece_.size();
    piece_.clear();
  }

  std::ofstream out_;
  Progress& progress_;
  std::vector<char> piece_;
  std::size_t sent_ = 0;
};

// Writes the mesh. Returns false if the rest of the file is not needed.
bool put_mesh(const Geometry& geometry, Output& out) {
  for (const Vertex& vertex : geometry.vertices) {
    out.put(vertex.position);
    out.put(normal_of(vertex));
    // The origin of a glTF texture is the upper left corner.
    out.put(glm::vec2(vertex.uv.x, 1 - vertex.uv.y));
    if (!out.continues()) return false;
  }
  for (const std::uint32_t index : geometry.indices) {
    out.put(index);
    if (!out.continues()) return false;
  }
  out.align();
  return true;
}

}  // namespace

Result<void> check_glb_size(const Geometry& geometry) {
  if (kVertexBytes * geometry.vertices.size() + sizeof(std::uint32_t) * geometry.indices.size() <=
      kMaxBytes - kMaxOtherBytes)
    return {};
  return fail(ErrorCode::too_large, "Model too large",
              "The mesh has more than 3 GiB, and GLB files can have at most 4 GiB. Import the scan "
              "with fewer triangles, or get the mesh as `vertices.ply`.");
}

Result<std::uint64_t> write_glb(const GlbModel& model, const std::filesystem::path& file,
                                Progress& progress) {
  progress.report(0, "Writing the file");
  const Document document(model);
  const std::string text = document.text();
  const std::size_t bytes = kHeaderBytes + 2 * kChunkBytes + text.size() + document.buffer_bytes();
  if (bytes > kMaxBytes)
    return fail(ErrorCode::too_large, "Model too large",
                "The file would be larger than 4 GiB, which GLB files cannot be. Choose a smaller "
                "texture.");
  Output out(file, progress);
  out.put(kMagic);
  out.put(kVersion);
  out.put(static_cast<std::uint32_t>(bytes));
  out.put(static_cast<std::uint32_t>(text.size()));
  out.put(kJson);
  out.put_text(text);
  out.put(static_cast<std::uint32_t>(document.buffer_bytes()));
  out.put(kBin);
  if (put_mesh(*model.geometry, out)) {
    const auto put_view = [&](std::span<const std::uint8_t> view) {
      out.put_bytes(view);
      out.align();
    };
    put_view(model.color.bytes);
    if (model.features) put_view(model.features->ids.bytes);
    for (const auto& view : document.property_views()) put_view(view);
  }
  progress.report(1, "Writing the file");
  return out.finish();
}

}  // namespace strata::mesh
