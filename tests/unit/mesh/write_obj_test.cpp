#include "mesh/io/write_obj.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "core/temporary_file.h"
#include "domain/scene/up.h"
#include "mesh/io/load.h"
#include "mesh/io/unpack.h"
#include "support/meshes.h"
#include "support/scene_models.h"

namespace strata::mesh {
namespace {

using test::geometry_of;

std::filesystem::path new_zip() {
  return std::filesystem::path(testing::TempDir()) / "write_obj_test.zip";
}

SceneModel obj_model(std::shared_ptr<const Geometry> geometry) {
  return test::scene_of<SceneModel>(std::move(geometry));
}

void write(const SceneModel& model, const TemporaryFile& file) {
  Progress progress;
  const auto bytes = write_obj(model, "pot", file.path, progress);
  ASSERT_TRUE(bytes) << bytes.error().detail;
  EXPECT_EQ(*bytes, std::filesystem::file_size(file.path));
}

// Returns the lines of a file in the zip.
std::vector<std::string> lines_of(const SceneModel& model, const std::string& name) {
  const TemporaryFile file(new_zip());
  write(model, file);
  Progress progress;
  const auto entries = unpack_archive(test::content_of(file.path), testing::TempDir(), progress);
  EXPECT_TRUE(entries) << entries.error().detail;
  std::vector<std::string> lines;
  for (const auto& entry : *entries) {
    if (entry.name != name) continue;
    std::istringstream text(std::string(entry.bytes.begin(), entry.bytes.end()));
    for (std::string line; std::getline(text, line);) lines.push_back(line);
  }
  return lines;
}

std::vector<glm::dvec3> triples_of(const std::vector<std::string>& lines,
                                   const std::string& keyword) {
  std::vector<glm::dvec3> found;
  for (const std::string& line : lines) {
    std::istringstream words(line);
    std::string first;
    glm::dvec3 place(0);
    words >> first >> place.x >> place.y >> place.z;
    if (first == keyword) found.push_back(place);
  }
  return found;
}

TEST(WriteObj, a_zip_that_is_loaded_again_has_the_same_surface) {
  int compared = 0;
  for (const auto& [name, mesh] : test::mesh_classes()) {
    SceneModel model = obj_model(geometry_of(mesh));
    model.metres_per_unit = 0.001;
    model.up = "y";
    const TemporaryFile file(new_zip());
    write(model, file);
    Progress progress;
    const auto loaded = load_mesh(file.path, "a.zip", progress);
    ASSERT_TRUE(loaded) << name << loaded.error().detail;
    // Loading repairs the meshes with faults, so they have another surface afterwards.
    if (std::ranges::any_of(loaded->repairs, is_fault)) continue;
    ++compared;
    EXPECT_EQ(loaded->mesh.triangle_count(), mesh.triangle_count()) << name;
    EXPECT_NEAR(surface_area(loaded->mesh), surface_area(mesh) * 1e-6, surface_area(mesh) * 1e-11)
        << name;
    EXPECT_EQ(loaded->mesh.positions.size(), model.geometry->positions.size())
        << name << ": corners at seams share a position";
    ASSERT_EQ(loaded->mesh.corner_uvs.size(), loaded->mesh.triangles.size()) << name;
    ASSERT_EQ(loaded->mesh.textures.size(), 1u) << name;
    EXPECT_EQ(loaded->mesh.textures[0].bytes, model.color.bytes) << name;
    ASSERT_EQ(loaded->mesh.materials.size(), 1u) << name;
    EXPECT_EQ(loaded->mesh.materials[0].name, "pot") << name;
    const double extent =
        glm::distance(glm::dvec3(model.geometry->box_min), glm::dvec3(model.geometry->box_max)) *
        model.metres_per_unit;
    for (std::size_t i = 0; i < model.geometry->indices.size(); ++i) {
      const Vertex& vertex = model.geometry->vertices[model.geometry->indices[i]];
      const glm::dvec3 place =
          model.geometry->positions[vertex.position_index] * model.metres_per_unit;
      ASSERT_LT(glm::distance(loaded->mesh.positions[loaded->mesh.triangles[i]], place),
                1e-9 * extent)
          << name;
      ASSERT_LT(glm::distance(loaded->mesh.corner_uvs[i], vertex.uv), 1e-6f) << name;
    }
  }
  EXPECT_GE(compared, 3);
}

TEST(WriteObj, up_becomes_y_and_the_front_faces_z_without_a_mirror) {
  const auto geometry = geometry_of(test::open_grid(4));
  for (const std::string_view up : kUpDirections) {
    SceneModel model = obj_model(geometry);
    model.up = up;
    model.metres_per_unit = 0.01;
    const auto lines = lines_of(model, "pot.obj");
    const auto places = triples_of(lines, "v"), normals = triples_of(lines, "vn");
    ASSERT_EQ(places.size(), geometry->positions.size());
    ASSERT_EQ(normals.size(), geometry->vertices.size());
    const UpFrame frame = up_frame(up);
    const auto turned = [&](const glm::dvec3& v) {
      return glm::dvec3(glm::dot(frame.right, v), glm::dot(frame.up, v), -glm::dot(frame.into, v));
    };
    for (std::size_t i = 0; i < places.size(); ++i)
      ASSERT_LT(glm::distance(places[i], turned(geometry->positions[i]) * 0.01), 1e-9) << up;
    for (std::size_t i = 0; i < normals.size(); ++i)
      ASSERT_LT(glm::distance(normals[i], turned(normal_of(geometry->vertices[i]))), 1e-3) << up;
  }
}

TEST(WriteObj, coordinates_far_from_the_origin_keep_the_precision_of_the_mesh) {
  const TriangleMesh mesh = test::far_triangle();
  const auto lines = lines_of(obj_model(geometry_of(mesh)), "pot.obj");
  const auto places = triples_of(lines, "v");
  ASSERT_EQ(places.size(), 3u);
  for (const glm::dvec3& place : places) {
    const bool known = std::ranges::any_of(mesh.positions, [&](const glm::dvec3& given) {
      return glm::distance(place, glm::dvec3(given.x, given.z, -given.y)) < 2e-9;
    });
    EXPECT_TRUE(known) << place.x << " " << place.y << " " << place.z;
  }
}

TEST(WriteObj, the_text_has_no_exponents_and_one_comment_a_line) {
  SceneModel model = obj_model(geometry_of(test::open_grid(4, 1e-9)));
  model.name = "Pot\n\\";
  model.copyright = "v 1 2 3 \\";
  const auto lines = lines_of(model, "pot.obj");
  ASSERT_FALSE(lines.empty());
  std::set<std::string> keywords;
  for (const std::string& line : lines) {
    keywords.insert(line.substr(0, line.find(' ')));
    if (line.starts_with('#')) {
      EXPECT_FALSE(line.ends_with('\\')) << line;
    } else {
      EXPECT_EQ(line.find_first_of("eE", 7), std::string::npos) << line;
    }
  }
  EXPECT_EQ(keywords, (std::set<std::string>{"#", "mtllib", "o", "v", "vt", "vn", "usemtl", "f"}));
}

TEST(WriteObj, the_material_names_the_texture_and_the_light) {
  SceneModel model = obj_model(geometry_of(test::open_grid(2)));
  auto lines = lines_of(model, "pot.mtl");
  EXPECT_EQ(lines.front(), "newmtl pot");
  EXPECT_EQ(lines.back(), "map_Kd pot.png");
  EXPECT_EQ(std::ranges::count(lines, "illum 1"), 1);
  model.color.media_type = "image/jpeg";
  model.unlit = true;
  lines = lines_of(model, "pot.mtl");
  EXPECT_EQ(lines.back(), "map_Kd pot.jpg");
  EXPECT_EQ(std::ranges::count(lines, "illum 0"), 1);
}

TEST(WriteObj, writing_ends_when_it_is_cancelled_or_the_disk_refuses) {
  const SceneModel model = obj_model(geometry_of(test::sphere(100)));
  for (const int question : {0, 3}) {
    test::CancelledAt cancelled(question);
    const TemporaryFile file(new_zip());
    const auto ended = write_obj(model, "pot", file.path, cancelled);
    ASSERT_FALSE(ended) << question;
    EXPECT_EQ(ended.error().code, ErrorCode::cancelled);
    EXPECT_FALSE(std::filesystem::exists(file.path));
  }
  Progress progress;
  const auto refused = write_obj(model, "pot", "/nowhere/a.zip", progress);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::storage_full);
}

}  // namespace
}  // namespace strata::mesh
