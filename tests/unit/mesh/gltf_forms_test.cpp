// Every format in which a glTF file may store an attribute, compared with the meaning of its
// numbers in the specification: glTF 2.0, 3.6.2 and 3.7.2.1, KHR_mesh_quantization,
// KHR_draco_mesh_compression, EXT_meshopt_compression and KHR_meshopt_compression. The test
// computes the expected values in double precision from the stored numbers.
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "media/picture.h"
#include "support/glb.h"
#include "support/mesh_files.h"

namespace {

using namespace strata;
using nlohmann::json;
using test::count_of;
using testing::HasSubstr;

constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123,
              kUnsignedInt = 5125, kFloat = 5126;
constexpr std::array kTypes{kByte, kUnsignedByte, kShort, kUnsignedShort, kUnsignedInt, kFloat};
constexpr int kVertices = 5;
// A pyramid without a base.
constexpr std::array<std::uint32_t, 12> kTriangles{0, 1, 4, 1, 3, 4, 3, 2, 4, 2, 0, 4};

int size_of(int type) { return type <= kUnsignedByte ? 1 : type <= kUnsignedShort ? 2 : 4; }
bool is_signed(int type) { return type == kByte || type == kShort; }
double largest(int type) {
  switch (type) {
    case kByte: return 127;
    case kUnsignedByte: return 255;
    case kShort: return 32767;
    case kUnsignedShort: return 65535;
    // The encoder of Draco has a table whose length is the largest value.
    case kUnsignedInt: return 1 << 16;
    default: return 1;
  }
}

// One attribute with its numbers as stored, vertex by vertex.
struct Attribute {
  std::string name;
  int type = kFloat, components = 3;
  bool normalized = false;
  std::vector<double> stored;
  bool beside_draco = false;

  double meaning(int vertex, int k, bool as_normalized) const {
    const double c = stored[static_cast<std::size_t>(vertex * components + k)];
    if (type >= kUnsignedInt || !as_normalized) return c;
    return is_signed(type) ? std::max(c / largest(type), -1.0) : c / largest(type);
  }
  double meaning(int vertex, int k) const { return meaning(vertex, k, normalized); }

  // Returns the elements with this stride, and zeros between them.
  std::vector<std::uint8_t> bytes(int stride) const {
    std::vector<std::uint8_t> out(static_cast<std::size_t>(stride * kVertices));
    for (int i = 0; i < kVertices; ++i)
      for (int k = 0; k < components; ++k)
        put(stored[static_cast<std::size_t>(i * components + k)],
            &out[i * stride + k * size_of(type)]);
    return out;
  }
  void put(double value, std::uint8_t* at) const {
    const auto store = [&](auto number) { std::memcpy(at, &number, sizeof number); };
    switch (type) {
      case kByte: return store(static_cast<std::int8_t>(value));
      case kUnsignedByte: return store(static_cast<std::uint8_t>(value));
      case kShort: return store(static_cast<std::int16_t>(value));
      case kUnsignedShort: return store(static_cast<std::uint16_t>(value));
      case kUnsignedInt: return store(static_cast<std::uint32_t>(value));
      default: return store(static_cast<float>(value));
    }
  }
  int size() const { return components * size_of(type); }
  std::string shape() const { return "VEC" + std::to_string(components); }
};

// Returns values that cover the whole range of the type, from shares of 0…1. This includes the
// lowest signed number, which is normalized to −1 like the next number.
Attribute attribute(const std::string& name, int type, int components, bool normalized) {
  static constexpr double kShares[kVertices][4] = {
      {0, 0, 0.2, 1}, {1, 0, 0.25, 0.5}, {0, 1, 0.5, 0.75}, {1, 1, 0.125, 0.25}, {0.5, 0.6, 1, 0}};
  Attribute made{name, type, components, normalized, {}, false};
  for (const auto& shares : kShares)
    for (int k = 0; k < components; ++k) {
      const double at = is_signed(type) ? 2 * shares[k] - 1 : shares[k];
      double value = type == kFloat ? double(float(at)) : std::round(at * largest(type));
      if (is_signed(type) && at == -1) value = -largest(type) - 1;
      made.stored.push_back(value);
    }
  return made;
}

enum class Store {
  plain,
  interleaved,
  draco_sequential,
  draco_edgebreaker,
  meshopt_ext,
  meshopt_khr,
  sparse,
  sparse_on_zeros,
  sparse_on_meshopt
};
constexpr std::array kStores{Store::plain,
                             Store::interleaved,
                             Store::draco_sequential,
                             Store::draco_edgebreaker,
                             Store::meshopt_ext,
                             Store::meshopt_khr,
                             Store::sparse,
                             Store::sparse_on_zeros,
                             Store::sparse_on_meshopt};
bool is_draco(Store store) {
  return store == Store::draco_sequential || store == Store::draco_edgebreaker;
}
bool is_sparse(Store store) { return store >= Store::sparse; }
std::string name_of(Store store) {
  static const std::array<std::string, 9> names{
      "plain",       "interleaved", "draco_sequential", "draco_edgebreaker", "meshopt_ext",
      "meshopt_khr", "sparse",      "sparse_on_zeros",  "sparse_on_meshopt"};
  return names[static_cast<std::size_t>(store)];
}

class File {
 public:
  // Makes a file whose last attribute is stored in the given format. The others are stored plainly.
  // With Draco, the stream contains all attributes and contradicts their accessors about
  // normalization.
  File(const std::vector<Attribute>& attributes, Store store, int index_type,
       bool quantization_named) {
    json primitive = {{"attributes", json::object()}};
    const bool second_uvs = std::any_of(attributes.begin(), attributes.end(),
                                        [](const auto& a) { return a.name == "TEXCOORD_1"; });
    if (second_uvs) primitive["material"] = material();
    for (const Attribute& a : attributes) {
      const bool has_that_form = is_draco(store) ? !a.beside_draco : &a == &attributes.back();
      const Store how = has_that_form ? store : Store::plain;
      primitive["attributes"][a.name] = add(a, how);
    }
    const bool last_is_indices =
        store != Store::plain && !is_draco(store) && index_type != 0 && attributes.size() == 1;
    primitive["indices"] = add_indices(index_type == 0 ? kUnsignedShort : index_type,
                                       last_is_indices || is_draco(store) ? store : Store::plain);
    if (is_draco(store))
      primitive["extensions"]["KHR_draco_mesh_compression"] = draco(attributes, store);
    if (quantization_named) require("KHR_mesh_quantization");
    builder_.json["meshes"] = json::array({{{"primitives", json::array({primitive})}}});
  }

  json& document() { return builder_.json; }
  Result<mesh::LoadedMesh> load() const { return test::load_text(builder_.glb(), "a.glb"); }

 private:
  void require(const char* extension) {
    auto& list = builder_.json["extensionsRequired"];
    if (std::find(list.begin(), list.end(), extension) == list.end()) list.push_back(extension);
  }

  int material() {
    const std::vector<std::uint8_t> rgba{200, 100, 50, 255};
    const auto png = encode_png(rgba, 1, 1);
    builder_.json["images"] = {
        {{"bufferView", builder_.add_view(png.data(), png.size())}, {"mimeType", "image/png"}}};
    builder_.json["textures"] = {{{"source", 0}}};
    builder_.json["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}}};
    return 0;
  }

  int add_accessor(json accessor) {
    builder_.json["accessors"].push_back(std::move(accessor));
    return static_cast<int>(builder_.json["accessors"].size()) - 1;
  }

  int add(const Attribute& a, Store store) {
    json accessor = {{"componentType", a.type},
                     {"count", kVertices},
                     {"type", a.shape()},
                     {"normalized", a.normalized}};
    if (is_draco(store)) return add_accessor(accessor);
    Attribute base = a;
    if (is_sparse(store)) {
      // Vertices 1 and 4 are wrong in the buffer view, and sparse values correct them.
      for (int k = 0; k < a.components; ++k)
        base.stored[static_cast<std::size_t>(a.components + k)] =
            base.stored[static_cast<std::size_t>(4 * a.components + k)] = 1;
      const bool zeros = store == Store::sparse_on_zeros;
      const std::vector<std::uint8_t> some{1, 4}, all{0, 1, 2, 3, 4};
      const auto& where = zeros ? all : some;
      std::vector<std::uint8_t> values;
      const auto bytes = a.bytes(a.size());
      for (const std::uint8_t i : where)
        values.insert(values.end(), bytes.begin() + i * a.size(),
                      bytes.begin() + (i + 1) * a.size());
      accessor["sparse"] = {
          {"count", where.size()},
          {"indices",
           {{"bufferView", builder_.add_view(where.data(), where.size())},
            {"componentType", kUnsignedByte}}},
          {"values", {{"bufferView", builder_.add_view(values.data(), values.size())}}}};
      if (zeros) return add_accessor(accessor);
    }
    // The strides of meshopt and of interleaved vertices are multiples of four bytes.
    const bool meshopt = store == Store::meshopt_ext || store == Store::meshopt_khr ||
                         store == Store::sparse_on_meshopt;
    const int stride = meshopt                       ? (a.size() + 3) / 4 * 4
                       : store == Store::interleaved ? (a.size() + 3) / 4 * 4 + 8
                                                     : a.size();
    const auto bytes = base.bytes(stride);
    accessor["bufferView"] =
        meshopt ? add_meshopt(bytes, stride, store) : builder_.add_view(bytes.data(), bytes.size());
    if (stride != a.size() || meshopt)
      builder_.json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteStride"] =
          stride;
    return add_accessor(accessor);
  }

  int add_compressed(const std::vector<unsigned char>& bytes, int stride, int count,
                     const char* mode, Store store) {
    const char* extension =
        store == Store::meshopt_khr ? "KHR_meshopt_compression" : "EXT_meshopt_compression";
    require(extension);
    const int view = builder_.add_view(bytes.data(), bytes.size());
    json& shown = builder_.json["bufferViews"][static_cast<std::size_t>(view)];
    shown["extensions"][extension] = {{"buffer", 0},
                                      {"byteOffset", shown["byteOffset"]},
                                      {"byteLength", bytes.size()},
                                      {"byteStride", stride},
                                      {"count", count},
                                      {"mode", mode}};
    shown["buffer"] = 7;  // uncompressed bytes that do not exist
    shown["byteOffset"] = 0;
    shown["byteLength"] = stride * count;
    return view;
  }
  int add_meshopt(const std::vector<std::uint8_t>& bytes, int stride, Store store) {
    std::vector<unsigned char> packed(
        meshopt_encodeVertexBufferBound(kVertices, static_cast<std::size_t>(stride)));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), bytes.data(), kVertices,
                                             static_cast<std::size_t>(stride)));
    return add_compressed(packed, stride, kVertices, "ATTRIBUTES", store);
  }

  int add_indices(int type, Store store) {
    json accessor = {{"componentType", type}, {"count", kTriangles.size()}, {"type", "SCALAR"}};
    if (is_draco(store)) return add_accessor(accessor);
    const Attribute numbers{"indices", type, 1, false, {}, false};
    std::vector<std::uint8_t> bytes(kTriangles.size() * static_cast<std::size_t>(size_of(type)));
    auto indices = kTriangles;
    if (is_sparse(store)) {
      const std::vector<std::uint16_t> where{2, 7};
      std::vector<std::uint8_t> values(2 * static_cast<std::size_t>(size_of(type)));
      for (std::size_t i = 0; i < 2; ++i) {
        numbers.put(kTriangles[where[i]], &values[i * static_cast<std::size_t>(size_of(type))]);
        indices[where[i]] = 3;
      }
      accessor["sparse"] = {
          {"count", 2},
          {"indices",
           {{"bufferView", builder_.add_view(where.data(), 4)}, {"componentType", kUnsignedShort}}},
          {"values", {{"bufferView", builder_.add_view(values.data(), values.size())}}}};
    }
    for (std::size_t i = 0; i < indices.size(); ++i)
      numbers.put(indices[i], &bytes[i * static_cast<std::size_t>(size_of(type))]);
    if (store == Store::meshopt_ext || store == Store::meshopt_khr) {
      std::vector<unsigned char> packed(meshopt_encodeIndexBufferBound(12, kVertices));
      packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), kTriangles.data(),
                                              kTriangles.size()));
      accessor["bufferView"] = add_compressed(packed, size_of(type), 12, "TRIANGLES", store);
    } else {
      accessor["bufferView"] = builder_.add_view(bytes.data(), bytes.size());
    }
    return add_accessor(accessor);
  }

  json draco(const std::vector<Attribute>& attributes, Store store) {
    static const std::map<int, draco::DataType> types{
        {kByte, draco::DT_INT8},          {kUnsignedByte, draco::DT_UINT8},
        {kShort, draco::DT_INT16},        {kUnsignedShort, draco::DT_UINT16},
        {kUnsignedInt, draco::DT_UINT32}, {kFloat, draco::DT_FLOAT32}};
    draco::Mesh mesh;
    mesh.set_num_points(kVertices);
    for (std::size_t i = 0; i < kTriangles.size(); i += 3)
      mesh.AddFace({draco::PointIndex(kTriangles[i]), draco::PointIndex(kTriangles[i + 1]),
                    draco::PointIndex(kTriangles[i + 2])});
    json ids = json::object();
    for (const Attribute& a : attributes) {
      if (a.beside_draco) continue;
      draco::GeometryAttribute shape;
      const auto kind = a.name == "POSITION"  ? draco::GeometryAttribute::POSITION
                        : a.name == "NORMAL"  ? draco::GeometryAttribute::NORMAL
                        : a.name == "COLOR_0" ? draco::GeometryAttribute::COLOR
                                              : draco::GeometryAttribute::TEX_COORD;
      shape.Init(kind, nullptr, static_cast<std::uint8_t>(a.components), types.at(a.type),
                 !a.normalized, a.size(), 0);
      const int id = mesh.AddAttribute(shape, true, kVertices);
      const auto bytes = a.bytes(a.size());
      for (int i = 0; i < kVertices; ++i)
        mesh.attribute(id)->SetAttributeValue(
            draco::AttributeValueIndex(static_cast<std::uint32_t>(i)),
            &bytes[static_cast<std::size_t>(i * a.size())]);
      ids[a.name] = mesh.attribute(id)->unique_id();
    }
    draco::Encoder encoder;
    encoder.SetEncodingMethod(store == Store::draco_sequential ? draco::MESH_SEQUENTIAL_ENCODING
                                                               : draco::MESH_EDGEBREAKER_ENCODING);
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh, &buffer).ok());
    require("KHR_draco_mesh_compression");
    return {{"bufferView", builder_.add_view(buffer.data(), buffer.size())}, {"attributes", ids}};
  }

  test::GltfBuilder builder_;
};

int color_byte_of_light(double value) {
  value = std::clamp(value, 0.0, 1.0);
  return static_cast<int>(std::lround(
      255 * (value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055)));
}

// The expected values of a corner, in the order x y z, u v (v counted from below), r g b a. NaN
// means no expected value.
using Corner = std::array<double, 9>;

Corner expected_corner(const std::vector<Attribute>& attributes, int vertex) {
  Corner corner;
  corner.fill(std::numeric_limits<double>::quiet_NaN());
  for (const Attribute& a : attributes) {
    if (a.name == "POSITION")
      for (int k = 0; k < 3; ++k) corner[k] = a.meaning(vertex, k);
    if (a.name.starts_with("TEXCOORD")) {
      corner[3] = a.meaning(vertex, 0);
      corner[4] = 1 - a.meaning(vertex, 1);
    }
    if (a.name != "COLOR_0") continue;
    // Integers without the normalized flag are forbidden. They are read as if they had the flag.
    for (int k = 0; k < 3; ++k) corner[5 + k] = color_byte_of_light(a.meaning(vertex, k, true));
    corner[8] = a.components == 4 ? std::round(255 * a.meaning(vertex, 3, true)) : 255;
  }
  return corner;
}

bool alike(const Corner& expected, const Corner& found) {
  for (std::size_t k = 0; k < expected.size(); ++k) {
    if (std::isnan(expected[k])) continue;
    // Single precision. A color that is halfway between two values may be rounded in either
    // direction.
    const double tolerance = k >= 5 ? 1 : 1.2e-7 * std::max(1.0, std::abs(expected[k]));
    if (!(std::abs(expected[k] - found[k]) <= tolerance)) return false;
  }
  return true;
}

// Finds each triangle of the pyramid, because encoders may rotate triangles and change their order.
void expect_the_pyramid(const mesh::TriangleMesh& mesh, const std::vector<Attribute>& attributes) {
  ASSERT_EQ(mesh.triangle_count(), 4u);
  std::vector<std::array<Corner, 3>> found(4);
  for (std::size_t i = 0; i < 12; ++i) {
    Corner& corner = found[i / 3][i % 3];
    corner.fill(-1e9);
    const auto index = mesh.triangles[i];
    for (int k = 0; k < 3; ++k) corner[k] = mesh.positions[index][k];
    if (!mesh.corner_uvs.empty()) {
      corner[3] = double(mesh.corner_uvs[i].x);
      corner[4] = double(mesh.corner_uvs[i].y);
    }
    for (int k = 0; k < 4 && !mesh.vertex_colors.empty(); ++k)
      corner[5 + k] = mesh.vertex_colors[index] >> (8 * k) & 255;
  }
  for (std::size_t t = 0; t < 12; t += 3) {
    std::array<Corner, 3> expected;
    for (std::size_t k = 0; k < 3; ++k)
      expected[k] = expected_corner(attributes, static_cast<int>(kTriangles[t + k]));
    bool is_there = false;
    for (const auto& triangle : found)
      for (std::size_t turn = 0; turn < 3; ++turn)
        is_there |= alike(expected[0], triangle[turn]) &&
                    alike(expected[1], triangle[(turn + 1) % 3]) &&
                    alike(expected[2], triangle[(turn + 2) % 3]);
    EXPECT_TRUE(is_there) << "triangle " << t / 3 << " begins at "
                          << testing::PrintToString(expected[0]) << "; the first found at "
                          << testing::PrintToString(found[0][0]);
  }
}

std::string case_name(const std::string& what, int type, bool normalized, Store store) {
  return what + " of " + std::to_string(type) + (normalized ? " normalised, " : ", ") +
         name_of(store);
}

struct Kind {
  std::string name;
  int components;
};
const std::vector<Kind> kKinds{{"POSITION", 3},   {"NORMAL", 3},  {"TEXCOORD_0", 2},
                               {"TEXCOORD_1", 2}, {"COLOR_0", 3}, {"COLOR_0", 4}};

std::vector<Attribute> with_positions(const Attribute& last) {
  if (last.name == "POSITION") return {last};
  return {attribute("POSITION", kFloat, 3, false), last};
}

TEST(MeshGltfForms, every_attribute_in_every_form_means_what_the_specification_says) {
  int read = 0, refused = 0;
  for (const Kind& kind : kKinds)
    for (const int type : kTypes)
      for (const bool normalized : {false, true})
        for (const Store store : kStores)
          for (const bool named : {false, true}) {
            SCOPED_TRACE(case_name(kind.name + " (" + std::to_string(kind.components) + ")", type,
                                   normalized, store));
            const auto attributes =
                with_positions(attribute(kind.name, type, kind.components, normalized));
            const auto loaded = File(attributes, store, 0, named).load();
            const bool is_color = kind.name == "COLOR_0";
            // These types are forbidden and have no clear meaning. Normals are never read, so no
            // format of normals is refused.
            if (kind.name != "NORMAL" && (type == kUnsignedInt || (is_color && is_signed(type)))) {
              ++refused;
              ASSERT_FALSE(loaded);
              EXPECT_THAT(loaded.error().detail, HasSubstr(kind.name + ") contains " +
                                                           (type == kUnsignedInt ? "UNSIGNED_INT"
                                                            : type == kByte      ? "BYTE"
                                                                                 : "SHORT") +
                                                           ", which glTF does not allow here"));
              continue;
            }
            ++read;
            ASSERT_TRUE(loaded) << loaded.error().detail;
            expect_the_pyramid(loaded->mesh, attributes);
            EXPECT_EQ(loaded->mesh.vertex_colors.empty(), !is_color);
            EXPECT_EQ(count_of(loaded->repairs,
                               "integer colors without a normalized flag, read as normalized"),
                      is_color && type != kFloat && !normalized ? 1u : 0u);
          }
  EXPECT_EQ(read, 972);
  EXPECT_EQ(refused, 324);
}

TEST(MeshGltfForms, indices_of_every_unsigned_type_are_read_and_others_refused) {
  for (const int type : kTypes)
    for (const Store store : kStores) {
      if (store == Store::interleaved || store == Store::sparse_on_zeros ||
          store == Store::sparse_on_meshopt)
        continue;
      SCOPED_TRACE(case_name("indices", type, false, store));
      const std::vector<Attribute> attributes{attribute("POSITION", kFloat, 3, false)};
      const bool meshopt = store == Store::meshopt_ext || store == Store::meshopt_khr;
      const bool is_index = type == kUnsignedByte || type == kUnsignedShort || type == kUnsignedInt;
      const auto loaded = File(attributes, store, type, false).load();
      if (is_draco(store) || (is_index && !(meshopt && type == kUnsignedByte))) {
        // In a Draco stream, indices have no type.
        ASSERT_TRUE(loaded) << loaded.error().detail;
        expect_the_pyramid(loaded->mesh, attributes);
        continue;
      }
      ASSERT_FALSE(loaded);
      // meshopt has no one-byte indices.
      EXPECT_THAT(loaded.error().detail,
                  HasSubstr(meshopt && size_of(type) == 1
                                ? "elements of 1 bytes are not possible in the mode TRIANGLES"
                                : "does not contain unsigned whole numbers"));
    }
}

TEST(MeshGltfForms, shapes_that_do_not_belong_to_an_attribute_are_refused) {
  const std::vector<std::pair<Kind, std::string>> wrong{
      {{"POSITION", 2}, "(POSITION) has 2 numbers per vertex; 3 are required"},
      {{"POSITION", 4}, "(POSITION) has 4 numbers"},
      {{"TEXCOORD_0", 3}, "(TEXCOORD_0) has 3 numbers per vertex; 2 are required"},
      {{"COLOR_0", 2}, "(COLOR_0) has 2 numbers per vertex; 3 or 4 are required"}};
  for (const auto& [kind, says] : wrong)
    for (const Store store : {Store::plain, Store::draco_sequential}) {
      const auto loaded = File(with_positions(attribute(kind.name, kFloat, kind.components, false)),
                               store, 0, false)
                              .load();
      ASSERT_FALSE(loaded) << kind.name;
      EXPECT_THAT(loaded.error().detail, HasSubstr(says));
    }
}

TEST(MeshGltfForms, a_draco_stream_that_differs_from_its_accessor_is_read_as_the_accessor_says) {
  // The stream stores bytes, but the accessor specifies shorts. The type of the accessor applies.
  const auto attributes = with_positions(attribute("TEXCOORD_0", kUnsignedByte, 2, true));
  File file(attributes, Store::draco_sequential, 0, false);
  file.document()["accessors"][1]["componentType"] = kUnsignedShort;
  const auto shorts = file.load();
  ASSERT_TRUE(shorts) << shorts.error().detail;
  Attribute as_shorts = attributes[1];
  as_shorts.type = kUnsignedShort;
  expect_the_pyramid(shorts->mesh, {attributes[0], as_shorts});
  // Without an accessor, the flag of the stream applies. This stream has not set it.
  file.document()["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_0");
  const auto alone = file.load();
  ASSERT_TRUE(alone) << alone.error().detail;
  Attribute as_stored = attributes[1];
  as_stored.normalized = false;
  expect_the_pyramid(alone->mesh, {attributes[0], as_stored});
  // Sparse values of the accessor belong to an uncompressed copy, which a file may have in addition
  // to the stream.
  file.document()["accessors"][0]["sparse"] = {{"count", 99}};
  EXPECT_TRUE(file.load());
  // The accessor and the stream must have the same number of components.
  File other(attributes, Store::draco_sequential, 0, false);
  other.document()["accessors"][0]["type"] = "VEC3";
  other.document()["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]
                  ["attributes"]["POSITION"] = 1;
  const auto refused = other.load();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().detail,
              HasSubstr("has 2 numbers per vertex for POSITION, but the accessor declares 3"));
}

TEST(MeshGltfForms, what_draco_leaves_out_is_read_beside_the_stream) {
  auto attributes = with_positions(attribute("COLOR_0", kUnsignedByte, 4, true));
  attributes[1].beside_draco = true;
  const auto loaded = File(attributes, Store::draco_sequential, 0, false).load();
  ASSERT_TRUE(loaded) << loaded.error().detail;
  expect_the_pyramid(loaded->mesh, attributes);
}

}  // namespace
