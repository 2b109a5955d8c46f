#include "jobs/companions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

namespace strata::jobs {
namespace {

namespace fs = std::filesystem;

class Companions : public testing::Test {
 protected:
  ~Companions() override { fs::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::vector<std::string> found(const std::string& mesh) {
    std::vector<std::string> names;
    for (const auto& file : with_companions(folder_ / mesh)) {
      EXPECT_TRUE(fs::is_regular_file(file.path)) << file.path;
      names.push_back(file.filename);
    }
    return names;
  }
  const fs::path folder_ =
      fs::temp_directory_path() / ("strata-companions-" + std::to_string(::getpid()));
};

TEST_F(Companions, an_obj_brings_its_libraries_and_their_textures) {
  write("scan.obj", "# x\nmtllib my scan.mtl\r\nv 0 0 0\n");
  write(
      "my scan.mtl",
      "newmtl a\n  map_Kd -s 1 1 1 C:\\work\\tex 1.jpg\nmap_Bump sub/normal.png\nmap_d lost.png\n");
  write("tex 1.jpg", "x");
  write("sub/normal.png", "x");
  EXPECT_THAT(found("scan.obj"),
              testing::ElementsAre("scan.obj", "my scan.mtl", "tex 1.jpg", "sub/normal.png"));
}

TEST_F(Companions, a_ply_brings_its_texture_files_and_a_gltf_its_buffers) {
  write(
      "a.ply",
      "ply\ncomment TextureFile a b.png\ncomment other.png\nend_header\ncomment TextureFile no.png\n");
  write("a b.png", "x");
  write("other.png", "x");
  write("no.png", "x");
  EXPECT_THAT(found("a.ply"), testing::ElementsAre("a.ply", "a b.png"));
  write(
      "b.gltf",
      R"({"buffers":[{"uri":"b%20c.bin"},{"uri":"data:,x"},{}],"images":[{"uri":"a b.png"},{"uri":7}]})");
  write("b c.bin", "x");
  EXPECT_THAT(found("b.gltf"), testing::ElementsAre("b.gltf", "b c.bin", "a b.png"));
}

TEST_F(Companions, nothing_outside_the_folder_is_taken) {
  write("in/scan.obj", "mtllib ../secret.mtl\nmtllib /etc/hostname\nmtllib ..\n");
  write("secret.mtl", "x");
  EXPECT_THAT(found("in/scan.obj"), testing::ElementsAre("scan.obj"));
}

TEST_F(Companions, damaged_files_bring_nothing) {
  write("a.gltf", "{");
  write("b.gltf", R"({"buffers":{},"images":[1,{"uri":"%"},{"uri":"%zz"},{"uri":""}]})");
  write("c.obj", "mtllib");
  write("d.stl", "mtllib c.obj");
  for (const char* name : {"a.gltf", "b.gltf", "c.obj", "d.stl"})
    EXPECT_THAT(found(name), testing::ElementsAre(name));
  EXPECT_EQ(with_companions(folder_ / "missing.obj").size(), 1u);
}

}  // namespace
}  // namespace strata::jobs
