#include "core/progress.h"

#include <gtest/gtest.h>

namespace strata {
namespace {

TEST(ProgressReports, a_stage_is_a_part_of_the_task) {
  Progress progress;
  progress.begin_stage(0.5, 1);
  progress.report(0.5, "Reading");
  EXPECT_EQ(progress.fraction(), 0.75);
  EXPECT_EQ(progress.message(), "Reading");
}

TEST(ProgressReports, stages_of_a_part_are_within_the_part) {
  Progress progress;
  progress.begin_part(1, 4);
  EXPECT_EQ(progress.fraction(), 0);
  EXPECT_EQ(progress.message(), "Step 1 of 4");
  progress.begin_stage(0.5, 1);
  progress.report(1, "Saving");
  EXPECT_EQ(progress.fraction(), 0.25);
  EXPECT_EQ(progress.message(), "Step 1 of 4: Saving");
  // the next part begins with its own stages
  progress.begin_part(2, 4);
  EXPECT_EQ(progress.fraction(), 0.25);
  progress.report(0.5, "Reading");
  EXPECT_EQ(progress.fraction(), 0.375);
  EXPECT_EQ(progress.message(), "Step 2 of 4: Reading");
}

TEST(ProgressReports, a_task_with_one_part_has_no_number) {
  Progress progress;
  progress.begin_part(1, 1);
  progress.report(0.5, "Reading");
  EXPECT_EQ(progress.fraction(), 0.5);
  EXPECT_EQ(progress.message(), "Reading");
}

TEST(ProgressReports, a_watcher_is_called_once_when_the_task_is_cancelled) {
  Progress progress;
  int early = 0, during = 0, late = 0;
  {
    const Progress::WhenCancelled gone(progress, [&] { ++early; });
  }
  {
    const Progress::WhenCancelled watcher(progress, [&] { ++during; });
    EXPECT_EQ(during, 0);
    progress.cancel();
    progress.cancel();
  }
  const Progress::WhenCancelled after(progress, [&] { ++late; });
  EXPECT_EQ(early, 0);
  EXPECT_EQ(during, 1);
  EXPECT_EQ(late, 1);
}

}  // namespace
}  // namespace strata
