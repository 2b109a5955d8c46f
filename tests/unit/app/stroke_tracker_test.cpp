#include "app/strokes/stroke_tracker.h"

#include <gtest/gtest.h>

namespace strata::app {
namespace {

const StrokeTracker::Owner kAnna{1, "anna"};
const StrokeTracker::Owner kBert{1, "bert"};

StrokeTool tool(double radius = 5) {
  StrokeTool made;
  made.layer_id = 3;
  made.batch.radius_px = radius;
  made.record = {{"op", "stroke"}, {"radius_px", radius}};
  return made;
}

using Path = std::vector<glm::dvec2>;

struct Book : testing::Test {
  StrokeTracker book;
  const Uuid stroke = random_uuid();
  const std::vector<Uuid> ids{random_uuid(), random_uuid(), random_uuid()};
};

TEST_F(Book, a_batch_starts_where_the_one_before_ended) {
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()));
  const auto first = book.extend(kAnna, stroke, ids[0], 0, {{1, 1}, {2, 2}});
  ASSERT_TRUE(first);
  EXPECT_EQ(first->path, (Path{{1, 1}, {2, 2}}));
  EXPECT_EQ(first->tool.layer_id, LayerId(3));
  const auto second = book.extend(kAnna, stroke, ids[1], 1, {{3, 3}});
  ASSERT_TRUE(second);
  EXPECT_EQ(second->path, (Path{{2, 2}, {3, 3}}));
}

TEST_F(Book, a_repeated_batch_gets_the_same_start_and_advances_nothing) {
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()));
  ASSERT_TRUE(book.extend(kAnna, stroke, ids[0], 0, {{1, 1}}));
  ASSERT_TRUE(book.extend(kAnna, stroke, ids[1], 1, {{2, 2}}));
  const auto again = book.extend(kAnna, stroke, ids[0], 0, {{1, 1}});
  ASSERT_TRUE(again);
  EXPECT_EQ(again->path, (Path{{1, 1}}));
  const auto next = book.extend(kAnna, stroke, ids[2], 2, {{3, 3}});
  ASSERT_TRUE(next);
  EXPECT_EQ(next->path, (Path{{2, 2}, {3, 3}}))
      << "the repeat must not have become the stroke's end";
}

TEST_F(Book, a_reconnect_begins_the_same_stroke_again) {
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()));
  ASSERT_TRUE(book.extend(kAnna, stroke, ids[0], 0, {{1, 1}}));
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()));
  const auto next = book.extend(kAnna, stroke, ids[1], 1, {{2, 2}});
  ASSERT_TRUE(next);
  EXPECT_EQ(next->path, (Path{{1, 1}, {2, 2}}));
}

TEST_F(Book, another_brush_under_a_known_id_is_refused) {
  ASSERT_TRUE(book.begin(kAnna, stroke, tool(5)));
  EXPECT_EQ(book.begin(kAnna, stroke, tool(6)).error().code, ErrorCode::conflict);
}

TEST_F(Book, a_gap_and_a_taken_number_are_refused) {
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()));
  ASSERT_TRUE(book.extend(kAnna, stroke, ids[0], 0, {{1, 1}}));
  const auto gap = book.extend(kAnna, stroke, ids[1], 2, {{2, 2}});
  ASSERT_FALSE(gap);
  EXPECT_EQ(gap.error().field, "n");
  EXPECT_NE(gap.error().detail.find("number 1"), std::string::npos);
  EXPECT_EQ(book.extend(kAnna, stroke, ids[1], 0, {{2, 2}}).error().code, ErrorCode::conflict);
}

TEST_F(Book, strokes_of_others_are_unknown) {
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()));
  EXPECT_EQ(book.extend(kBert, stroke, ids[0], 0, {{1, 1}}).error().code, ErrorCode::not_found);
  EXPECT_TRUE(book.open_strokes(kBert).empty());
}

TEST_F(Book, an_ended_stroke_takes_repeats_but_nothing_new) {
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()));
  ASSERT_TRUE(book.extend(kAnna, stroke, ids[0], 0, {{1, 1}}));
  ASSERT_TRUE(book.end(kAnna, stroke));
  EXPECT_TRUE(book.extend(kAnna, stroke, ids[0], 0, {{1, 1}}));
  EXPECT_EQ(book.extend(kAnna, stroke, ids[1], 1, {{2, 2}}).error().code, ErrorCode::conflict);
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()))
      << "a resend after a reconnect begins with the begin";
  EXPECT_TRUE(book.extend(kAnna, stroke, ids[1], 1, {{2, 2}}));
}

TEST_F(Book, welcome_does_not_count_a_saved_batch_behind_one_that_is_not) {
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()));
  ASSERT_TRUE(book.extend(kAnna, stroke, ids[0], 0, {{1, 1}}));
  ASSERT_TRUE(book.extend(kAnna, stroke, ids[1], 1, {{2, 2}}));
  book.saved(kAnna, stroke, 1);
  EXPECT_EQ(book.open_strokes(kAnna)[0].n, -1);
  book.saved(kAnna, stroke, 0);
  EXPECT_EQ(book.open_strokes(kAnna)[0].n, 1);
}

TEST_F(Book, welcome_counts_on_from_the_first_batch_after_a_restart) {
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()));
  ASSERT_TRUE(book.extend(kAnna, stroke, ids[0], 7, {{1, 1}}));
  EXPECT_EQ(book.open_strokes(kAnna)[0].n, 6) << "the journal holds what came before";
  book.saved(kAnna, stroke, 7);
  EXPECT_EQ(book.open_strokes(kAnna)[0].n, 7);
}

TEST_F(Book, welcome_names_the_last_saved_batch_of_open_strokes) {
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()));
  ASSERT_EQ(book.open_strokes(kAnna).size(), 1u);
  EXPECT_EQ(book.open_strokes(kAnna)[0].n, -1);
  ASSERT_TRUE(book.extend(kAnna, stroke, ids[0], 0, {{1, 1}}));
  book.saved(kAnna, stroke, 0);
  EXPECT_EQ(book.open_strokes(kAnna)[0].n, 0);
  ASSERT_TRUE(book.end(kAnna, stroke));
  EXPECT_TRUE(book.open_strokes(kAnna).empty());
}

TEST_F(Book, after_a_restart_a_stroke_goes_on_from_the_journals_point) {
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()));
  EXPECT_FALSE(book.lacks_start(kAnna, stroke, 0));
  ASSERT_TRUE(book.lacks_start(kAnna, stroke, 7));
  book.continue_from(kAnna, stroke, 7, {{9, 9}});
  EXPECT_FALSE(book.lacks_start(kAnna, stroke, 7));
  const auto batch = book.extend(kAnna, stroke, ids[0], 7, {{10, 10}});
  ASSERT_TRUE(batch);
  EXPECT_EQ(batch->path, (Path{{9, 9}, {10, 10}}));
  EXPECT_EQ(book.extend(kAnna, stroke, ids[1], 8, {{11, 11}})->path, (Path{{10, 10}, {11, 11}}));
  EXPECT_EQ(book.extend(kAnna, stroke, ids[2], 3, {{1, 1}}).error().code, ErrorCode::conflict);
}

TEST_F(Book, a_batch_starts_with_the_width_that_the_one_before_ended_with) {
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()));
  EXPECT_TRUE(book.extend(kAnna, stroke, ids[0], 0, {{1, 1}, {2, 2}})->widths.empty());
  using Widths = std::vector<double>;
  EXPECT_EQ(book.extend(kAnna, stroke, ids[1], 1, {{3, 3}, {4, 4}}, {0.5, 0.25})->widths,
            (Widths{1, 0.5, 0.25}));
  EXPECT_EQ(book.extend(kAnna, stroke, ids[2], 2, {{5, 5}})->widths, (Widths{0.25, 1}));
  const auto odd = book.extend(kAnna, stroke, random_uuid(), 3, {{6, 6}}, {0.5, 0.5});
  ASSERT_FALSE(odd);
  EXPECT_EQ(odd.error().field, "widths");
  EXPECT_TRUE(book.extend(kAnna, stroke, random_uuid(), 3, {{6, 6}}))
      << "what was refused took no number";
}

TEST_F(Book, the_joining_point_counts_in_the_longest_path) {
  ASSERT_TRUE(book.begin(kAnna, stroke, tool()));
  const Path longest(StrokeTracker::kMaxPath, glm::dvec2(1, 1));
  ASSERT_TRUE(book.extend(kAnna, stroke, ids[0], 0, longest));
  const auto refused = book.extend(kAnna, stroke, ids[1], 1, longest);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "path");
  EXPECT_TRUE(
      book.extend(kAnna, stroke, ids[1], 1, Path(StrokeTracker::kMaxPath - 1, glm::dvec2(1, 1))))
      << "a refused batch takes no number";
}

TEST_F(Book, old_strokes_are_forgotten) {
  const auto start = StrokeTracker::Clock::now();
  ASSERT_TRUE(book.begin(kAnna, stroke, tool(), start));
  ASSERT_TRUE(book.begin(kAnna, random_uuid(), tool(),
                         start + StrokeTracker::kKeepFor + std::chrono::seconds(1)));
  EXPECT_FALSE(book.tool(kAnna, stroke));
  EXPECT_EQ(book.open_strokes(kAnna).size(), 1u);
}

TEST_F(Book, one_person_cannot_fill_the_memory_with_strokes) {
  for (std::size_t i = 0; i < StrokeTracker::kMaxStrokes + 50; ++i)
    ASSERT_TRUE(book.begin(kAnna, random_uuid(), tool()));
  EXPECT_EQ(book.open_strokes(kAnna).size(), StrokeTracker::kMaxStrokes);
}

}  // namespace
}  // namespace strata::app
