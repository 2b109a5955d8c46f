#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "gl/debug_messages.h"
#include "gl/egl_context.h"
#include "gl/program.h"
#include "gl/shader_source.h"
#include "support/shader_dirs.h"

namespace strata::gl {
namespace {

namespace fs = std::filesystem;
using Variants = std::vector<std::vector<std::string>>;

// The files of every program of the server, and their defines.
const std::map<std::vector<std::string>, Variants> kPrograms{
    {{"mesh.vert", "depth_pass.frag"}, {{}, {"SECTION"}}},
    {{"mesh.vert", "gbuffer_pass.frag"},
     {{"LOOKS 0"},
      {"LIT_VERTICES", "LOOKS 4"},
      {"SECTION", "LIT_VERTICES", "LOOKS 0"},
      {"HEADLIGHT", "LOOKS 1"},
      {"RAKING_LIGHT", "LOOKS 4"},
      {"UNLIT", "LOOKS 2"},
      {"SECTION", "LOOKS 0"},
      {"SECTION", "RAKING_LIGHT", "LOOKS 4"}}},
    {{"cluster_cull_pass.comp"}, {{}}},
    {{"depth_grid_pass.comp"}, {{}}},
    {{"depth_gather_pass.comp"}, {{}}},
    {{"edit_cull_pass.comp"}, {{}}},
    {{"edit_pass.comp"},
     {{"TEXEL_FORMAT r8ui"},
      {"TEXEL_FORMAT r16ui"},
      {"TEXEL_FORMAT r32ui"},
      {"TOOL_TEXTURE", "TEXEL_FORMAT r8ui"},
      {"TOOL_TEXTURE", "TEXEL_FORMAT r16ui"},
      {"TOOL_TEXTURE", "TEXEL_FORMAT r32ui"}}},
    {{"tile_read_pass.comp"}, {{"TEXEL_BYTES 1"}, {"TEXEL_BYTES 2"}, {"TEXEL_BYTES 4"}}},
    {{"picture.vert", "accumulate_pass.frag"}, {{}}},
    {{"picture.vert", "background_pass.frag"}, {{}}},
    {{"picture.vert", "contact_shadow_pass.frag"}, {{}}},
    {{"feature_pass.vert", "feature_pass.frag"}, {{}}},
    {{"feature_sight_pass.comp"}, {{"CLOSE_GAPS 0"}, {"CLOSE_GAPS 1"}}},
    {{"picture.vert", "shade_pass.frag"},
     {{"CHUNK_COUNT 0"},
      {"CHUNK_COUNT 1"},
      {"CHUNK_COUNT 2"},
      {"CHUNK_COUNT 3"},
      {"CHUNK_COUNT 4"},
      {"CHUNK_COUNT 5"},
      {"CHUNK_COUNT 6"},
      {"CHUNK_COUNT 1", "OVER"},
      {"CHUNK_COUNT 1", "CUT", "LAYERS SHADE_LAYER(0u, 0u, 0u, 1u, 0u, 0u)"},
      {"CHUNK_COUNT 6", "OVER",
       "LAYERS SHADE_LAYER(0u, 0u, 7u, 1u, 1u, 0u) SHADE_LAYER(1u, 1u, 4u, 6u, 0u, 1u) SHADE_LAYER(2u, 2u, 6u, 63u, 2u, 2u)"}}},
};

TEST(Shaders, every_file_belongs_to_a_program_and_every_program_builds) {
  auto context = EglContext::create({.debug = true});
  ASSERT_TRUE(context) << context.error().detail;
  DebugMessages messages;
  messages.install();
  std::set<std::string> built;
  for (const auto& [files, variants] : kPrograms) {
    for (const auto& defines : variants) {
      const auto program = Program::load(test::shader_dir(), files, defines);
      EXPECT_TRUE(program) << program.error().detail;
    }
    built.insert(files.begin(), files.end());
  }
  for (const auto& entry : fs::directory_iterator(test::shader_dir())) {
    if (!entry.is_regular_file()) continue;
    EXPECT_TRUE(built.contains(entry.path().filename().string())) << entry.path();
  }
  EXPECT_EQ(messages.errors(), 0);
}

class ShaderSource : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(directory_ / "shared"); }
  void TearDown() override { fs::remove_all(directory_); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(directory_ / name) << text;
  }
  const fs::path directory_ =
      fs::temp_directory_path() / ("strata-shaders-" + std::to_string(::getpid()));
};

TEST_F(ShaderSource, an_include_is_put_in_once_and_defines_follow_the_version) {
  write("shared/a.h", "#pragma once\nconst int a = 1;\n");
  write("shared/b.h", "#include \"shared/a.h\"\nconst int b = a;\n");
  write("x.comp",
        "#version 450 core\n#include \"shared/a.h\"\n#include \"shared/b.h\"\nvoid main() {}\n");
  const auto text = load_shader(directory_, "x.comp", {"N 3"});
  ASSERT_TRUE(text) << text.error().detail;
  EXPECT_TRUE(text->starts_with("#version 450 core\n#define N 3\n"));
  EXPECT_EQ(text->find("const int a"), text->rfind("const int a"));
  EXPECT_EQ(text->find("#pragma"), std::string::npos);
}

TEST_F(ShaderSource, a_missing_file_and_an_include_outside_the_folder_are_told) {
  write("x.comp", "#version 450 core\n#include \"../secret\"\n");
  EXPECT_FALSE(load_shader(directory_, "x.comp"));
  const auto missing = load_shader(directory_, "no.comp");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().detail.find("no.comp"), std::string::npos);
}

TEST_F(ShaderSource, a_shader_that_does_not_compile_is_told_with_its_file) {
  auto context = EglContext::create({});
  ASSERT_TRUE(context);
  write("bad.comp",
        "#version 450 core\nlayout(local_size_x = 1) in;\nvoid main() { undeclared = 1; }\n");
  const auto program = Program::load(directory_, {"bad.comp"});
  ASSERT_FALSE(program);
  EXPECT_NE(program.error().detail.find("bad.comp"), std::string::npos);
  EXPECT_NE(program.error().detail.find("undeclared"), std::string::npos);
}

}  // namespace
}  // namespace strata::gl
