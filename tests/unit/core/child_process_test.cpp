#include "core/child_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <thread>

namespace strata {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Result<ChildExit> shell(const std::string& script, Progress& progress,
                        std::vector<std::string>& lines) {
  return run_child("/bin/sh", {"-c", script}, progress,
                   [&](std::string_view line) { lines.emplace_back(line); });
}

TEST(ChildProcess, lines_and_the_exit_status_are_returned) {
  Progress progress;
  std::vector<std::string> lines;
  const auto exit =
      shell("echo one; echo; printf 'two words'; echo why >&2; exit 7", progress, lines);
  ASSERT_TRUE(exit) << exit.error().detail;
  EXPECT_EQ(exit->status, 7);
  EXPECT_EQ(exit->last_words, "why\n");
  EXPECT_THAT(lines, ElementsAre("one", "", "two words"));
}

TEST(ChildProcess, words_are_not_interpreted_by_a_shell) {
  Progress progress;
  std::vector<std::string> lines;
  const auto exit = run_child("/bin/echo", {"$HOME; `id`", "*"}, progress,
                              [&](std::string_view line) { lines.emplace_back(line); });
  ASSERT_TRUE(exit);
  EXPECT_THAT(lines, ElementsAre("$HOME; `id` *"));
}

TEST(ChildProcess, much_output_is_bounded_and_does_not_block) {
  Progress progress;
  std::vector<std::string> lines;
  const auto exit = shell(
      "head -c 300000 /dev/zero | tr '\\0' x; echo; head -c 300000 /dev/zero | tr '\\0' y >&2",
      progress, lines);
  ASSERT_TRUE(exit);
  EXPECT_EQ(exit->status, 0);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0], std::string(4096, 'x'));
  EXPECT_EQ(exit->last_words, std::string(2000, 'y'));
}

TEST(ChildProcess, a_signal_that_ends_the_program_is_its_status) {
  Progress progress;
  std::vector<std::string> lines;
  const auto exit = shell("kill -KILL $$", progress, lines);
  ASSERT_TRUE(exit);
  EXPECT_EQ(exit->status, 128 + SIGKILL);
}

TEST(ChildProcess, a_cancel_kills_the_program_and_its_children) {
  Progress progress;
  std::string inner;
  const auto exit = run_child("/bin/sh", {"-c", "sleep 1000 & echo $!; wait"}, progress,
                              [&](std::string_view line) {
                                inner = line;
                                progress.cancel();
                              });
  ASSERT_FALSE(exit);
  EXPECT_EQ(exit.error().code, ErrorCode::cancelled);
  ASSERT_FALSE(inner.empty());
  // The end of the output, for which run_child waits, is the end of the last process.
  EXPECT_FALSE(std::filesystem::exists("/proc/" + inner + "/exe"));
}

TEST(ChildProcess, nothing_is_started_after_a_cancel) {
  Progress progress;
  progress.cancel();
  std::vector<std::string> lines;
  const auto exit = shell("echo one", progress, lines);
  ASSERT_FALSE(exit);
  EXPECT_EQ(exit.error().code, ErrorCode::cancelled);
  EXPECT_TRUE(lines.empty());
}

TEST(ChildProcess, a_missing_program_is_named) {
  Progress progress;
  const auto exit = run_child("/nowhere/program", {}, progress, [](std::string_view) {});
  ASSERT_FALSE(exit);
  EXPECT_EQ(exit.error().code, ErrorCode::internal);
  EXPECT_THAT(exit.error().detail, HasSubstr("/nowhere/program"));
}

}  // namespace
}  // namespace strata
