// Edits of whole areas with a real database and renderer: expressions, pieces of the surface,
// connected values, polygons.
#include <gmock/gmock.h>

#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <optional>
#include <set>

#include "domain/layers/mask_texels.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/place.h"
#include "room/queries.h"
#include "support/room_fixture.h"

namespace strata {
namespace {

using Op = Expression::Op;
using room::FillEdit;
using test::RoomTest;

class RoomAreas : public RoomTest {
 protected:
  void SetUp() override {
    RoomTest::SetUp();
    wet_ = make_layer(ValueType::u8, 2048, "wet");
    crack_ = make_layer(ValueType::u8, 2048, "crack");
    features_ = make_layer(ValueType::u16, 2048, "marks");
  }

  // Returns the camera of the fixture's strokes.
  Camera view() const { return camera({0.3, -1, 0.4}); }

  static Expression layer_value(const std::string& slug) {
    Expression e;
    e.op = Op::layer;
    e.name = slug;
    return e;
  }
  static Expression valid(const std::string& slug) {
    Expression e = layer_value(slug);
    e.op = Op::valid;
    return e;
  }
  static Expression number(double value) {
    Expression e;
    e.number = value;
    return e;
  }
  static Expression of(Op op, std::vector<Expression> parts) {
    Expression e;
    e.op = op;
    e.parts = std::move(parts);
    return e;
  }

  TileMap tiles(const std::string& slug, std::optional<std::int64_t> at = {}) {
    auto snapshot = room()->queries().tiles(slug, at);
    EXPECT_TRUE(snapshot) << (snapshot ? "" : snapshot.error().detail);
    return snapshot ? snapshot->tiles : TileMap{};
  }

  // Expects undo to restore the content before the edit, and redo the content after it. Expects
  // to read both contents at their sequences, and the later content also after a restart.
  void expect_durable_and_undoable(const Layer& layer, const room::EditRequest& edit) {
    const TileMap before = tiles(layer.slug);
    const auto answer = send(edit);
    ASSERT_TRUE(answer) << answer.error().detail;
    EXPECT_GT(answer->texels_changed, 0u);
    EXPECT_GT(answer->area_m2, 0);
    const TileMap after = tiles(layer.slug);
    EXPECT_FALSE(test::equal(before, after));
    ASSERT_TRUE(send(request(layer, room::UndoEdit{})));
    EXPECT_TRUE(test::equal(tiles(layer.slug), before));
    ASSERT_TRUE(send(request(layer, room::RedoEdit{})));
    EXPECT_TRUE(test::equal(tiles(layer.slug), after));
    EXPECT_TRUE(test::equal(tiles(layer.slug, answer->sequence - 1), before));
    EXPECT_TRUE(test::equal(tiles(layer.slug, answer->sequence), after));
    restart();
    EXPECT_TRUE(test::equal(tiles(layer.slug), after));
    const auto again = send(edit);
    ASSERT_TRUE(again);
    EXPECT_TRUE(again->repeated);
    EXPECT_EQ(again->texels_changed, answer->texels_changed);
    expect_room_equals_journal(layer);
  }

  room::PolygonEdit polygon(std::vector<glm::dvec2> path, std::uint32_t value,
                            bool through = false) const {
    room::PolygonEdit edit;
    edit.value_bits = value;
    edit.outline.camera = view();
    edit.outline.path = std::move(path);
    edit.outline.through = through;
    return edit;
  }

  Layer wet_, crack_, features_;
};

std::uint64_t valid_texels(const TileMap& tiles) {
  std::uint64_t count = 0;
  for (const auto& [address, tile] : tiles)
    count += static_cast<std::uint64_t>(tile->valid.count());
  return count;
}

// Counts texels that are valid in only one of the two maps or have different values.
std::uint64_t differing_texels(const TileMap& a, const TileMap& b) {
  std::set<TileAddress> addresses;
  for (const TileMap* tiles : {&a, &b})
    for (const auto& [address, tile] : *tiles) addresses.insert(address);
  std::uint64_t count = 0;
  for (const TileAddress address : addresses) {
    const auto in_a = a.find(address), in_b = b.find(address);
    const TileData none, &tile_a = in_a == a.end() ? none : *in_a->second,
                         &tile_b = in_b == b.end() ? none : *in_b->second;
    TileMask either;
    for (int w = 0; w < kMaskWords; ++w)
      either.words[w] = tile_a.valid.words[w] | tile_b.valid.words[w];
    for_each_texel(either, [&](int texel) {
      const bool is_same = tile_a.valid.test(texel) && tile_b.valid.test(texel) &&
                           tile_a.bits(texel) == tile_b.bits(texel);
      count += is_same ? 0 : 1;
    });
  }
  return count;
}

TEST_F(RoomAreas, a_fill_where_a_condition_holds_follows_the_other_layers) {
  ASSERT_TRUE(send(stroke(wet_, 5, {{250, 240}, {390, 240}}, 40)));
  ASSERT_TRUE(send(stroke(wet_, 6, {{250, 300}}, 30)));
  ASSERT_TRUE(send(stroke(crack_, 1, {{320, 200}, {320, 280}}, 15)));
  FillEdit fill;
  fill.value_bits = 900;
  fill.region = FillEdit::Where{of(Op::all, {of(Op::equal, {layer_value("wet"), number(5)}),
                                             of(Op::negation, {valid("crack")})})};
  expect_durable_and_undoable(features_, request(features_, fill));
  const TileMap wet = tiles("wet"), crack = tiles("crack"), features = tiles("marks");
  std::uint64_t checked = 0;
  for (const auto& [address, tile] : wet)
    for_each_texel(tile->valid, [&](int texel) {
      const bool cracked = crack.contains(address) && crack.at(address)->valid.test(texel);
      const bool expected = tile->bits(texel) == 5 && !cracked;
      const bool is = features.contains(address) && features.at(address)->valid.test(texel);
      ASSERT_EQ(is, expected) << address.x << "," << address.y << " texel " << texel;
      checked += is;
    });
  EXPECT_EQ(checked, valid_texels(features)) << "nothing else is painted, gutter included";
}

TEST_F(RoomAreas, outlines_are_combined_as_the_sets_of_what_each_of_them_paints) {
  using room::Combination;
  const std::vector<std::vector<glm::dvec2>> paths{{{240, 180}, {400, 190}, {380, 320}, {250, 300}},
                                                   {{300, 200}, {440, 220}, {330, 340}},
                                                   {{200, 250}, {420, 240}, {350, 290}}};
  // The user draws the second outline in the window of another camera.
  Camera other = view();
  other.projection[0][0] *= 0.8;
  const std::vector<Camera> cameras{view(), other, view()};
  // The tiles that each outline alone paints. The oracle combines these tiles.
  std::vector<TileMap> alone;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    room::PolygonEdit edit = polygon(paths[i], 7);
    edit.outline.camera = cameras[i];
    ASSERT_TRUE(send(request(features_, edit)));
    alone.push_back(tiles("marks"));
    ASSERT_TRUE(send(request(features_, room::UndoEdit{})));
  }
  const auto painted = [](const TileMap& tiles, TileAddress address) {
    const auto found = tiles.find(address);
    return found == tiles.end() ? TileMask{} : found->second->valid;
  };
  constexpr std::array kAll{Combination::add, Combination::subtract, Combination::intersect};
  for (const Combination first : kAll)
    for (const Combination second : kAll) {
      room::PolygonEdit edit = polygon(paths[0], 7);
      edit.outline.steps = {{first, cameras[1], paths[1]}, {second, cameras[2], paths[2]}};
      const auto answer = send(request(features_, edit));
      ASSERT_TRUE(answer) << answer.error().detail;
      const TileMap combined = tiles("marks");
      std::set<TileAddress> addresses;
      for (const auto& each :
           {std::cref(alone[0]), std::cref(alone[1]), std::cref(alone[2]), std::cref(combined)})
        for (const auto& [address, tile] : each.get()) addresses.insert(address);
      std::uint64_t wrong = 0, right = 0;
      for (const TileAddress address : addresses) {
        TileMask expected = painted(alone[0], address);
        for (const auto& [how, by] : {std::pair(first, 1), std::pair(second, 2)}) {
          const TileMask other_mask = painted(alone[static_cast<std::size_t>(by)], address);
          for (int w = 0; w < kMaskWords; ++w) {
            std::uint64_t& word = expected.words[w];
            const std::uint64_t in = other_mask.words[w];
            word = how == Combination::add        ? word | in
                   : how == Combination::subtract ? word & ~in
                                                  : word & in;
          }
        }
        const TileMask is = painted(combined, address);
        for (int w = 0; w < kMaskWords; ++w) {
          wrong += static_cast<std::uint64_t>(std::popcount(is.words[w] ^ expected.words[w]));
          right += static_cast<std::uint64_t>(std::popcount(is.words[w] & expected.words[w]));
        }
      }
      EXPECT_EQ(wrong, 0u) << static_cast<int>(first) << static_cast<int>(second);
      EXPECT_GT(right, 0u) << static_cast<int>(first) << static_cast<int>(second);
      ASSERT_TRUE(send(request(features_, room::UndoEdit{})));
    }
}

TEST_F(RoomAreas, a_fill_over_a_layer_that_is_not_there_is_refused_and_paints_nothing) {
  FillEdit fill;
  fill.region = FillEdit::Where{valid("salt")};
  const auto answer = send(request(features_, fill));
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::invalid);
  EXPECT_EQ(answer.error().field, "where");
  EXPECT_EQ(room()->edits().sequence(), 0);
  EXPECT_TRUE(tiles("marks").empty());
}

TEST_F(RoomAreas, a_layer_can_be_filled_by_what_it_holds_itself) {
  ASSERT_TRUE(send(stroke(features_, 3, {{300, 240}}, 30)));
  ASSERT_TRUE(send(stroke(features_, 4, {{340, 240}}, 30)));
  const auto before = room()->queries().statistics("marks");
  FillEdit fill;
  fill.erase = true;
  fill.region = FillEdit::Where{of(Op::greater, {layer_value("marks"), number(3)})};
  const auto answer = send(request(features_, fill));
  ASSERT_TRUE(answer) << answer.error().detail;
  const auto after = room()->queries().statistics("marks");
  EXPECT_FALSE(after->keys.contains(4));
  EXPECT_EQ(after->keys.at(3).texels, before->keys.at(3).texels);
  EXPECT_EQ(answer->texels_changed, before->keys.at(4).texels);
}

TEST_F(RoomAreas, the_piece_under_a_pixel_is_the_whole_pot_across_all_its_seams) {
  FillEdit fill;
  fill.value_bits = 12;
  fill.region = FillEdit::Island{room::PixelPlace{view(), 320, 240}};
  const auto edit = request(features_, fill);
  expect_durable_and_undoable(features_, edit);
  const double area_m2 = room()->model().area_m2();
  EXPECT_NEAR(room()->queries().statistics("marks")->area_m2, area_m2, area_m2 * 1e-3);
  // Fills the same piece from a point in space, on another layer.
  fill.region = FillEdit::Island{(model_.bounds_min + model_.bounds_max) * 0.5};
  const auto answer = send(request(wet_, fill));
  ASSERT_TRUE(answer) << answer.error().detail;
  EXPECT_NEAR(answer->area_m2, area_m2, area_m2 * 1e-3);
}

TEST_F(RoomAreas, what_is_connected_with_a_place_is_filled_and_nothing_else) {
  ASSERT_TRUE(send(stroke(features_, 3, {{260, 240}}, 25)));
  const TileMap one = tiles("marks");
  ASSERT_TRUE(send(stroke(features_, 3, {{380, 240}}, 25)));
  const auto both = room()->queries().statistics("marks")->keys.at(3).texels;
  FillEdit fill;
  fill.value_bits = 7;
  fill.region = FillEdit::Connected{room::PixelPlace{view(), 380, 240}};
  expect_durable_and_undoable(features_, request(features_, fill));
  const auto keys = room()->queries().statistics("marks")->keys;
  EXPECT_EQ(keys.at(3).texels + keys.at(7).texels, both);
  const TileMap marks = tiles("marks");
  for (const auto& [address, tile] : one) {
    const TileData& now = *marks.at(address);
    for_each_texel(tile->valid,
                   [&](int texel) { ASSERT_EQ(now.bits(texel), 3u) << "the other dab"; });
  }
}

TEST_F(RoomAreas, from_where_nothing_is_all_that_holds_nothing_is_filled) {
  ASSERT_TRUE(send(stroke(features_, 3, {{320, 240}}, 40)));
  const auto painted = room()->queries().statistics("marks")->texels;
  FillEdit fill;
  fill.value_bits = 1;
  fill.region = FillEdit::Connected{room::PixelPlace{view(), 320, 320}};
  ASSERT_TRUE(send(request(features_, fill)));
  const auto statistics = room()->queries().statistics("marks");
  EXPECT_EQ(statistics->keys.at(3).texels, painted);
  const double area_m2 = room()->model().area_m2();
  EXPECT_NEAR(statistics->area_m2, area_m2, area_m2 * 2e-3);
}

TEST_F(RoomAreas, a_place_beside_the_model_is_refused) {
  FillEdit fill;
  fill.region = FillEdit::Island{room::PixelPlace{view(), 2, 2}};
  const auto answer = send(request(features_, fill));
  ASSERT_FALSE(answer);
  EXPECT_EQ(answer.error().code, ErrorCode::invalid);
  EXPECT_EQ(answer.error().field, "at");
  EXPECT_EQ(room()->edits().sequence(), 0);
}

TEST_F(RoomAreas, a_polygon_paints_what_a_square_brush_of_its_shape_does) {
  for (const bool through : {false, true}) {
    auto dab = stroke(wet_, 9, {{330, 250}}, 60);
    std::get<room::StrokeEdit>(dab.edit).batch.shape = ToolShape::square;
    std::get<room::StrokeEdit>(dab.edit).batch.through = through;
    const auto painted = send(dab);
    ASSERT_TRUE(painted) << painted.error().detail;
    auto square = polygon({{270, 190}, {390, 190}, {390, 310}, {270, 310}}, 9, through);
    const auto answer = send(request(crack_, square));
    ASSERT_TRUE(answer) << answer.error().detail;
    EXPECT_GT(answer->texels_changed, 1000u);
    const std::uint64_t count = valid_texels(tiles("wet"));
    EXPECT_LE(differing_texels(tiles("wet"), tiles("crack")), 2 + count / 20'000)
        << "rounding at the border";
    FillEdit erase;
    erase.erase = true;
    for (const Layer& layer : {wet_, crack_}) ASSERT_TRUE(send(request(layer, erase)));
  }
}

TEST_F(RoomAreas, a_polygon_is_durable_and_undoable) {
  expect_durable_and_undoable(
      features_, request(features_, polygon({{220, 140}, {420, 200}, {300, 220}, {360, 360}}, 77)));
}

TEST_F(RoomAreas, a_polygon_erases_and_its_notch_stays) {
  ASSERT_TRUE(send(request(features_, FillEdit{false, 5})));
  auto edit = polygon({{200, 150}, {440, 150}, {440, 330}, {320, 240}, {200, 330}}, 0);
  edit.erase = true;
  ASSERT_TRUE(send(request(features_, edit)));
  const auto value_at = [&](double x, double y) {
    return room()->queries().pick(view(), x, y, {"marks"})->values.at(0);
  };
  EXPECT_FALSE(value_at(320, 180).valid);
  EXPECT_FALSE(value_at(230, 250).valid);
  EXPECT_TRUE(value_at(320, 300).valid) << "in the notch";
}

TEST_F(RoomAreas, a_polygon_out_of_the_window_paints_nothing_and_is_an_edit_all_the_same) {
  const auto answer =
      send(request(features_, polygon({{-900, -900}, {-800, -900}, {-800, -800}}, 1)));
  ASSERT_TRUE(answer) << answer.error().detail;
  EXPECT_EQ(answer->texels_changed, 0u);
  const auto whole =
      send(request(features_, polygon({{-1e6, -1e6}, {1e6, -1e6}, {1e6, 1e6}, {-1e6, 1e6}}, 1)));
  ASSERT_TRUE(whole);
  EXPECT_GT(whole->texels_changed, 10'000u);
}

}  // namespace
}  // namespace strata
