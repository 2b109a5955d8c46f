#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <random>

#include "support/gl_scene.h"

namespace strata::test {
namespace {

std::shared_ptr<TileData> random_tile(ValueType type, unsigned seed) {
  std::mt19937 random(seed);
  auto tile = std::make_shared<TileData>(type);
  for (int i = 0; i < kTexelsPerTile; ++i) {
    const std::uint32_t bits = static_cast<std::uint32_t>(random());
    if (random() % 3 != 0) tile->write(i, bits);
  }
  return tile;
}

class EveryType : public testing::TestWithParam<ValueType> {};

TEST_P(EveryType, tiles_come_back_as_they_were_written_and_paint_keeps_bits) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 512);
  const auto layer = renderer.add_layer(renderer.add(scene), GetParam(), 512);
  const int bytes = bytes_per_texel(GetParam());
  std::vector<render::TileUpload> uploads;
  for (std::uint16_t y = 0; y < 4; ++y)
    for (std::uint16_t x = 0; x < 4; ++x)
      uploads.push_back({{x, y}, random_tile(GetParam(), x * 31u + y)});
  renderer.write(layer, uploads);

  const std::uint32_t value = bytes == 4 ? 0xfedcba98u : bytes == 2 ? 0xfedcu : 0xfeu;
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 512, 512, 0.5);
  const auto outcome = renderer.paint(layer, dab(camera, 256, 256, 150, value));
  ASSERT_GE(outcome.tiles.size(), 4u);
  for (const auto& tile : outcome.tiles) {
    TileData expected = *uploads[tile.address.y * 4u + tile.address.x].data;
    for (int i = 0; i < kTexelsPerTile; ++i) {
      if (tile.written.test(i)) expected.write(i, value);
    }
    EXPECT_EQ(tile.after, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Layers, EveryType,
                         testing::Values(ValueType::u8, ValueType::u16, ValueType::u32,
                                         ValueType::i8, ValueType::i16, ValueType::i32,
                                         ValueType::f16, ValueType::f32),
                         [](const auto& type) { return std::string(name(type.param)); });

TEST(Layers, an_empty_layer_of_8192_costs_less_than_a_mebibyte) {
  TestRenderer renderer;
  const auto model = renderer.add(make_scene(flat_square(), 256));
  const auto before = renderer->gpu_bytes_used();
  const auto layer = renderer.add_layer(model, ValueType::f32, 8192);
  EXPECT_LT(renderer->gpu_bytes_used() - before, 1u << 20);
  EXPECT_LT(renderer->layer_bytes_used(layer), 1u << 20);
  EXPECT_GT(renderer->layer_bytes_used(layer), 0u);
}

TEST(Layers, memory_grows_with_what_is_painted_and_is_freed_when_erased) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 1024);
  const auto layer = renderer.add_layer(renderer.add(scene), ValueType::u32, 1024);
  const auto empty = renderer->layer_bytes_used(layer);
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 1000, 1000, 0.5);
  const auto painted = renderer.paint(layer, dab(camera, 300, 300, 60, 9));
  const std::uint64_t page = kTexelsPerTile * 5;
  EXPECT_EQ(renderer->layer_bytes_used(layer), empty + painted.tiles.size() * page);
  auto eraser = dab(camera, 300, 300, 70);
  eraser.erase = true;
  renderer.paint(layer, eraser);
  EXPECT_EQ(renderer->layer_bytes_used(layer), empty);
  // The pages of the erased texels are reused. They must not contain the erased texels.
  const auto pool = renderer->gpu_bytes_used();
  const auto again = renderer.paint(layer, dab(camera, 700, 700, 60, 9));
  EXPECT_EQ(renderer->gpu_bytes_used(), pool);
  for (const auto& tile : again.tiles) {
    for (int i = 0; i < kTexelsPerTile; ++i)
      ASSERT_EQ(tile.after.valid.test(i), tile.written.test(i));
  }
}

TEST(Layers, an_empty_tile_frees_its_page) {
  TestRenderer renderer;
  const auto layer =
      renderer.add_layer(renderer.add(make_scene(flat_square(), 512)), ValueType::u8, 512);
  const auto empty = renderer->layer_bytes_used(layer);
  renderer.write(
      layer, {{{1, 1}, random_tile(ValueType::u8, 1)}, {{2, 1}, random_tile(ValueType::u8, 2)}});
  EXPECT_EQ(renderer->layer_bytes_used(layer), empty + 2u * kTexelsPerTile * 2);
  renderer.write(layer, {{{1, 1}, nullptr}, {{2, 1}, std::make_shared<TileData>(ValueType::u8)}});
  EXPECT_EQ(renderer->layer_bytes_used(layer), empty);
}

TEST(Layers, removing_a_layer_or_a_model_gives_its_memory_back) {
  TestRenderer renderer;
  const auto scene = make_scene(flat_square(), 512);
  const auto start = renderer->gpu_bytes_used();
  const auto model = renderer.add(scene);
  const auto layer = renderer.add_layer(model, ValueType::u8, 512);
  renderer.write(layer, {{{1, 1}, random_tile(ValueType::u8, 1)}});
  renderer->remove_layer(layer);
  renderer->run_on_gpu_thread_for_test([] {});
  EXPECT_EQ(renderer->layer_bytes_used(layer), 0u);
  const auto with_pool = renderer->gpu_bytes_used();
  renderer->remove_model(model);
  renderer->run_on_gpu_thread_for_test([] {});
  EXPECT_LT(renderer->gpu_bytes_used(), with_pool);
  EXPECT_GE(renderer->gpu_bytes_used(), start);
  const auto gone = await<render::LayerHandle>(
      [&](auto done) { renderer->add_layer(model, ValueType::u8, 512, std::move(done)); });
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().code, ErrorCode::not_found);
}

TEST(Layers, memory_of_removed_layers_serves_layers_of_other_widths) {
  render::RendererOptions options;
  // One slice of four-byte pages takes 20 MiB. One slice of one-byte pages takes 8 MiB.
  options.gpu_memory_bytes = 24u << 20;
  TestRenderer renderer(options);
  const auto model = renderer.add(make_scene(flat_square(), 256));
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 200, 200, 0.5);
  const auto view = renderer.add_view(model);
  for (int round = 0; round < 2; ++round) {
    const auto wide = renderer.add_layer(model, ValueType::f32, 256),
               narrow = renderer.add_layer(model, ValueType::u8, 256);
    const auto painted = renderer.paint(wide, dab(camera, 100, 100, 40, 0x3f800000));
    const auto refused = await<render::StrokeOutcome>(
        [&](auto done) { renderer->paint(narrow, dab(camera, 100, 100, 40), std::move(done)); });
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
    renderer->remove_layer(wide);
    const auto outcome = renderer.paint(narrow, dab(camera, 100, 100, 40));
    EXPECT_EQ(outcome.tiles.size(), painted.tiles.size());
    EXPECT_LE(renderer->gpu_bytes_used(), options.gpu_memory_bytes);
    render::FrameRequest request;
    request.view = view;
    request.camera = camera;
    request.width = request.height = 200;
    request.style.layers = {
        {narrow, std::make_shared<Palette>(default_palette(ValueType::u8, true)), 1}};
    const auto picture = renderer.draw(request);
    EXPECT_NE(picture.pixels[4 * (100 * 200 + 100)], picture.pixels[4 * (100 * 200 + 10)])
        << "the paint is seen";
    renderer->remove_layer(narrow);
  }
}

// Layers of 16 × 16 four-byte tiles with mirrors. Each layer takes one chunk, and the memory has
// space for two chunks.
class Leaving : public testing::Test {
 protected:
  static constexpr int kResolution = 2048, kTilesPerSide = kResolution / kTileSize;
  // Memory for the model, for two chunks of 256 four-byte pages (20 MiB each), and for views.
  static render::RendererOptions options() {
    static const std::uint64_t model_bytes = [] {
      TestRenderer renderer;
      renderer.add(make_scene(flat_square(), kResolution));
      return renderer->gpu_bytes_used();
    }();
    render::RendererOptions options;
    options.gpu_memory_bytes = model_bytes + (48u << 20);
    return options;
  }

  struct Mirrored {
    std::shared_ptr<TileMirror> mirror;
    render::LayerHandle handle = 0;
  };
  // Makes a layer and fills it with `value`.
  Mirrored add(std::uint32_t value) {
    Mirrored layer{std::make_shared<TileMirror>(ValueType::u32, kResolution)};
    auto tile = std::make_shared<TileData>(ValueType::u32);
    for (int i = 0; i < kTexelsPerTile; ++i) tile->write(i, value);
    TileMap tiles;
    for (std::uint16_t y = 0; y < kTilesPerSide; ++y)
      for (std::uint16_t x = 0; x < kTilesPerSide; ++x) tiles[{x, y}] = tile;
    layer.mirror->put(tiles, 1);
    layer.handle = *await<render::LayerHandle>(
        [&](auto done) { renderer_->add_layer(model_, layer.mirror, std::move(done)); });
    return layer;
  }
  Result<render::SharedFrame> draw(std::initializer_list<Mirrored> layers) {
    render::FrameRequest request;
    request.view = view_;
    request.camera = camera_;
    request.width = request.height = 200;
    auto palette = std::make_shared<Palette>(default_palette(ValueType::u32, true));
    for (const Mirrored& layer : layers) request.style.layers.push_back({layer.handle, palette, 1});
    return await<render::SharedFrame>(
        [&](auto done) { renderer_->draw(request, std::move(done)); });
  }
  static std::array<int, 3> middle(const Result<render::SharedFrame>& frame) {
    if (!frame) return {-1, -1, -1};
    const auto* pixel = (*frame)->pixels.data() + 4 * (100 * 200 + 100);
    return {pixel[0], pixel[1], pixel[2]};
  }
  bool is_here(const Mirrored& layer) {
    return renderer_->layer_bytes_used(layer.handle) > (1u << 20);
  }

  TestRenderer renderer_{options()};
  render::ModelHandle model_ = renderer_.add(make_scene(flat_square(), kResolution));
  render::ViewHandle view_ = renderer_.add_view(model_);
  Camera camera_ = orthographic_camera({0, 0, 2}, {0, 0, 0}, 200, 200, 0.5);
};

TEST_F(Leaving, a_layer_comes_to_the_gpu_when_it_is_first_shown) {
  const auto layer = add(7);
  EXPECT_FALSE(is_here(layer));
  const auto bare = middle(draw({}));
  EXPECT_FALSE(is_here(layer));
  EXPECT_NE(middle(draw({layer})), bare);
  EXPECT_TRUE(is_here(layer));
}

TEST_F(Leaving, layers_that_nobody_looks_at_make_room_for_those_that_are_shown) {
  const auto first = add(1), second = add(5), third = add(9);
  const auto of_first = middle(draw({first}));
  const auto of_second = middle(draw({second}));
  EXPECT_NE(of_first, of_second);
  for (int round = 0; round < 3; ++round) {
    draw({third});
    EXPECT_EQ(middle(draw({first})), of_first);
    EXPECT_EQ(middle(draw({second})), of_second);
    EXPECT_LE(renderer_->gpu_bytes_used(), options().gpu_memory_bytes);
  }
  EXPECT_FALSE(is_here(first) && is_here(second) && is_here(third));
}

TEST_F(Leaving, more_layers_at_once_than_there_is_memory_for_are_refused) {
  const auto a = add(1), b = add(3), c = add(9);
  const auto refused = draw({a, b, c});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
  EXPECT_TRUE(draw({a})) << "the refused ones are let go";
}

TEST_F(Leaving, what_is_painted_lies_over_what_the_layer_holds) {
  const auto layer = add(3), other = add(1), third = add(2);
  const auto outcome = renderer_.paint(layer.handle, dab(camera_, 100, 100, 20, 8));
  ASSERT_FALSE(outcome.tiles.empty());
  TileMap after;
  for (const auto& tile : outcome.tiles) {
    after[tile.address] = std::make_shared<const TileData>(tile.after);
    for (int i = 0; i < kTexelsPerTile; ++i)
      ASSERT_EQ(tile.after.bits(i), tile.written.test(i) ? 8u : 3u) << "texel " << i;
  }
  layer.mirror->put(after, 2);
  const auto painted = middle(draw({layer}));
  draw({other});
  draw({third});
  EXPECT_FALSE(is_here(layer));
  EXPECT_EQ(middle(draw({layer})), painted) << "after it has left and come again";
}

TEST_F(Leaving, a_layer_that_knows_more_than_its_mirror_stays) {
  const auto layer = add(3), other = add(1), third = add(2);
  auto hold = layer.mirror->hold();
  renderer_.paint(layer.handle, dab(camera_, 100, 100, 20, 8));
  const auto painted = middle(draw({layer}));
  draw({other});
  draw({third});
  EXPECT_TRUE(is_here(layer));
  EXPECT_EQ(middle(draw({layer})), painted);
  hold.reset();
  draw({other});
  draw({third});
  EXPECT_FALSE(is_here(layer)) << "the mirror is held no more";
}

TEST_F(Leaving, tiles_are_written_over_what_the_layer_holds) {
  const auto layer = add(3);
  auto tile = std::make_shared<TileData>(ValueType::u32);
  renderer_.write(layer.handle, {{{0, 0}, tile}});
  EXPECT_EQ(renderer_->layer_bytes_used(layer.handle),
            std::uint64_t{kTilesPerSide * kTilesPerSide} * 4 +
                std::uint64_t{kTilesPerSide * kTilesPerSide - 1} * kTexelsPerTile * 5);
}

TEST(Layers, tiles_that_do_not_all_fit_leave_the_layer_as_it_was) {
  render::RendererOptions options;
  options.gpu_memory_bytes = 24u << 20;  // 256 four-byte pages
  TestRenderer renderer(options);
  const auto layer =
      renderer.add_layer(renderer.add(make_scene(flat_square(), 256)), ValueType::u32, 4096);
  const auto empty = renderer->layer_bytes_used(layer);
  std::vector<render::TileUpload> tiles;
  const auto tile = random_tile(ValueType::u32, 1);
  for (std::uint16_t i = 0; i < 300; ++i)
    tiles.push_back(
        {{static_cast<std::uint16_t>(i % 32), static_cast<std::uint16_t>(i / 32)}, tile});
  const auto refused =
      await<void>([&](auto done) { renderer->write_tiles(layer, tiles, std::move(done)); });
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
  EXPECT_EQ(renderer->layer_bytes_used(layer), empty);
  tiles.resize(256);
  renderer.write(layer, tiles);
}

TEST(Layers, painting_beyond_the_memory_budget_is_refused_and_changes_nothing) {
  render::RendererOptions options;
  options.gpu_memory_bytes = 12u << 20;  // too little for a chunk of four-byte pages
  TestRenderer renderer(options);
  const auto scene = make_scene(flat_square(), 256);
  const auto layer = renderer.add_layer(renderer.add(scene), ValueType::u32, 256);
  const auto empty = renderer->layer_bytes_used(layer);
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 200, 200, 0.5);
  const auto refused = await<render::StrokeOutcome>(
      [&](auto done) { renderer->paint(layer, dab(camera, 100, 100, 40), std::move(done)); });
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::out_of_memory);
  EXPECT_NE(refused.error().detail.find("budget of 12 MiB of GPU memory is exhausted"),
            std::string::npos)
      << refused.error().detail;
  EXPECT_EQ(renderer->layer_bytes_used(layer), empty);
  const auto tile = await<void>([&](auto done) {
    renderer->write_tiles(layer, {{{0, 0}, random_tile(ValueType::u32, 1)}}, std::move(done));
  });
  EXPECT_FALSE(tile);
}

TEST(Layers, tiles_of_another_type_or_place_are_refused) {
  TestRenderer renderer;
  const auto layer =
      renderer.add_layer(renderer.add(make_scene(flat_square(), 256)), ValueType::u16, 256);
  for (const render::TileUpload& wrong :
       {render::TileUpload{{2, 0}, random_tile(ValueType::u16, 1)},
        render::TileUpload{{0, 0}, random_tile(ValueType::u8, 1)}}) {
    const auto result =
        await<void>([&](auto done) { renderer->write_tiles(layer, {wrong}, std::move(done)); });
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::invalid);
  }
}

TEST(Layers, pages_that_fill_several_chunks_keep_their_content) {
  TestRenderer renderer;
  // The 1024 tiles of 4096² fill the chunks of 1 and 2 slices and a part of the chunk of 4 slices.
  const auto scene = make_scene(flat_square(), 4096);
  const auto layer = renderer.add_layer(renderer.add(scene), ValueType::u8, 4096);
  std::vector<render::TileUpload> uploads;
  for (std::uint16_t y = 0; y < 32; ++y)
    for (std::uint16_t x = 0; x < 32; ++x)
      uploads.push_back({{x, y}, random_tile(ValueType::u8, y * 32u + x)});
  renderer.write(layer, uploads);
  const auto camera = orthographic_camera({0, 0, 2}, {0, 0, 0}, 512, 512, 0.5);
  auto stroke = dab(camera, 0, 0, 3, 200);
  stroke.path = {{40, 40}, {470, 470}, {470, 40}};
  const auto outcome = renderer.paint(layer, stroke);
  ASSERT_GT(outcome.tiles.size(), 30u);
  for (const auto& tile : outcome.tiles) {
    TileData expected = *uploads[tile.address.y * 32u + tile.address.x].data;
    for (int i = 0; i < kTexelsPerTile; ++i) {
      if (tile.written.test(i)) expected.write(i, 200);
    }
    ASSERT_EQ(tile.after, expected);
  }
}

}  // namespace
}  // namespace strata::test
