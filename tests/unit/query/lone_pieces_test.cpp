// Pieces that appeared since another state of a sheet, with and without seams.
#include "query/regions/lone_pieces.h"

#include <gtest/gtest.h>

#include <functional>

#include "core/progress.h"
#include "support/cut_sheet.h"

namespace strata::query {
namespace {

using test::SheetCuts;
using test::Surface;
using ValueAt = std::function<int(int x, int y)>;  // 0: no value

constexpr LonePiecesRequest kAll{0, 100};

const std::vector<Surface>& sheets() {
  static const std::vector<Surface> sheets = [] {
    std::vector<Surface> made;
    for (const SheetCuts& cuts : {SheetCuts{}, SheetCuts{{96}, {}}, SheetCuts{{24, 96, 104}, {64}}})
      made.push_back(test::cut_sheet(cuts));
    return made;
  }();
  return sheets;
}

SurfaceValues put(const Surface& sheet, const ValueAt& value_at) {
  const std::size_t slots = sheet.map.block_of_slot.size();
  SurfaceValues values{std::vector<std::uint32_t>(slots * 64), std::vector<std::uint64_t>(slots)};
  test::for_each_surface_texel(sheet.map, [&](std::uint32_t texel) {
    const glm::ivec2 place = test::sheet_place(sheet, texel);
    const int value = value_at(place.x, place.y);
    values.set(texel, {static_cast<std::uint32_t>(value), value != 0});
  });
  return values;
}

bool in_rect(int x, int y, int left, int lower, int width, int height) {
  return x >= left && x < left + width && y >= lower && y < lower + height;
}
int everywhere(int, int) { return 1; }

LonePieces pieces_of(const Surface& sheet, const ValueAt& now, const ValueAt& then,
                     const ValueAt& known = everywhere, const LonePiecesRequest& request = kAll) {
  Progress progress;
  auto found = find_lone_pieces(put(sheet, now), put(sheet, known).valid, put(sheet, then).valid,
                                request, sheet.map, sheet.graph, progress);
  EXPECT_TRUE(found);
  return found ? std::move(*found) : LonePieces{};
}

int now(int x, int y) {
  if (in_rect(x, y, 80, 30, 40, 20)) return 1;   // across the seams
  if (in_rect(x, y, 120, 30, 10, 20)) return 2;  // next to it
  if (in_rect(x, y, 10, 80, 20, 10)) return 1;   // overlaps
  return in_rect(x, y, 150, 100, 5, 5) ? 3 : 0;
}
int then(int x, int y) { return in_rect(x, y, 29, 89, 20, 20) ? 7 : 0; }  // overlaps one texel

TEST(LonePieces, overlap_nothing_and_the_largest_comes_first) {
  for (const Surface& sheet : sheets()) {
    const LonePieces pieces = pieces_of(sheet, now, then);
    EXPECT_EQ(pieces.count, 3u);
    EXPECT_EQ(pieces.area, 800 + 200 + 25);
    ASSERT_EQ(pieces.list.size(), 3u);
    EXPECT_EQ(pieces.list[0].value, (TexelValue{1, true}));
    EXPECT_EQ(pieces.list[0].area, 800);
    EXPECT_EQ(pieces.list[1].value, (TexelValue{2, true}));
    EXPECT_EQ(pieces.list[2].area, 25);
    const glm::dvec3 at = sheet.geometry.origin + glm::dvec3(pieces.list[0].at);
    EXPECT_NEAR(at.x, 100, 1);
    EXPECT_NEAR(at.y, 40, 1);
  }
}

TEST(LonePieces, are_in_the_piece_also_if_its_center_is_not) {
  const auto ring = [](int x, int y) {
    return in_rect(x, y, 50, 50, 30, 30) && !in_rect(x, y, 55, 55, 20, 20) ? 4 : 0;
  };
  const Surface& sheet = sheets().front();
  const LonePieces pieces = pieces_of(sheet, ring, [](int, int) { return 0; });
  ASSERT_EQ(pieces.list.size(), 1u);
  const glm::dvec3 at = sheet.geometry.origin + glm::dvec3(pieces.list[0].at);
  EXPECT_EQ(ring(static_cast<int>(at.x), static_cast<int>(at.y)), 4);
}

TEST(LonePieces, count_only_where_more_than_half_of_the_piece_is_known) {
  const auto piece = [](int x, int y) { return in_rect(x, y, 60, 60, 10, 10) ? 1 : 0; };
  const auto nothing = [](int, int) { return 0; };
  for (const auto& [from, count] : {std::pair{65, 0}, {64, 1}, {80, 0}})
    EXPECT_EQ(pieces_of(sheets().front(), piece, nothing,
                        [from = from](int x, int) { return x >= from ? 1 : 0; })
                  .count,
              static_cast<std::uint64_t>(count))
        << from;
}

TEST(LonePieces, small_ones_are_left_out_and_the_list_is_limited) {
  const Surface& sheet = sheets().front();
  const LonePieces large = pieces_of(sheet, now, then, everywhere, {200, 1});
  EXPECT_EQ(large.count, 2u);
  EXPECT_EQ(large.area, 1000);
  ASSERT_EQ(large.list.size(), 1u);
  EXPECT_EQ(large.list[0].area, 800);
}

TEST(LonePieces, can_be_cancelled) {
  Progress progress;
  progress.cancel();
  const Surface& sheet = sheets().front();
  const SurfaceValues values = put(sheet, now);
  const auto found =
      find_lone_pieces(values, values.valid, values.valid, kAll, sheet.map, sheet.graph, progress);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace strata::query
