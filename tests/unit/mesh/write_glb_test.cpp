#include "mesh/io/gltf/write_glb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "core/temporary_file.h"
#include "domain/scene/up.h"
#include "mesh/io/load.h"
#include "support/meshes.h"
#include "support/scene_models.h"

namespace strata::mesh {
namespace {

using nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

using test::dot;
using test::geometry_of;

GlbModel model_of(std::shared_ptr<const Geometry> geometry) {
  return test::scene_of<GlbModel>(std::move(geometry));
}

std::filesystem::path new_file() {
  return std::filesystem::path(testing::TempDir()) / "write_glb_test.glb";
}

Bytes written(const GlbModel& model) {
  Progress progress;
  const TemporaryFile file(new_file());
  const auto bytes = write_glb(model, file.path, progress);
  EXPECT_TRUE(bytes) << bytes.error().detail;
  Bytes content = test::content_of(file.path);
  EXPECT_EQ(content.size(), *bytes);
  return content;
}

template <class T>
T number_at(const Bytes& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

json json_of(const Bytes& file) {
  const auto length = number_at<std::uint32_t>(file, 12);
  return json::parse(file.begin() + 20, file.begin() + 20 + length);
}

// Returns the position in the scene: the matrix of the node times the position in model space.
glm::dvec3 in_scene(const json& document, const glm::dvec3& place) {
  const json& m = document["nodes"][0]["matrix"];
  glm::dvec3 out;
  for (int i = 0; i < 3; ++i)
    out[i] = m[i].get<double>() * place.x + m[4 + i].get<double>() * place.y +
             m[8 + i].get<double>() * place.z + m[12 + i].get<double>();
  return out;
}

TEST(WriteGlb, a_file_that_is_loaded_again_has_the_same_surface) {
  int compared = 0;
  for (const auto& [name, mesh] : test::mesh_classes()) {
    GlbModel model = model_of(geometry_of(mesh));
    model.metres_per_unit = 0.001;
    model.up = "y";
    Progress progress;
    const auto loaded = load_mesh_bytes(written(model), "a.glb", progress);
    ASSERT_TRUE(loaded) << name << loaded.error().detail;
    // Loading repairs the meshes with faults, so they have another surface afterwards.
    if (std::ranges::any_of(loaded->repairs, is_fault)) continue;
    ++compared;
    EXPECT_EQ(loaded->mesh.triangle_count(), mesh.triangle_count()) << name;
    EXPECT_NEAR(surface_area(loaded->mesh), surface_area(mesh) * 1e-6, surface_area(mesh) * 1e-11)
        << name;
    EXPECT_EQ(loaded->mesh.corner_uvs.size(), loaded->mesh.triangles.size()) << name;
    EXPECT_EQ(loaded->mesh.textures.size(), 1u) << name;
    for (std::size_t i = 0; i < model.geometry->indices.size(); ++i) {
      const Vertex& vertex = model.geometry->vertices[model.geometry->indices[i]];
      const glm::dvec3 place =
          (glm::dvec3(vertex.position) + model.geometry->origin) * model.metres_per_unit;
      ASSERT_LT(glm::distance(loaded->mesh.positions[loaded->mesh.triangles[i]], place), 1e-9)
          << name;
      ASSERT_LT(glm::distance(loaded->mesh.corner_uvs[i], vertex.uv), 1e-6f) << name;
    }
  }
  EXPECT_GE(compared, 3);
}

TEST(WriteGlb, up_becomes_y_and_the_front_faces_z_without_a_mirror) {
  const auto geometry = geometry_of(test::mesh_classes().front().mesh);
  for (const std::string_view up : kUpDirections) {
    GlbModel model = model_of(geometry);
    model.up = up;
    model.metres_per_unit = 0.01;
    const json document = json_of(written(model));
    const UpFrame frame = up_frame(up);
    const glm::dvec3 origin = in_scene(document, glm::dvec3(0));
    const auto direction = [&](const glm::dvec3& axis) {
      return (in_scene(document, axis) - origin) / model.metres_per_unit;
    };
    EXPECT_LT(glm::distance(direction(frame.up), glm::dvec3(0, 1, 0)), 1e-12) << up;
    EXPECT_LT(glm::distance(direction(-frame.into), glm::dvec3(0, 0, 1)), 1e-12) << up;
    EXPECT_LT(glm::distance(direction(frame.right), glm::dvec3(1, 0, 0)), 1e-12) << up;
    // The origin of the world stays the origin of the scene.
    EXPECT_LT(glm::length(in_scene(document, -geometry->origin)), 1e-9) << up;
  }
}

TEST(WriteGlb, coordinates_far_from_the_origin_keep_the_precision_of_the_mesh) {
  const auto geometry = geometry_of(test::far_triangle());
  const json document = json_of(written(model_of(geometry)));
  for (const Vertex& vertex : geometry->vertices) {
    const glm::dvec3 place = in_scene(document, glm::dvec3(vertex.position)),
                     given = geometry->positions[vertex.position_index];
    EXPECT_LT(glm::distance(place, glm::dvec3(given.x, given.z, -given.y)), 1e-7);
  }
}

TEST(WriteGlb, unlit_materials_have_a_rough_fallback) {
  GlbModel model = model_of(geometry_of(test::mesh_classes().front().mesh));
  EXPECT_FALSE(json_of(written(model)).contains("extensionsUsed"));
  model.unlit = true;
  model.copyright = "Museum";
  const json document = json_of(written(model));
  EXPECT_EQ(document["extensionsUsed"], json::array({"KHR_materials_unlit"}));
  EXPECT_FALSE(document.contains("extensionsRequired"));
  EXPECT_EQ(document["materials"][0]["pbrMetallicRoughness"]["metallicFactor"], 0);
  EXPECT_EQ(document["asset"]["copyright"], "Museum");
}

TEST(WriteGlb, features_have_a_texture_with_their_ids_and_a_property_table) {
  GlbModel model = model_of(geometry_of(test::mesh_classes().front().mesh));
  GlbFeatures& features = model.features.emplace();
  features = {"Finds", dot(), 2, 300, 65535, {}};
  FeatureProperty key{"key", FeatureProperty::Numbers(300, 7.0)};
  features.properties.push_back(std::move(key));
  const Bytes file = written(model);
  const json document = json_of(file);
  const json& ids =
      document["meshes"][0]["primitives"][0]["extensions"]["EXT_mesh_features"]["featureIds"][0];
  EXPECT_EQ(ids["featureCount"], 300);
  EXPECT_EQ(ids["nullFeatureId"], 65535);
  EXPECT_EQ(ids["propertyTable"], 0);
  EXPECT_EQ(ids["texture"],
            (json{{"index", 1}, {"texCoord", 0}, {"channels", json::array({0, 1})}}));
  EXPECT_EQ(document["samplers"][1]["minFilter"], 9728);
  const json& table = document["extensions"]["EXT_structural_metadata"]["propertyTables"][0];
  EXPECT_EQ(table["count"], 300);
  const json& view = document["bufferViews"][table["properties"]["key"]["values"].get<int>()];
  EXPECT_EQ(view["byteLength"], 2400);
  const std::size_t buffer = 28 + number_at<std::uint32_t>(file, 12);
  EXPECT_EQ(buffer % 8, 0u);
  for (const json& each : document["bufferViews"])
    EXPECT_EQ(each["byteOffset"].get<std::size_t>() % 8, 0u);
  EXPECT_EQ(number_at<double>(file, buffer + view["byteOffset"].get<std::size_t>()), 7.0);
}

TEST(WriteGlb, writing_ends_when_it_is_cancelled_or_the_disk_refuses) {
  const GlbModel model = model_of(geometry_of(test::mesh_classes().front().mesh));
  test::CancelledAt cancelled(0);
  const TemporaryFile file(new_file());
  const auto ended = write_glb(model, file.path, cancelled);
  ASSERT_FALSE(ended);
  EXPECT_EQ(ended.error().code, ErrorCode::cancelled);
  Progress progress;
  const auto refused = write_glb(model, "/nowhere/a.glb", progress);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::storage_full);
}

// ── property tables
// ────────────────────────────────────────────────────────────────────────────────

PropertyTable table_of(std::size_t count, const std::vector<FeatureProperty>& properties) {
  return property_table("Finds", count, properties, 10);
}
const json& described(const PropertyTable& table, const std::string& id) {
  return table.extension["schema"]["classes"]["feature"]["properties"].at(id);
}
const json& stored(const PropertyTable& table, const std::string& id) {
  return table.extension["propertyTables"][0]["properties"].at(id);
}
const Bytes& view_of(const PropertyTable& table, const json& index) {
  return table.views.at(index.get<std::size_t>() - 10);
}

TEST(PropertyTable, numbers_are_doubles_and_a_missing_number_is_no_data) {
  const auto table = table_of(2, {{"depth", FeatureProperty::Numbers{1.5, std::nullopt}},
                                  {"key", FeatureProperty::Numbers{1, 2}}});
  EXPECT_EQ(described(table, "depth")["type"], "SCALAR");
  EXPECT_EQ(described(table, "depth")["componentType"], "FLOAT64");
  EXPECT_EQ(described(table, "depth")["noData"], kNoNumber);
  EXPECT_EQ(json::parse(described(table, "depth")["noData"].dump()).get<double>(), kNoNumber);
  const Bytes& bytes = view_of(table, stored(table, "depth")["values"]);
  ASSERT_EQ(bytes.size(), 16u);
  EXPECT_EQ(number_at<double>(bytes, 0), 1.5);
  EXPECT_EQ(number_at<double>(bytes, 8), kNoNumber);
  EXPECT_EQ(described(table, "key")["required"], true);
  EXPECT_FALSE(described(table, "key").contains("noData"));
}

TEST(PropertyTable, texts_are_packed_with_offsets) {
  const auto table = table_of(3, {{"name", FeatureProperty::Texts{"Tür", "", "a"}}});
  EXPECT_EQ(described(table, "name")["type"], "STRING");
  const json& property = stored(table, "name");
  EXPECT_EQ(property["stringOffsetType"], "UINT32");
  const Bytes& text = view_of(table, property["values"]);
  EXPECT_EQ(std::string(text.begin(), text.end()), "Türa");
  const Bytes& offsets = view_of(table, property["stringOffsets"]);
  ASSERT_EQ(offsets.size(), 16u);
  for (const auto& [place, offset] :
       std::vector<std::pair<int, int>>{{0, 0}, {1, 4}, {2, 4}, {3, 5}})
    EXPECT_EQ(number_at<std::uint32_t>(offsets, 4 * std::size_t(place)), std::uint32_t(offset));
}

TEST(PropertyTable, flags_are_bits_unless_one_is_missing) {
  FeatureProperty::Flags flags(9, false);
  flags[0] = flags[8] = true;
  const auto table = table_of(9, {{"loose", flags}});
  EXPECT_EQ(described(table, "loose")["type"], "BOOLEAN");
  EXPECT_EQ(view_of(table, stored(table, "loose")["values"]), (Bytes{1, 1}));
  flags[1] = std::nullopt;
  const auto some = table_of(9, {{"loose", flags}});
  EXPECT_EQ(described(some, "loose")["type"], "ENUM");
  const Bytes& values = view_of(some, stored(some, "loose")["values"]);
  EXPECT_EQ(number_at<std::uint16_t>(values, 0), 1);
  EXPECT_EQ(number_at<std::uint16_t>(values, 2), 0xffff);
  EXPECT_EQ(number_at<std::uint16_t>(values, 4), 0);
}

TEST(PropertyTable, choices_are_an_enum) {
  const auto table =
      table_of(3, {{"state", FeatureProperty::Choices{{"good", "No data"}, {1, std::nullopt, 0}}}});
  const json& of_state = described(table, "state");
  EXPECT_EQ(of_state["noData"], "No data_");
  const json& type = table.extension["schema"]["enums"][of_state["enumType"].get<std::string>()];
  EXPECT_EQ(type["valueType"], "UINT16");
  EXPECT_EQ(type["values"], json::array({{{"name", "good"}, {"value", 0}},
                                         {{"name", "No data"}, {"value", 1}},
                                         {{"name", "No data_"}, {"value", 0xffff}}}));
  EXPECT_EQ(view_of(table, stored(table, "state")["values"]), (Bytes{1, 0, 0xff, 0xff, 0, 0}));
}

TEST(PropertyTable, names_become_different_identifiers_and_empty_properties_are_left_out) {
  const FeatureProperty::Texts texts{"x"};
  const auto table = table_of(1, {{"2nd-name", texts},
                                  {"2nd name", texts},
                                  {"", texts},
                                  {"größe", texts},
                                  {"nothing", FeatureProperty::Texts{""}},
                                  {"no_number", FeatureProperty::Numbers{std::nullopt}},
                                  {"no_flag", FeatureProperty::Flags{std::nullopt}},
                                  {"no_choice", FeatureProperty::Choices{{"a"}, {std::nullopt}}}});
  const json& properties = table.extension["propertyTables"][0]["properties"];
  std::vector<std::string> ids;
  for (const auto& [id, property] : properties.items()) ids.push_back(id);
  EXPECT_EQ(ids, (std::vector<std::string>{"_", "_2nd_name", "_2nd_name_", "gr____e"}));
  EXPECT_EQ(described(table, "_2nd_name")["name"], "2nd-name (_2nd_name)");
  EXPECT_EQ(table.views.size(), 8u);
}

TEST(PropertyTable, titles_and_units_are_for_people) {
  const FeatureProperty depth{"depth", FeatureProperty::Numbers{1.0}, "Depth of the find", "mm"};
  const FeatureProperty state{"state", FeatureProperty::Choices{{"good"}, {0}}, "Zustand", ""};
  const auto table = table_of(1, {depth, state});
  EXPECT_EQ(described(table, "depth")["name"], "Depth of the find");
  EXPECT_EQ(described(table, "depth")["description"], "Unit: mm");
  EXPECT_EQ(described(table, "state")["name"], "Zustand");
  EXPECT_FALSE(described(table, "state").contains("description"));
  EXPECT_EQ(table.extension["schema"]["enums"]["state"]["name"], "Zustand");
}

}  // namespace
}  // namespace strata::mesh
