#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "media/picture.h"
#include "mesh/io/join_parts.h"
#include "mesh/repair/scale_proposal.h"
#include "mesh/surface/search_tree.h"
#include "mesh/surface/simplify.h"
#include "mesh/texels/surface_map.h"
#include "support/mesh_files.h"
#include "support/zip_files.h"

namespace {

using namespace strata;
using test::load_texts;
using testing::ElementsAre;
using testing::HasSubstr;

const mesh::LoadOptions kAsParts{.parts = true};

std::string png_of(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  const std::vector<std::uint8_t> rgba{red, green, blue, 255};
  const auto png = encode_png(rgba, 1, 1);
  return {png.begin(), png.end()};
}

// A square of n × n quads in the plane z = `height`, as OBJ.
std::string square(int n, double height, const std::string& head = "") {
  std::string text = head;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x)
      text +=
          "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(height) + "\n";
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const int a = y * (n + 1) + x + 1, c = a + n + 1;
      text += "f " + std::to_string(a) + " " + std::to_string(a + 1) + " " + std::to_string(c + 1) +
              " " + std::to_string(c) + "\n";
    }
  return text;
}

// Three squares above each other. The atlas has a column for each part.
mesh::Geometry three_squares(int n) {
  auto loaded = load_texts(
      {{"a.obj", square(n, 0)}, {"b.obj", square(n, 5)}, {"c.obj", square(n, 9)}}, kAsParts);
  EXPECT_TRUE(loaded) << loaded.error().detail;
  mesh::Atlas atlas;
  for (std::size_t corner = 0; corner < loaded->mesh.triangles.size(); ++corner) {
    const glm::dvec3& position = loaded->mesh.positions[loaded->mesh.triangles[corner]];
    const double column = position.z == 0 ? 0 : position.z == 5 ? 1 : 2;
    atlas.corner_uvs.emplace_back((column + 0.05 + 0.9 * position.x / n) / 3,
                                  0.05 + 0.9 * position.y / n);
  }
  return mesh::build_geometry(loaded->mesh, atlas);
}

double height_of(const mesh::Geometry& geometry, std::uint32_t triangle) {
  return geometry.positions[geometry.vertices[geometry.indices[3 * triangle]].position_index].z;
}

void expect_parts(const mesh::Geometry& geometry) {
  ASSERT_EQ(geometry.part_ends.size(), 3u);
  EXPECT_EQ(geometry.part_ends.back(), geometry.triangle_count());
  for (std::uint32_t triangle = 0; triangle < geometry.triangle_count(); ++triangle) {
    const double heights[] = {0, 5, 9};
    ASSERT_EQ(height_of(geometry, triangle), heights[geometry.part_of(triangle)]) << triangle;
  }
}

TEST(Parts, have_the_names_and_folders_of_their_files) {
  const auto loaded = load_texts({{"Church/Tower/Outside/north.obj", square(2, 0)},
                                  {"Church/Nave.obj", square(1, 5)},
                                  {"Church\\Tower\\stairs.obj", square(1, 9)}},
                                 kAsParts);
  ASSERT_TRUE(loaded) << loaded.error().detail;
  ASSERT_EQ(loaded->parts.size(), 3u);
  EXPECT_EQ(loaded->parts[0].name, "Nave");
  EXPECT_EQ(loaded->parts[0].folder, "");
  EXPECT_EQ(loaded->parts[1].name, "stairs");
  EXPECT_EQ(loaded->parts[1].folder, "Tower");
  EXPECT_EQ(loaded->parts[2].name, "north");
  EXPECT_EQ(loaded->parts[2].folder, "Tower/Outside");
  EXPECT_EQ(loaded->parts[2].triangles, 8u);
  EXPECT_DOUBLE_EQ(loaded->parts[2].area, 4);
  EXPECT_EQ(loaded->parts[2].bounds_max, glm::dvec3(2, 2, 0));
  EXPECT_THAT(loaded->mesh.part_ends, ElementsAre(2, 4, 12));
}

TEST(Parts, with_equal_names_keep_their_extensions) {
  const auto loaded =
      load_texts({{"wall.obj", square(1, 0)},
                  {"wall.stl",
                   "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 5\nvertex 1 0 "
                   "5\nvertex 0 1 5\nendloop\nendfacet\nendsolid\n"}},
                 kAsParts);
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->parts[0].name, "wall.obj");
  EXPECT_EQ(loaded->parts[1].name, "wall.stl");
}

TEST(Parts, share_no_position_at_equal_coordinates) {
  const auto loaded = load_texts({{"a.obj", square(1, 0)}, {"b.obj", square(1, 0)}}, kAsParts);
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.positions.size(), 8u);
}

TEST(Parts, use_the_pictures_of_their_own_folders) {
  const std::string vertices =
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
      "usemtl skin\nf 1/1 2/2 3/3\n";
  const std::string material = "newmtl skin\nmap_Kd texture.png\n";
  const auto loaded = load_texts({{"a/a.obj", vertices},
                                  {"a/a.mtl", material},
                                  {"a/texture.png", png_of(200, 0, 0)},
                                  {"b/a.obj", vertices},
                                  {"b/a.mtl", material},
                                  {"b/texture.png", png_of(0, 0, 200)}},
                                 kAsParts);
  ASSERT_TRUE(loaded) << loaded.error().detail;
  const auto& mesh = loaded->mesh;
  ASSERT_EQ(mesh.textures.size(), 2u);
  EXPECT_EQ(mesh.textures[mesh.materials[mesh.triangle_materials[0]].texture].name,
            "a/texture.png");
  EXPECT_EQ(mesh.textures[mesh.materials[mesh.triangle_materials[1]].texture].name,
            "b/texture.png");
}

TEST(Parts, use_the_nearest_of_equally_named_pictures_and_none_of_other_scans) {
  const std::string vertices =
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
      "usemtl skin\nf 1/1 2/2 3/3\n";
  const std::string material = "newmtl skin\nmap_Kd texture.png\n";
  const auto loaded = load_texts({{"Tower/Inside/texture.png", png_of(0, 0, 200)},
                                  {"Tower/Inside/a.obj", square(1, 9)},
                                  {"Tower/a.obj", vertices},
                                  {"Tower/a.mtl", material},
                                  {"Tower/texture.png", png_of(200, 0, 0)},
                                  {"Nave/a.obj", vertices},
                                  {"Nave/a.mtl", material}},
                                 kAsParts);
  ASSERT_TRUE(loaded) << loaded.error().detail;
  const auto& mesh = loaded->mesh;
  ASSERT_EQ(mesh.textures.size(), 1u);
  EXPECT_EQ(mesh.textures[0].name, "Tower/texture.png");
  EXPECT_EQ(loaded->parts[0].folder, "Nave");
  EXPECT_EQ(mesh.materials[mesh.triangle_materials[0]].texture, -1)
      << "the picture of the tower does not belong to the nave";
}

TEST(Parts, take_the_only_picture_of_their_own_folder) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n";
  const auto loaded = load_texts({{"a/a.obj", vertices},
                                  {"a/photo.png", png_of(200, 0, 0)},
                                  {"b/b.obj", vertices},
                                  {"b/photo.png", png_of(0, 0, 200)},
                                  {"c.obj", vertices}},
                                 kAsParts);
  ASSERT_TRUE(loaded) << loaded.error().detail;
  ASSERT_EQ(loaded->mesh.textures.size(), 2u);
  EXPECT_EQ(loaded->mesh.triangle_materials[0], mesh::kNoMaterial) << "c is outside both folders";
  const auto flat = load_texts(
      {{"a.obj", vertices}, {"b.obj", vertices}, {"photo.png", png_of(200, 0, 0)}}, kAsParts);
  ASSERT_TRUE(flat) << flat.error().detail;
  EXPECT_TRUE(flat->mesh.textures.empty()) << "it may belong to either scan";
}

TEST(Parts, with_colours_of_vertices_keep_them_beside_textures) {
  const std::string colored =
      "mtllib m.mtl\nv 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 1 0 0\n"
      "usemtl gray\nf 1 2 3\n";
  const std::string textured = "v 0 0 5\nv 1 0 5\nv 1 1 5\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n";
  const auto loaded = load_texts({{"a/a.obj", colored},
                                  {"a/m.mtl", "newmtl gray\nKd 0.8 0.8 0.8\n"},
                                  {"b/b.obj", textured},
                                  {"b/b.png", png_of(0, 0, 200)}},
                                 kAsParts);
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->mesh.triangle_materials[0], mesh::kNoMaterial);
  EXPECT_EQ(loaded->mesh.vertex_colors[0], 0xff0000ffu);
}

TEST(Parts, keep_their_colours_without_those_of_others) {
  const std::string colored = "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 1 0 0\nf 1 2 3\n";
  const std::string material = "mtllib m.mtl\nv 0 0 5\nv 1 0 5\nv 1 1 5\nusemtl blue\nf 1 2 3\n";
  const auto loaded = load_texts({{"a.obj", colored},
                                  {"b.obj", material},
                                  {"m.mtl", "newmtl blue\nKd 0 0 1\n"},
                                  {"c.obj", square(1, 9)}},
                                 kAsParts);
  ASSERT_TRUE(loaded) << loaded.error().detail;
  const auto& colors = loaded->mesh.vertex_colors;
  ASSERT_EQ(colors.size(), 10u);
  EXPECT_EQ(colors[0], 0xff0000ffu);
  EXPECT_EQ(colors[3], 0xffff0000u);
  EXPECT_EQ(colors[6], 0xffcfd3d6u) << "stone gray";
}

TEST(Parts, in_different_units_get_the_first_stated_one) {
  const auto loaded = load_texts(
      {{"a.obj", square(1, 0, "# unit: mm\n")}, {"b.obj", square(1, 5, "# unit: m\n")}}, kAsParts);
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->unit, Unit::mm);
  EXPECT_EQ(loaded->parts[0].bounds_max, glm::dvec3(1, 1, 0));
  EXPECT_EQ(loaded->parts[1].bounds_max, glm::dvec3(1000, 1000, 5000));
  const ScaleProposal proposal = mesh::propose_scale(*loaded, "");
  EXPECT_EQ(proposal.unit, Unit::mm);
  EXPECT_EQ(proposal.up, "z");
}

TEST(Parts, that_do_not_fit_together_are_refused) {
  std::vector<mesh::LoadedPart> parts(2);
  parts[0].filename = "tower.las";
  parts[1].filename = "nave.las";
  parts[0].loaded.crs = "EPSG:25832";
  parts[1].loaded.crs = "EPSG:25833";
  const auto crs = mesh::join_parts(parts);
  ASSERT_FALSE(crs);
  EXPECT_THAT(crs.error().detail,
              HasSubstr("tower.las has EPSG:25832 and nave.las has EPSG:25833"));
  parts[1].loaded.crs.clear();
  EXPECT_TRUE(mesh::join_parts(parts));
  parts[0].loaded.up = "y";
  parts[1].loaded.up = "z";
  const auto up = mesh::join_parts(parts);
  ASSERT_FALSE(up);
  EXPECT_THAT(up.error().detail, HasSubstr("up direction"));
}

TEST(Parts, without_common_coordinates_are_refused) {
  std::string far = square(1, 0);
  for (std::size_t at = 0; (at = far.find("v ", at)) != std::string::npos; at += 2)
    far.insert(at + 2, "5300000");
  const auto loaded = load_texts({{"local.obj", square(1, 0)}, {"utm.obj", far}}, kAsParts);
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().detail, HasSubstr("local.obj and utm.obj"));
}

TEST(Parts, are_not_mixed_with_archives) {
  const std::string zip = test::zip_of({{"b.obj", square(1, 5)}});
  const auto mixed = load_texts({{"a.obj", square(1, 0)}, {"b.zip", zip}}, kAsParts);
  ASSERT_FALSE(mixed);
  EXPECT_EQ(mixed.error().field, "file");
  const auto zips = load_texts({{"a.zip", zip}, {"b.zip", zip}}, kAsParts);
  ASSERT_FALSE(zips);
  EXPECT_NE(zips.error().field, "parts") << "the page would offer the same again";
}

TEST(Parts, are_made_only_if_requested) {
  const std::vector<std::pair<std::string, std::string>> files{{"a.obj", square(1, 0)},
                                                               {"b.obj", square(1, 5)}};
  const auto refused = load_texts(files);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "parts");
  EXPECT_THAT(refused.error().detail, HasSubstr("`parts=true`"));
  const auto zipped = load_texts({{"a.zip", test::zip_of(files)}});
  ASSERT_FALSE(zipped);
  EXPECT_EQ(zipped.error().field, "parts");
  const auto loaded = load_texts({{"a.zip", test::zip_of(files)}}, kAsParts);
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->parts.size(), 2u);
  const auto one = load_texts({{"a.obj", square(1, 0)}}, kAsParts);
  ASSERT_TRUE(one);
  EXPECT_TRUE(one->parts.empty());
}

TEST(Parts, of_a_damaged_file_are_refused_with_its_name) {
  const auto loaded =
      load_texts({{"a.obj", square(1, 0)}, {"Tower/b.obj", "v 0 0 0\nf 1 2 99\n"}}, kAsParts);
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().detail, HasSubstr("Tower/b.obj: "));
}

TEST(Parts, are_limited_in_number) {
  std::vector<std::pair<std::string, std::string>> files;
  for (std::size_t i = 0; i <= kMaxModelParts; ++i)
    files.emplace_back(std::to_string(i) + ".obj", square(1, static_cast<double>(i)));
  const auto loaded = load_texts(files, kAsParts);
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().detail, HasSubstr("257 scans"));
  files.pop_back();
  EXPECT_TRUE(load_texts(files, kAsParts));
}

TEST(Parts, are_ranges_of_triangles_in_the_geometry_and_its_copies) {
  const mesh::Geometry geometry = three_squares(40);
  expect_parts(geometry);
  Progress progress;
  const auto coarser = mesh::simplify(geometry, 600, progress);
  ASSERT_TRUE(coarser) << coarser.error().detail;
  expect_parts(*coarser);
  // Every other triangle, the last part first.
  std::vector<std::uint32_t> some;
  for (std::size_t t = geometry.triangle_count(); t >= 2; t -= 2)
    some.insert(some.end(), geometry.indices.begin() + static_cast<std::ptrdiff_t>(3 * t - 6),
                geometry.indices.begin() + static_cast<std::ptrdiff_t>(3 * t - 3));
  expect_parts(mesh::with_triangles(geometry, some));
}

TEST(Parts, are_stored_with_the_geometry) {
  const mesh::Geometry geometry = three_squares(4);
  const auto bytes = mesh::encode_geometry(geometry);
  EXPECT_EQ(bytes[4], 3);
  const auto read = mesh::decode_geometry(bytes);
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(read->part_ends, geometry.part_ends);
  mesh::Geometry one = geometry;
  one.part_ends.clear();
  EXPECT_EQ(mesh::encode_geometry(one)[4], 2) << "readable by earlier servers";
}

TEST(Parts, that_are_damaged_are_refused) {
  const mesh::Geometry geometry = three_squares(4);
  for (const std::vector<std::uint32_t>& ends :
       {std::vector<std::uint32_t>{32, 64}, {64, 32, 96}, {40, 64, 96}, {32, 64, 97}}) {
    mesh::Geometry damaged = geometry;
    damaged.part_ends = ends;
    EXPECT_FALSE(mesh::decode_geometry(mesh::encode_geometry(damaged))) << ends.front();
  }
}

TEST(Parts, that_are_visible_form_ranges) {
  const mesh::Geometry geometry = three_squares(4);
  const auto ranges = [&](const char* hidden) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
    for (const auto [begin, end] : mesh::visible_ranges(geometry, PartSet(std::string(hidden))))
      all.emplace_back(begin, end);
    return all;
  };
  using Ranges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  EXPECT_EQ(ranges("000"), (Ranges{{0, 96}}));
  EXPECT_EQ(ranges("010"), (Ranges{{0, 32}, {64, 96}}));
  EXPECT_EQ(ranges("001"), (Ranges{{32, 96}}));
  EXPECT_EQ(ranges("111"), Ranges{});
  EXPECT_EQ(mesh::positions_without(geometry, PartSet(std::string("110"))).size(), 25u);
}

TEST(Parts, that_are_hidden_let_rays_pass) {
  const auto geometry = std::make_shared<const mesh::Geometry>(three_squares(4));
  const mesh::SearchTree tree(geometry);
  const glm::vec3 above = glm::vec3(glm::dvec3(1.3, 1.4, 20) - geometry->origin);
  const auto height = [&](const char* hidden) {
    const auto hit = tree.first_hit(above, {0, 0, -1}, PartSet(std::string(hidden)));
    return hit ? hit->position.z + geometry->origin.z : -1;
  };
  EXPECT_NEAR(height("000"), 9, 1e-5);
  EXPECT_NEAR(height("100"), 5, 1e-5);
  EXPECT_NEAR(height("110"), 0, 1e-5);
  EXPECT_EQ(height("111"), -1);
}

TEST(Parts, are_known_for_each_texel) {
  const mesh::Geometry geometry = three_squares(4);
  Progress progress;
  const auto map = mesh::bake_surface_map(geometry, 512, progress);
  ASSERT_TRUE(map);
  ASSERT_EQ(map->part.size(), map->packed_position.size());
  const double heights[] = {0, 5, 9};
  for (std::uint32_t slot = 0; slot < map->block_of_slot.size(); ++slot) {
    std::uint64_t owned = 0, found = 0;
    for (int texel = 0; texel < 64; ++texel) {
      const std::size_t at = std::size_t{slot} * 64 + static_cast<std::size_t>(texel);
      if (map->packed_position[at] == mesh::kNoPosition) continue;
      owned |= std::uint64_t{1} << texel;
      ASSERT_NEAR(map->position(slot, texel).z + geometry.origin.z, heights[map->part[at]], 1e-4);
    }
    for (std::size_t part = 0; part < 3; ++part) {
      const std::uint64_t texels = map->texels_of_parts(slot, PartSet().set(part));
      EXPECT_EQ(found & texels, 0u);
      found |= texels;
    }
    EXPECT_EQ(found & owned, owned);
  }
}

}  // namespace
