#include "jobs/job_queue.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <fstream>
#include <future>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

namespace strata::jobs {
namespace {

JobStatus wait_until_over(const JobQueue& queue, JobId id) {
  for (int i = 0; i < 6000; ++i) {
    const auto status = queue.status(id);
    if (!status || (status->state != JobState::queued && status->state != JobState::running))
      return status.value_or(JobStatus{});
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ADD_FAILURE() << "the job did not end";
  return {};
}

// A job that occupies the queue until the gate is opened.
struct Gate {
  std::promise<void> opened, entered;
  std::shared_future<void> open = opened.get_future().share();
  JobQueue::Work work() {
    return [this](Progress& progress) -> Result<JobResult> {
      progress.report(0.25, "Waiting at the gate");
      entered.set_value();
      open.wait();
      return ModelId(1);
    };
  }
};

TEST(JobsQueue, a_job_that_ends_names_its_model) {
  JobQueue queue;
  const auto id = queue.add(1, [](Progress&) -> Result<JobResult> { return ModelId(42); });
  ASSERT_TRUE(id);
  const auto status = wait_until_over(queue, *id);
  EXPECT_EQ(status.state, JobState::done);
  ASSERT_TRUE(status.result);
  EXPECT_EQ(status.result->model, ModelId(42));
  EXPECT_EQ(status.progress, 1);
  EXPECT_FALSE(status.problem);
}

TEST(JobsQueue, a_job_that_fails_keeps_its_problem) {
  JobQueue queue;
  const auto id = queue.add(1, [](Progress&) -> Result<JobResult> {
    return fail(ErrorCode::invalid, "Mesh file refused", "No triangle.", "file");
  });
  const auto status = wait_until_over(queue, *id);
  EXPECT_EQ(status.state, JobState::failed);
  ASSERT_TRUE(status.problem);
  EXPECT_EQ(status.problem->detail, "No triangle.");
  EXPECT_FALSE(status.result);
}

TEST(JobsQueue, a_job_that_throws_fails_and_the_next_one_runs) {
  JobQueue queue;
  const auto bad =
      queue.add(1, [](Progress&) -> Result<JobResult> { throw std::runtime_error("planted"); });
  const auto huge = queue.add(1, [](Progress&) -> Result<JobResult> { throw std::bad_alloc(); });
  const auto good = queue.add(1, [](Progress&) -> Result<JobResult> { return ModelId(7); });
  EXPECT_EQ(wait_until_over(queue, *bad).problem->code, ErrorCode::internal);
  EXPECT_EQ(wait_until_over(queue, *huge).problem->code, ErrorCode::out_of_memory);
  EXPECT_EQ(wait_until_over(queue, *good).state, JobState::done);
}

TEST(JobsQueue, jobs_run_one_at_a_time_in_the_order_of_asking) {
  JobQueue queue;
  std::vector<int> order;
  std::atomic<int> running{0};
  JobId last;
  for (int i = 0; i < 20; ++i)
    last = *queue.add(1, [&, i](Progress&) -> Result<JobResult> {
      EXPECT_EQ(++running, 1);
      order.push_back(i);
      --running;
      return ModelId(std::int64_t{i});
    });
  wait_until_over(queue, last);
  ASSERT_EQ(order.size(), 20u);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(order[i], i);
  ASSERT_EQ(queue.all().size(), 20u);
  EXPECT_EQ(queue.all().front().id, last) << "newest first";
}

TEST(JobsQueue, files_are_made_during_other_jobs_one_at_a_time) {
  Gate long_job, file;
  JobQueue queue;
  const auto quick = [](Progress&) -> Result<JobResult> { return ModelId(1); };
  queue.add(1, long_job.work(), "ada", JobKind::layers);
  const auto other = queue.add(1, quick, "ben", JobKind::changes);
  queue.add(1, file.work(), "ada", JobKind::figure);
  const auto second_file = queue.add(1, quick, "ben", JobKind::figure);
  long_job.entered.get_future().wait();
  file.entered.get_future().wait();
  for (const auto& waiting : {other, second_file})
    EXPECT_EQ(queue.status(*waiting)->state, JobState::queued);
  file.opened.set_value();
  EXPECT_EQ(wait_until_over(queue, *second_file).state, JobState::done);
  EXPECT_EQ(queue.status(*other)->state, JobState::queued);
  long_job.opened.set_value();
  EXPECT_EQ(wait_until_over(queue, *other).state, JobState::done);
}

TEST(JobsQueue, progress_shows_while_a_job_runs) {
  Gate gate;
  JobQueue queue;
  const auto id = queue.add(1, gate.work());
  gate.entered.get_future().wait();
  const auto status = queue.status(*id);
  ASSERT_TRUE(status);
  EXPECT_EQ(status->state, JobState::running);
  EXPECT_EQ(status->progress, 0.25);
  EXPECT_EQ(status->message, "Waiting at the gate");
  gate.opened.set_value();
}

TEST(JobsQueue, more_than_64_waiting_jobs_are_refused) {
  Gate gate;
  JobQueue queue;
  ASSERT_TRUE(queue.add(1, gate.work()));
  gate.entered.get_future().wait();
  for (int i = 0; i < 64; ++i)
    EXPECT_TRUE(queue.add(1, [](Progress&) -> Result<JobResult> { return ModelId(1); }));
  const auto refused = queue.add(1, [](Progress&) -> Result<JobResult> { return ModelId(1); });
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::busy);
  gate.opened.set_value();
}

TEST(JobsQueue, a_waiting_job_that_is_cancelled_never_runs) {
  Gate gate;
  JobQueue queue;
  queue.add(1, gate.work());
  gate.entered.get_future().wait();
  std::atomic<bool> ran{false};
  const auto id = queue.add(1, [&](Progress&) -> Result<JobResult> {
    ran = true;
    return ModelId(1);
  });
  EXPECT_TRUE(queue.cancel(*id));
  EXPECT_EQ(queue.status(*id)->state, JobState::cancelled);
  EXPECT_FALSE(queue.cancel(*id)) << "it is over";
  gate.opened.set_value();
  const auto after = queue.add(1, [](Progress&) -> Result<JobResult> { return ModelId(1); });
  wait_until_over(queue, *after);
  EXPECT_FALSE(ran);
}

TEST(JobsQueue, a_running_job_that_is_cancelled_stops) {
  JobQueue queue;
  std::promise<void> entered;
  const auto id = queue.add(1, [&](Progress& progress) -> Result<JobResult> {
    entered.set_value();
    while (!progress.cancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return cancelled_problem();
  });
  entered.get_future().wait();
  EXPECT_TRUE(queue.cancel(*id));
  EXPECT_EQ(wait_until_over(queue, *id).state, JobState::cancelled);
}

TEST(JobsQueue, ending_the_queue_cancels_what_runs) {
  std::promise<void> entered;
  bool stopped = false;
  {
    JobQueue queue;
    queue.add(1, [&](Progress& progress) -> Result<JobResult> {
      entered.set_value();
      while (!progress.cancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      stopped = true;
      return cancelled_problem();
    });
    entered.get_future().wait();
  }
  EXPECT_TRUE(stopped);
}

TEST(JobsQueue, a_stopped_queue_runs_nothing_and_keeps_its_list) {
  JobQueue queue;
  std::promise<void> entered;
  const auto running = queue.add(1, [&](Progress& progress) -> Result<JobResult> {
    entered.set_value();
    while (!progress.cancelled()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return cancelled_problem();
  });
  bool ran = false;
  queue.add(1, [&](Progress&) -> Result<JobResult> {
    ran = true;
    return ModelId(1);
  });
  entered.get_future().wait();
  queue.stop();
  queue.stop();
  EXPECT_FALSE(ran);
  EXPECT_EQ(queue.status(*running)->state, JobState::cancelled);
  const auto late = queue.add(1, [](Progress&) -> Result<JobResult> { return ModelId(1); });
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, ErrorCode::unavailable);
}

TEST(JobsQueue, the_newest_thousand_are_remembered) {
  JobQueue queue;
  JobId last;
  for (int i = 0; i < 1200; ++i) {
    const auto id = queue.add(1, [](Progress&) -> Result<JobResult> { return ModelId(1); });
    if (id) last = *id;
    if (!id || i % 50 == 0) wait_until_over(queue, last);
  }
  wait_until_over(queue, last);
  EXPECT_LE(queue.all().size(), 1064u);
  EXPECT_GE(queue.all().size(), 1000u);
  EXPECT_FALSE(queue.status(1));
  EXPECT_TRUE(queue.status(last));
  EXPECT_FALSE(queue.status(-1));
  EXPECT_FALSE(queue.cancel(999'999));
}

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

TEST(JobsQueue, what_a_job_freed_in_small_pieces_is_given_back_to_the_system) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "SKIPPED: the sanitizer's allocator keeps what is freed";
#endif
  using Pieces = std::vector<std::unique_ptr<std::array<char, 4000>>>;
  const double before = resident_mb();
  // This memory is above all other blocks, so malloc does not automatically return the memory below
  // it to the system.
  const auto last = std::make_shared<Pieces>();
  double most = 0;
  JobQueue queue;
  const auto id = queue.add(1, [&](Progress&) -> Result<JobResult> {
    Pieces pieces;
    for (int i = 0; i < 100'000; ++i) {
      pieces.push_back(std::make_unique<std::array<char, 4000>>());
      pieces.back()->fill('x');
    }
    most = resident_mb();
    last->push_back(std::move(pieces.back()));
    return ModelId(1);
  });
  wait_until_over(queue, *id);
  EXPECT_GT(most, before + 300);
  double now = resident_mb();
  for (int i = 0; i < 6000 && now > before + 100; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    now = resident_mb();
  }
  EXPECT_LT(now, before + 100);
}

TEST(JobsProgress, stages_map_their_reports_into_the_whole) {
  Progress progress;
  progress.begin_stage(0.2, 0.6);
  progress.report(0.5, "half of the stage");
  EXPECT_DOUBLE_EQ(progress.fraction(), 0.4);
  progress.begin_stage(0.6, 1);
  progress.report(1, "all");
  EXPECT_DOUBLE_EQ(progress.fraction(), 1);
}

}  // namespace
}  // namespace strata::jobs
