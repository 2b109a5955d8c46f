#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>

#include "domain/scene/stroke.h"
#include "media/shape_texture.h"
#include "mesh/texels/packed_position.h"
#include "render/edit/block_test.h"

namespace strata::render {
namespace {

struct Block {
  std::array<std::uint64_t, 64> positions;
  mesh::SurfaceMap::PackedBox box;
};

// Returns texels around a point, some of them without a position.
Block random_block(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-1, 1);
  const glm::vec3 center(uniform(random), uniform(random), uniform(random));
  Block block;
  block.box = mesh::packed_box_of(center - 0.2f, center + 0.2f);
  for (auto& position : block.positions) {
    const glm::vec3 offset(uniform(random), uniform(random), uniform(random));
    position = random() % 8 == 0 ? mesh::kNoPosition
                                 : mesh::pack_position(center + offset * 0.19f, block.box);
  }
  return block;
}

// Returns a shape of dots of many sizes.
std::shared_ptr<const ShapeTexture> random_shape(std::mt19937& random) {
  ShapeBits bits{};
  for (int dot = 0; dot < 12; ++dot) {
    const int size = 1 << random() % 7, x0 = static_cast<int>(random() % 256),
              y0 = static_cast<int>(random() % 256);
    for (int y = y0; y < std::min(y0 + size, kShapeSide); ++y)
      for (int x = x0; x < std::min(x0 + size, kShapeSide); ++x)
        bits[std::size_t(y * kShapeSide + x) / 64] |= std::uint64_t{1} << (x % 64);
  }
  return std::make_shared<const ShapeTexture>(bits);
}

FacingLimit random_facing(std::mt19937& random) {
  Camera camera;
  camera.projection = glm::perspective(0.9, 200.0 / 120, 0.2, 9.0);
  return make_facing_limit(camera, std::uniform_real_distribution(10.0, 90.0)(random));
}

struct Stroke {
  StrokeBatch batch;
  ToolPath path;
  DepthCopy depth;
  BlockTest test;
  std::vector<std::uint32_t> segments;
};

void make_stroke(std::mt19937& random, Stroke& stroke) {
  const auto in = [&](double low, double high) {
    return std::uniform_real_distribution(low, high)(random);
  };
  constexpr int kWidth = 200, kHeight = 120;
  stroke.batch.camera.width = kWidth;
  stroke.batch.camera.height = kHeight;
  stroke.batch.shape = static_cast<ToolShape>(random() % 3);
  if (stroke.batch.shape == ToolShape::texture) stroke.batch.texture = random_shape(random);
  std::vector<double> radii;
  for (std::size_t i = 0; i < 1 + random() % 3; ++i) {
    stroke.batch.path.emplace_back(in(0, kWidth), in(0, kHeight));
    radii.push_back(in(5, 50));
  }
  stroke.path = make_tool_path(stroke.batch, radii);
  for (std::uint32_t i = 0; i < stroke.path.segments.size(); ++i) stroke.segments.push_back(i);
  std::vector<float> depth(std::size_t{kWidth} * kHeight);
  for (float& d : depth) d = static_cast<float>(in(0.85, 1.0));
  stroke.depth = make_depth_copy(std::move(depth), kWidth, kHeight, 1);
  stroke.test.clip_from_model =
      glm::mat4(glm::perspective(0.9, double{kWidth} / kHeight, 0.2, 9.0) *
                glm::lookAt(glm::dvec3(in(-3, 3), in(-3, 3), 2), {}, {0, 1, 0}));
  stroke.test.path = &stroke.path;
  stroke.test.depth = random() % 3 ? &stroke.depth : nullptr;
  stroke.test.width = kWidth;
  stroke.test.height = kHeight;
  stroke.test.shape = stroke.batch.shape;
  stroke.test.texture = stroke.batch.texture.get();
  if (random() % 3 == 0) stroke.test.facing = random_facing(random);
  stroke.test.bias = {{}, 1e-3, 1.5, 64.0};
  if (random() % 2 == 0) stroke.test.bias.fixed = 2e-4;
}

TEST(BlockTest, every_vector_unit_of_this_machine_decides_as_plain_code_but_for_rounding) {
  std::mt19937 random(11);
  long set = 0, differ = 0, decided = 0;
  for (int i = 0; i < 300; ++i) {
    Stroke stroke;
    make_stroke(random, stroke);
    for (int k = 0; k < 20; ++k) {
      const Block block = random_block(random);
      const auto bits = [&](VectorUnit unit) {
        return test_block_on(unit)(stroke.test, block.positions.data(), block.box, stroke.segments,
                                   false);
      };
      const std::uint64_t plain = bits(VectorUnit::plain);
      set += std::popcount(plain);
      decided += 64;
      for (const auto unit : {VectorUnit::avx2, VectorUnit::avx512})
        if (unit <= best_vector_unit()) differ += std::popcount(bits(unit) ^ plain);
      for (int t = 0; t < 64; ++t)
        ASSERT_FALSE(block.positions[std::size_t(t)] == mesh::kNoPosition && (plain >> t & 1))
            << "no surface there";
      // Without the test of the tool (`in_tool`), the stroke writes at least the same texels.
      const std::uint64_t in_tool = test_block_on(VectorUnit::plain)(
          stroke.test, block.positions.data(), block.box, stroke.segments, true);
      ASSERT_EQ(plain & ~in_tool, 0u);
    }
  }
  EXPECT_GT(set, decided / 50);
  EXPECT_LT(set, decided / 2);
  EXPECT_LE(differ * 10'000, decided);
}

TEST(BlockTest, texels_behind_the_eye_and_matrices_without_sense_write_nothing) {
  std::mt19937 random(5);
  Stroke stroke;
  make_stroke(random, stroke);
  stroke.test.depth = &stroke.depth;
  for (const float odd : {0.0f, std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity(), -1.0f}) {
    stroke.test.clip_from_model = glm::mat4(odd);
    for (int unit = 0; unit <= static_cast<int>(best_vector_unit()); ++unit) {
      const Block block = random_block(random);
      EXPECT_EQ(test_block_on(VectorUnit(unit))(stroke.test, block.positions.data(), block.box,
                                                stroke.segments, true),
                0u)
          << "matrix of " << odd << " on unit " << unit;
    }
  }
}

}  // namespace
}  // namespace strata::render
