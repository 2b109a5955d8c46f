// Queries of an open model: values of layers at a given time, and the area of a condition, around a
// point, and inside an outline.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/polygon_area.h"
#include "expression/expression_parser.h"
#include "query/sampling/texel_samples.h"
#include "query/statistics/cross_table.h"
#include "query/statistics/key_areas.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/place.h"
#include "room/queries.h"
#include "room/selection.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"
#include "support/room_fixture.h"

namespace strata {
namespace {

using test::RoomTest;

class RoomQueries : public RoomTest {
 protected:
  void SetUp() override {
    RoomTest::SetUp();
    features_ = make_layer(ValueType::u8, 2048, "marks");
    depth_ = make_layer(ValueType::f32, 2048, "depth");
  }

  Camera view() const { return camera({0.3, -1, 0.4}); }
  static room::Selection where(const std::string& text) {
    room::Selection selection;
    selection.where = *query::parse_condition(text, "where");
    return selection;
  }
  glm::dvec3 seen_at(double x, double y) {
    return room()->queries().pick(view(), x, y, {})->position;
  }

  Layer features_, depth_;
};

TEST_F(RoomQueries, every_question_can_be_asked_of_the_past) {
  ASSERT_TRUE(send(stroke(features_, 3, {{300, 240}}, 40)));
  const auto then = room()->edits().sequence();
  const auto before = room()->queries().statistics("marks");
  ASSERT_TRUE(send(stroke(features_, 9, {{320, 240}, {360, 240}}, 60)));
  EXPECT_TRUE(room()->queries().statistics("marks")->keys.contains(9));

  room::Selection past;
  past.at = then;
  const auto again =
      room()->queries().statistics("marks", past, {.quantiles = true, .pieces = true});
  ASSERT_TRUE(again) << again.error().detail;
  EXPECT_EQ(again->texels, before->texels);
  EXPECT_EQ(again->area_m2, before->area_m2);
  EXPECT_GE(again->pieces, 1u);
  EXPECT_EQ(again->keys.at(3).pieces, again->pieces);
  EXPECT_EQ((*again->quantiles)[2], 3);

  const glm::dvec3 place = seen_at(320, 240);
  EXPECT_EQ(room()->queries().position(place, {"marks"})->values[0].value, 9);
  EXPECT_EQ(room()->queries().position(place, {"marks"}, then)->values[0].value, 3);
  EXPECT_EQ((*room()->queries().positions({place}, {"marks"}, then))[0].values[0].value, 3);
  EXPECT_EQ(room()->queries().pick(view(), 320, 240, {"marks"}, then)->values[0].value, 3);
  EXPECT_FALSE(room()->queries().pick(view(), 320, 240, {"marks"}, 0)->values[0].valid);
  const auto never = room()->queries().statistics("marks", {.at = room()->edits().sequence() + 1});
  ASSERT_FALSE(never);
  EXPECT_EQ(never.error().code, ErrorCode::invalid);
  EXPECT_EQ(never.error().field, "at");
}

TEST_F(RoomQueries, a_selection_adds_up_to_what_the_layers_hold_there) {
  ASSERT_TRUE(send(stroke(features_, 3, {{300, 240}}, 50)));
  ASSERT_TRUE(send(stroke(features_, 4, {{420, 240}}, 30)));
  ASSERT_TRUE(send(stroke(depth_, 0.5, {{310, 240}}, 20)));
  const auto all = room()->queries().statistics("marks");

  const auto threes = room()->queries().select(where("marks = 3"), {"marks", "depth"});
  ASSERT_TRUE(threes) << threes.error().detail;
  EXPECT_EQ(threes->resolution, 2048);
  EXPECT_EQ(threes->texels, all->keys.at(3).texels);
  EXPECT_NEAR(threes->area_m2, all->keys.at(3).area_m2, 1e-9 * threes->area_m2);
  EXPECT_NEAR(threes->share, threes->area_m2 / (model_.area * 1e-6), 1e-3 * threes->share);
  EXPECT_EQ(threes->layers.at("marks").keys.size(), 1u);
  EXPECT_GT(threes->layers.at("depth").texels, 0u);
  EXPECT_EQ(threes->bounds_min, all->keys.at(3).bounds_min);
  EXPECT_EQ(threes->bounds_max, all->keys.at(3).bounds_max);

  const auto deep = room()->queries().statistics("marks", where("valid(depth)"));
  EXPECT_EQ(deep->texels,
            room()->queries().select(where("valid(depth) and valid(marks)"), {})->texels);
  const auto nothing = room()->queries().select(where("marks > 200"), {"marks"});
  EXPECT_EQ(nothing->texels, 0u);
  EXPECT_EQ(nothing->layers.at("marks").texels, 0u);
  const auto everywhere = room()->queries().select({}, {});
  EXPECT_NEAR(everywhere->share, 1, 1e-6);
  EXPECT_NEAR(everywhere->area_m2, model_.area * 1e-6, 1e-3 * everywhere->area_m2);
  const auto unknown = room()->queries().select(where("salt > 1"), {});
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().field, "where");
}

TEST_F(RoomQueries, similar_surface_is_selected_and_painted_in_one_edit) {
  using Like = room::Selection::Like;
  ASSERT_TRUE(send(stroke(features_, 3, {{300, 240}}, 50)));
  ASSERT_TRUE(send(stroke(features_, 3, {{480, 240}}, 20)));
  const auto marks = room()->queries().statistics("marks");
  const auto select = [&](Like like) {
    room::Selection selection;
    selection.within = room::Region{std::move(like)};
    return selection;
  };
  Like wand{.at = room::PixelPlace{view(), 300, 240}, .by = Like::By::value, .layer = "marks"};
  const auto one = room()->queries().select(select(wand), {});
  ASSERT_TRUE(one) << one.error().detail;
  EXPECT_EQ(one->resolution, 2048);
  EXPECT_GT(one->texels, 0u);
  EXPECT_LT(one->texels, marks->texels);
  wand.contiguous = false;
  EXPECT_EQ(room()->queries().select(select(wand), {})->texels, marks->texels);

  Like normals{.at = wand.at, .by = Like::By::normal, .tolerance = 180};
  EXPECT_NEAR(room()->queries().select(select(normals), {})->share, 1, 1e-6);
  Like colors{.at = wand.at, .by = Like::By::color, .tolerance = 200};
  EXPECT_NEAR(room()->queries().select(select(colors), {})->share, 1, 1e-6);
  colors.image = SurfaceImageId{9999};
  EXPECT_EQ(room()->queries().select(select(colors), {}).error().field, "within.like.look");
  Like nowhere{.at = room::PixelPlace{view(), 2, 2}, .by = Like::By::normal};
  EXPECT_EQ(room()->queries().select(select(nowhere), {}).error().field, "within.like.at");

  const auto texels = room()->queries().surface_texels("depth", select(wand));
  ASSERT_TRUE(texels);
  room::FillEdit fill{.value_bits = *encode_value(ValueType::f32, 0.5)};
  const auto chosen = std::make_shared<const query::TexelSelection>(*texels->within);
  fill.region = room::FillEdit::Selected{chosen, 2048};
  const auto painted = send(request(depth_, fill));
  ASSERT_TRUE(painted) << painted.error().detail;
  EXPECT_EQ(room()->queries().statistics("depth")->texels, marks->texels);
  fill.region = room::FillEdit::Selected{chosen, 1024};
  EXPECT_EQ(send(request(depth_, fill)).error().code, ErrorCode::conflict);
}

// A small disc on a smooth surface is flat enough.
TEST_F(RoomQueries, around_a_place_lies_the_area_of_a_disc) {
  const glm::dvec3 place = seen_at(320, 240);
  for (const double radius : {4.0, 8.0}) {
    room::Selection selection;
    selection.within = room::Region{room::Selection::Around{place, radius}};
    const auto area = room()->queries().select(selection, {});
    ASSERT_TRUE(area) << area.error().detail;
    const double disc = std::numbers::pi * radius * radius * 1e-6;
    EXPECT_NEAR(area->area_m2, disc, 0.06 * disc) << radius;
    EXPECT_LE(glm::distance(area->bounds_min, area->bounds_max), 2 * radius * std::sqrt(3.0));
  }
  room::Selection nowhere;
  nowhere.within = room::Region{room::Selection::Around{room::PixelPlace{view(), 2, 2}, 5}};
  const auto refused = room()->queries().select(nowhere, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "within.at");
}

TEST_F(RoomQueries, inside_an_outline_lies_what_a_polygon_paints) {
  const std::vector<glm::dvec2> path = {{250, 200}, {400, 190}, {330, 300}};
  room::PolygonEdit polygon;
  polygon.value_bits = 8;
  polygon.outline = {view(), path, false};
  const auto painted = send(request(features_, polygon));
  ASSERT_TRUE(painted);
  room::Selection selection;
  selection.within = room::Region{room::Outline{view(), path, false}};
  const auto area = room()->queries().select(selection, {"marks"});
  ASSERT_TRUE(area) << area.error().detail;
  EXPECT_EQ(area->texels, painted->texels_changed);
  EXPECT_NEAR(area->area_m2, painted->area_m2, 1e-9 * area->area_m2);
  EXPECT_EQ(area->layers.at("marks").texels, area->texels);
  selection.where = *query::parse_condition("marks = 7", "where");
  EXPECT_EQ(room()->queries().select(selection, {})->texels, 0u);
}

TEST_F(RoomQueries, the_picture_of_a_selection_shows_where_the_camera_sees_it) {
  const std::vector<glm::dvec2> path = {{250, 200}, {400, 190}, {330, 300}};
  room::Selection selection;
  selection.within = room::Region{room::Outline{view(), path, false}};
  room::StatisticsOptions options;
  const int columns = static_cast<int>(view().width) / 4,
            rows = static_cast<int>(view().height) / 4;
  options.seen = room::SeenGrid{view(), columns, rows};
  const auto area = room()->queries().select(selection, {}, options);
  ASSERT_TRUE(area) << area.error().detail;
  ASSERT_EQ(area->seen.size(), static_cast<std::size_t>(columns * rows));
  // The surface fills this part of the window, so the image is the outline itself. Cells within two
  // pixels of its edge may be on either side.
  const PolygonArea outline({path});
  int inside = 0, wrong = 0;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const glm::dvec2 at{column * 4 + 2, row * 4 + 2};
      bool all = true, none = true;
      for (const glm::dvec2 offset : {glm::dvec2{-2, -2}, {2, -2}, {-2, 2}, {2, 2}, {0, 0}})
        (outline.contains(at + offset) ? none : all) = false;
      if (!all && !none) continue;
      const bool is = area->seen[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                                 static_cast<std::size_t>(column)] != 0;
      inside += all;
      wrong += is != all;
    }
  EXPECT_GT(inside, 100);
  EXPECT_LE(wrong, inside / 50);
  // An empty selection is visible nowhere.
  selection.where = *query::parse_condition("valid(marks)", "where");
  const auto nothing = room()->queries().select(selection, {}, options);
  ASSERT_TRUE(nothing);
  EXPECT_TRUE(std::ranges::all_of(nothing->seen, [](auto cell) { return cell == 0; }));
}

TEST_F(RoomQueries, names_of_layers_that_a_person_does_not_see_are_not_suggested) {
  Layer secret = features_;
  secret.visibility = Visibility::curators;
  ASSERT_TRUE(room()->layers().update(secret));
  room::Selection selection;
  selection.where = *query::parse_condition("mark > 1", "where");
  const auto suggested = [&](Role role) {
    selection.seen_by = role;
    const auto refused = room()->queries().select(selection, {});
    EXPECT_FALSE(refused);
    EXPECT_EQ(refused.error().reason, mistake::kUnknownLayer);
    return refused.error().suggestions;
  };
  EXPECT_EQ(suggested(Role::owner), std::vector<std::string>{"marks"});
  EXPECT_EQ(suggested(Role::viewer), std::vector<std::string>{});
}

TEST_F(RoomQueries, records_decide_what_their_keys_cover) {
  Layer pieces_layer;
  pieces_layer.name = "Pieces";
  pieces_layer.kind = LayerKind::database;
  pieces_layer.type = ValueType::u16;
  pieces_layer.resolution = 2048;
  pieces_layer.palette = default_palette(pieces_layer.type, true);
  std::vector<Column> columns(2);
  columns[0].name = "Thickness";
  columns[0].kind = ColumnKind::numeric;
  columns[1].name = "State";
  const auto pieces = room()->layers().create(pieces_layer, {}, columns);
  ASSERT_TRUE(pieces) << pieces.error().detail;
  const Table table = *store_->tables().find(to_string(*pieces->table), Role::owner);
  const auto write = [&](std::int64_t key, double thickness, const char* state) {
    store::WriteRecords write_request;
    write_request.records = {
        {key, {{table.columns[0].id, thickness}, {table.columns[1].id, state}}}};
    ASSERT_TRUE(store_->records().write(table.id, write_request, "anna"));
  };
  write(1, 4, "loose");
  write(2, 8, "firm");
  ASSERT_TRUE(send(stroke(*pieces, 1, {{300, 240}}, 50)));
  ASSERT_TRUE(send(stroke(*pieces, 2, {{420, 240}}, 30)));
  ASSERT_TRUE(send(stroke(depth_, 6, {{300, 240}, {420, 240}}, 20)));
  const auto then = room()->edits().sequence();
  const auto keys = room()->queries().key_areas("pieces");
  ASSERT_TRUE(keys);
  const auto area = [&](const std::string& text, std::optional<std::int64_t> at = {}) {
    auto selection = where(text);
    selection.at = at;
    const auto found = room()->queries().select(selection, {});
    EXPECT_TRUE(found) << text << ": " << found.error().detail;
    return found ? found->area_m2 : -1;
  };
  const double first = keys->at(1).area_m2, second = keys->at(2).area_m2;
  EXPECT_NEAR(area("pieces.thickness < 5"), first, 1e-9 * first);
  EXPECT_NEAR(area("pieces.state = 'firm'"), second, 1e-9 * second);
  EXPECT_NEAR(area("pieces.state like '%o%' or pieces.thickness > 5"), first + second,
              1e-9 * first);
  EXPECT_EQ(area("pieces.thickness > depth and valid(depth)"), area("pieces = 2 and valid(depth)"));
  EXPECT_GT(area("pieces.thickness > depth"), 0);

  // The query uses the present records, or with a time the earlier records.
  write(1, 9, "firm");
  EXPECT_EQ(area("pieces.thickness < 5"), 0);
  EXPECT_NEAR(area("pieces.thickness < 5", then), first, 1e-9 * first);

  room::FillEdit fill;
  fill.value_bits = 5;
  fill.region = room::FillEdit::Where{
      *query::parse_condition("pieces.state = 'firm' and pieces.thickness < 9", "where")};
  const auto filled = send(request(features_, fill));
  ASSERT_TRUE(filled) << filled.error().detail;
  EXPECT_NEAR(filled->area_m2, second, 1e-9 * second);

  for (const auto& [text, says] : std::map<std::string, std::string>{
           {"pieces.thick > 1", "has no column 'thick'"},
           {"depth > 1 and marks.thickness > 1",
            "'marks' stores numbers: only layers of records have columns (at character 15)"},
           {"peaces.thickness > 1", "no layer 'peaces'"}}) {
    const auto refused = room()->queries().select(where(text), {});
    ASSERT_FALSE(refused) << text;
    EXPECT_EQ(refused.error().code, ErrorCode::invalid);
    EXPECT_NE(refused.error().detail.find(says), std::string::npos) << refused.error().detail;
  }
}

TEST_F(RoomQueries, a_cross_table_holds_each_layers_area) {
  ASSERT_TRUE(send(stroke(features_, 3, {{300, 240}}, 50)));
  const Layer units = make_layer(ValueType::u16, 4096, "units");
  ASSERT_TRUE(send(stroke(units, 700, {{340, 240}}, 50)));
  const auto table = room()->queries().cross_table("units", "marks");
  ASSERT_TRUE(table) << table.error().detail;
  ASSERT_EQ(table->rows, (std::vector<query::CrossTable::Key>{700, std::nullopt}));
  ASSERT_EQ(table->columns, (std::vector<query::CrossTable::Key>{3, std::nullopt}));
  const double units_area = room()->queries().statistics("units")->area_m2;
  EXPECT_NEAR(table->area_m2[0][0] + table->area_m2[0][1], units_area, 1e-6 * units_area);
  const double marks_area = room()->queries().statistics("marks")->area_m2;
  EXPECT_NEAR(table->area_m2[0][0] + table->area_m2[1][0], marks_area, 0.01 * marks_area)
      << "at twice the texels";
  EXPECT_GT(table->area_m2[0][0], 0);
  EXPECT_EQ(table->area_m2[1][1], 0);
  EXPECT_EQ(room()->queries().cross_table("units", "depth").error().field, "columns");
}

TEST_F(RoomQueries, statistics_after_a_stroke_are_those_of_a_fresh_count) {
  ASSERT_TRUE(send(stroke(features_, 3, {{300, 240}}, 50)));
  ASSERT_TRUE(room()->queries().statistics("marks"));
  ASSERT_TRUE(send(stroke(features_, 5, {{320, 250}}, 30)));
  const auto updated = room()->queries().statistics("marks");
  restart();
  const auto fresh = room()->queries().statistics("marks");
  EXPECT_EQ(updated->texels, fresh->texels);
  EXPECT_EQ(updated->area_m2, fresh->area_m2);
  EXPECT_EQ(updated->keys.at(5).centroid, fresh->keys.at(5).centroid);
}

}  // namespace
}  // namespace strata
