#include "jobs/job_queue.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "core/give_back_memory.h"
#include "core/log.h"

namespace strata::jobs {
namespace {

constexpr std::size_t kMaxWaiting = 64;
constexpr std::size_t kMaxRemembered = 1000;

bool is_over(JobState state) { return state != JobState::queued && state != JobState::running; }

struct Job {
  JobQueue::Work work;
  std::shared_ptr<Progress> progress = std::make_shared<Progress>();
  JobStatus status;
};

// The state as of now: what runs reports through its progress.
JobStatus snapshot(const Job& job) {
  JobStatus status = job.status;
  if (status.state == JobState::running) {
    status.progress = job.progress->fraction();
    status.message = job.progress->message();
  }
  return status;
}

Result<JobResult> run(const JobQueue::Work& work, Progress& progress) {
  if (progress.cancelled()) return cancelled_problem();
  try {
    return work(progress);
  } catch (const std::bad_alloc&) {
    return fail(507, "Not enough memory",
                "The server has not enough memory for this. Make the file smaller, or give the server more.");
  } catch (const std::exception& error) {
    log::error(std::string("A job failed unexpectedly: ") + error.what());
    return fail(500, "Job failed",
                "The server could not finish this because of a fault of its own; its log says more.");
  }
}

}  // namespace

struct JobQueue::Impl {
  mutable std::mutex mutex;
  std::condition_variable changed;
  std::map<std::int64_t, Job> jobs;  // by id: in order of asking
  std::deque<std::int64_t> waiting;
  // In milliseconds: nobody asks for a thousand jobs a second, second after second.
  std::int64_t last_id =
      std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::system_clock::now().time_since_epoch())
          .count();
  bool stopping = false;
  std::thread thread;

  void end(Job& job, Result<JobResult> result) {
    job.work = nullptr;
    if (result) {
      job.status.state = JobState::done;
      job.status.progress = 1;
      job.status.message = "Done";
      job.status.result = std::move(*result);
      return;
    }
    job.status.progress = job.progress->fraction();
    job.status.state = result.error().status == 499 ? JobState::cancelled : JobState::failed;
    job.status.message = result.error().title;
    job.status.problem = std::move(result.error());
  }

  void forget_old() {
    for (auto it = jobs.begin(); jobs.size() > kMaxRemembered + kMaxWaiting && it != jobs.end();)
      it = is_over(it->second.status.state) ? jobs.erase(it) : std::next(it);
    int files = 0;
    for (auto it = jobs.rbegin(); it != jobs.rend(); ++it)
      if (auto& result = it->second.status.result; result && result->file && ++files > kFilesKept) result->file.reset();
  }

  void work_on_jobs() {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [&] { return stopping || !waiting.empty(); });
      if (stopping) return;
      Job& job = jobs.at(waiting.front());  // stays where it is while it runs: only finished jobs are forgotten
      waiting.pop_front();
      job.status.state = JobState::running;
      const auto progress = job.progress;
      Work work = std::move(job.work);
      lock.unlock();
      auto result = run(work, *progress);
      work = nullptr;
      lock.lock();
      end(job, std::move(result));
      forget_old();
      lock.unlock();
      give_back_memory();
      lock.lock();
    }
  }
};

JobQueue::JobQueue() : impl_(std::make_unique<Impl>()) {
  impl_->thread = std::thread([impl = impl_.get()] { impl->work_on_jobs(); });
}

JobQueue::~JobQueue() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->stopping = true;
    for (auto& [id, job] : impl_->jobs) job.progress->cancel();
    impl_->changed.notify_all();
  }
  impl_->thread.join();
}

Result<std::int64_t> JobQueue::add(std::int64_t project, Work work, std::string user) {
  std::lock_guard lock(impl_->mutex);
  if (impl_->stopping) return fail(503, "Server stops", "The server is stopping and takes no new work.");
  if (impl_->waiting.size() >= kMaxWaiting)
    return fail(503, "Too much waiting work",
                std::to_string(kMaxWaiting) + " jobs wait already. Try again when some are done.");
  const std::int64_t id = ++impl_->last_id;
  Job& job = impl_->jobs[id];
  job.work = std::move(work);
  job.status.id = id;
  job.status.project = project;
  job.status.user = std::move(user);
  job.status.message = "Waiting";
  impl_->waiting.push_back(id);
  impl_->changed.notify_all();
  return id;
}

std::optional<JobStatus> JobQueue::status(std::int64_t id) const {
  std::lock_guard lock(impl_->mutex);
  const auto found = impl_->jobs.find(id);
  if (found == impl_->jobs.end()) return std::nullopt;
  return snapshot(found->second);
}

std::vector<JobStatus> JobQueue::all() const {
  std::lock_guard lock(impl_->mutex);
  std::vector<JobStatus> all;
  for (auto job = impl_->jobs.rbegin(); job != impl_->jobs.rend(); ++job) all.push_back(snapshot(job->second));
  return all;
}

bool JobQueue::cancel(std::int64_t id) {
  std::lock_guard lock(impl_->mutex);
  const auto found = impl_->jobs.find(id);
  if (found == impl_->jobs.end() || is_over(found->second.status.state)) return false;
  Job& job = found->second;
  job.progress->cancel();
  if (job.status.state == JobState::queued) {
    std::erase(impl_->waiting, id);
    impl_->end(job, cancelled_problem());
  }
  return true;
}

}  // namespace strata::jobs
