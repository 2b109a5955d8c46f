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
#include "core/trace.h"
#include "store/content/jobs.h"

namespace strata::jobs {
namespace {

constexpr std::size_t kMaxWaiting = 64;
constexpr int kIdTries = 64;
constexpr std::size_t kMaxRemembered = 1000;

constexpr std::string_view kKinds[] = {"import",  "layers",  "look",    "figure",
                                       "regions", "changes", "analysis"};

// Returns the Error of a job that ended because the server restarted.
Error lost_problem(JobKind kind) {
  constexpr const char* kTitle = "Server restarted";
  switch (kind) {
    case JobKind::import:
      return {ErrorCode::unavailable,
              kTitle,
              "The server restarted before this import finished, and did not save any part of it. "
              "Start the import again.",
              {}};
    case JobKind::layers:
    case JobKind::analysis:
      return {ErrorCode::unavailable,
              kTitle,
              "The server restarted before this job finished. If the model has hidden, incomplete "
              "layers of this job, delete them. Then start the job again.",
              {}};
    case JobKind::image:
      return {ErrorCode::unavailable,
              kTitle,
              "The server restarted before this picture finished, and did not save any part of it. "
              "Start the job again.",
              {}};
    case JobKind::regions:
      return {ErrorCode::unavailable,
              kTitle,
              "The server restarted before this job finished. If the history of the layer contains "
              "no edit of this job, the layer was not changed. If the table contains new records "
              "of this job without texels, delete them. Then start the job again.",
              {}};
    case JobKind::changes:
      return {ErrorCode::unavailable,
              kTitle,
              "The server restarted before this comparison finished. Start the job again.",
              {}};
    case JobKind::figure: break;
  }
  return {ErrorCode::unavailable,
          kTitle,
          "The server restarted before this file was finished. Start the job again.",
          {}};
}

ErrorCode code_of(const nlohmann::json& stored) {
  if (const auto code = error_code_named(stored.value("code", std::string()))) return *code;
  // Jobs of release 0.1 contain an HTTP status. Jobs are kept for seven days.
  switch (stored.value("status", 500)) {
    case 422: return ErrorCode::invalid;
    case 499: return ErrorCode::cancelled;
    case 503: return ErrorCode::unavailable;
    case 507: return ErrorCode::storage_full;
    default: return ErrorCode::internal;
  }
}

JobStatus status_of(const store::StoredJob& stored) {
  JobStatus status;
  status.id = stored.id;
  status.project = stored.project_id;
  status.user = stored.user;
  const auto* kind = std::ranges::find(kKinds, stored.kind);
  status.kind = static_cast<JobKind>(kind - std::begin(kKinds));
  status.state = stored.state == "done"        ? JobState::done
                 : stored.state == "cancelled" ? JobState::cancelled
                                               : JobState::failed;
  if (stored.state == "lost") status.problem = lost_problem(status.kind);
  if (stored.problem.is_object())
    status.problem =
        Error{code_of(stored.problem), stored.problem.value("title", std::string("Job failed")),
              stored.problem.value("detail", std::string()),
              stored.problem.value("field", std::string())};
  status.message = status.problem ? status.problem->title : "Done";
  if (status.state == JobState::done) status.progress = 1;
  if (stored.result.is_object()) {
    status.result.emplace(stored.result.value("model", ModelId()));
    status.result->layers = stored.result.value("layers", std::vector<LayerId>());
    if (stored.result.contains("look"))
      status.result->image = stored.result["look"].get<SurfaceImageId>();
    status.result->report = stored.result.value("report", nlohmann::json());
  }
  return status;
}

store::StoredJob stored_of(const JobStatus& status) {
  store::StoredJob stored{status.id,   status.project,
                          status.user, std::string(kKinds[static_cast<int>(status.kind)]),
                          {},          {},
                          {}};
  stored.state = status.state == JobState::done        ? "done"
                 : status.state == JobState::cancelled ? "cancelled"
                                                       : "failed";
  if (status.problem)
    stored.problem = {{"code", name(status.problem->code)},
                      {"title", status.problem->title},
                      {"detail", status.problem->detail},
                      {"field", status.problem->field}};
  if (!status.result) return stored;
  stored.result = {{"model", status.result->model}};
  if (!status.result->layers.empty()) stored.result["layers"] = status.result->layers;
  if (status.result->image) stored.result["look"] = *status.result->image;
  if (!status.result->report.is_null()) stored.result["report"] = status.result->report;
  return stored;
}

bool is_over(JobState state) { return state != JobState::queued && state != JobState::running; }

struct Job {
  JobQueue::Work work;
  std::shared_ptr<Progress> progress = std::make_shared<Progress>();
  TraceId trace = current_trace();  // of the request that added the job
  JobStatus status;
};

// Returns the current state. A running job reports its state in its progress.
JobStatus snapshot(const Job& job) {
  JobStatus status = job.status;
  if (status.state == JobState::running) {
    status.progress = job.progress->fraction();
    status.message = job.progress->message();
  }
  return status;
}

// Returns whether one of two jobs must not begin before the end of the other one.
bool exclude_each_other(const JobStatus& a, const JobStatus& b) {
  return (a.kind == JobKind::figure) == (b.kind == JobKind::figure);
}

Result<JobResult> run(const JobQueue::Work& work, Progress& progress) {
  if (progress.cancelled()) return cancelled_problem();
  try {
    return work(progress);
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::out_of_memory, "Not enough memory",
                "The server does not have enough memory for this job. Use a smaller file, or "
                "ask an administrator to increase the memory of the server.");
  } catch (const std::exception& error) {
    log::error(std::string("A job failed unexpectedly: ") + error.what());
    return fail(ErrorCode::internal, "Job failed",
                "An internal error stopped this job. Ask an administrator to check the log of the "
                "server.");
  }
}

}  // namespace

struct JobQueue::Impl {
  mutable std::mutex mutex;
  std::condition_variable changed;
  std::map<JobId, Job> jobs;  // by id, which is the order of the requests
  std::deque<JobId> waiting;
  std::vector<JobId> running;
  std::size_t coming = 0;  // number of jobs that are being stored and do not wait yet
  // The first id follows the current time in milliseconds. Therefore new ids are higher than all
  // earlier ids, if there are on average fewer than 1000 jobs per second.
  std::int64_t last_id = std::chrono::duration_cast<std::chrono::milliseconds>(
                             std::chrono::system_clock::now().time_since_epoch())
                             .count();
  bool stopping = false;
  store::Jobs* store = nullptr;
  std::optional<Uuid> node;
  std::vector<std::thread> workers;

  void take_over() {
    if (!store) return;
    auto earlier = store->take_over(kMaxRemembered);
    if (!earlier) {
      log::warning("earlier jobs could not be read: " + earlier.error().detail);
      return;
    }
    for (const store::StoredJob& stored : *earlier) {
      jobs[stored.id].status = status_of(stored);
      last_id = std::max(last_id, stored.id.number());
    }
  }

  // Stores the result of a job. A job that the shutdown of the server interrupts is not changed,
  // and the next server process handles it.
  void keep_end(const JobStatus& status, bool cut_short) const {
    if (!store || cut_short) return;
    if (auto saved = store->end(stored_of(status)); !saved)
      log::warning("the server could not save the result of a job: " + saved.error().detail);
  }

  // Stores a new job. If another node has used its id, takes the next id.
  Result<void> begin(JobStatus& status) {
    if (!store) return {};
    for (int tries_left = kIdTries;; --tries_left) {
      store::StoredJob stored = stored_of(status);
      stored.node = node;
      auto begun = store->begin(stored);
      if (begun || begun.error().code != ErrorCode::conflict || tries_left == 0) return begun;
      const std::lock_guard lock(mutex);
      status.id = JobId(++last_id);
    }
  }

  Result<void> may_add() const {
    if (stopping)
      return fail(
          ErrorCode::unavailable, "Server is stopping",
          "The server is stopping and accepts no new jobs. Try again when it is running again.");
    if (waiting.size() + coming >= kMaxWaiting)
      return fail(ErrorCode::busy, "Too many waiting jobs",
                  std::to_string(kMaxWaiting) +
                      " jobs are waiting. Try again when some of them have finished.");
    return {};
  }

  // Writes the result of the job to `status`.
  static void end(Job& job, Result<JobResult> result, JobStatus& status) {
    job.work = nullptr;
    if (result) {
      status.state = JobState::done;
      status.progress = 1;
      status.message = "Done";
      status.result = std::move(*result);
      return;
    }
    status.progress = job.progress->fraction();
    status.state =
        result.error().code == ErrorCode::cancelled ? JobState::cancelled : JobState::failed;
    status.message = result.error().title;
    status.problem = std::move(result.error());
  }

  void forget_old() {
    for (auto it = jobs.begin(); jobs.size() > kMaxRemembered + kMaxWaiting && it != jobs.end();)
      it = is_over(it->second.status.state) ? jobs.erase(it) : std::next(it);
    int files = 0;
    for (auto it = jobs.rbegin(); it != jobs.rend(); ++it)
      if (auto& result = it->second.status.result; result && result->file && ++files > kFilesKept)
        result->file.reset();
  }

  // Returns the first waiting job that may begin now, or the end of `waiting`.
  std::deque<JobId>::iterator next() {
    return std::ranges::find_if(waiting, [this](JobId id) {
      return std::ranges::none_of(running, [&](JobId other) {
        return exclude_each_other(jobs.at(id).status, jobs.at(other).status);
      });
    });
  }

  void work_on_jobs() {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [&] { return stopping || next() != waiting.end(); });
      if (stopping) return;
      const auto first = next();
      const JobId id = *first;
      waiting.erase(first);
      running.push_back(id);
      // The reference stays valid during the job, because only finished jobs are deleted.
      Job& job = jobs.at(id);
      job.status.state = JobState::running;
      const auto progress = job.progress;
      Work work = std::move(job.work);
      const TraceScope scope(job.trace);
      lock.unlock();
      auto result = run(work, *progress);
      work = nullptr;
      lock.lock();
      const bool cut_short = stopping && !result && result.error().code == ErrorCode::cancelled;
      JobStatus ended = job.status;
      end(job, std::move(result), ended);
      lock.unlock();
      // The result is stored before it is published. So a restart does not change a result that a
      // client has read.
      keep_end(ended, cut_short);
      lock.lock();
      job.status = std::move(ended);
      std::erase(running, id);
      changed.notify_all();
      forget_old();
      lock.unlock();
      give_back_memory();
      lock.lock();
    }
  }
};

JobQueue::JobQueue(store::Jobs* store, std::optional<Uuid> node) : impl_(std::make_unique<Impl>()) {
  impl_->store = store;
  impl_->node = node;
  impl_->take_over();
  constexpr int kWorkers = 2;  // one of them makes files
  for (int i = 0; i < kWorkers; ++i)
    impl_->workers.emplace_back([impl = impl_.get()] { impl->work_on_jobs(); });
}

JobQueue::~JobQueue() { stop(); }

void JobQueue::stop() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->stopping = true;
    for (auto& [id, job] : impl_->jobs) job.progress->cancel();
    impl_->changed.notify_all();
  }
  for (std::thread& worker : impl_->workers)
    if (worker.joinable()) worker.join();
}

Result<JobId> JobQueue::add(ProjectId project, Work work, std::string user, JobKind kind) {
  JobStatus status;
  {
    std::lock_guard lock(impl_->mutex);
    STRATA_TRY(impl_->may_add());
    status.id = JobId(++impl_->last_id);
    ++impl_->coming;
  }
  status.project = project;
  status.user = std::move(user);
  status.kind = kind;
  status.message = "Waiting";
  auto saved = impl_->begin(status);
  std::lock_guard lock(impl_->mutex);
  --impl_->coming;
  if (!saved) return tl::unexpected(saved.error());
  if (impl_->stopping)
    return fail(
        ErrorCode::unavailable, "Server is stopping",
        "The server is stopping and accepts no new jobs. Try again when it is running again.");
  const JobId id = status.id;
  Job& job = impl_->jobs[id];
  job.work = std::move(work);
  job.progress->set_job(impl_->store ? id : 0);
  job.status = std::move(status);
  impl_->waiting.push_back(id);
  impl_->changed.notify_all();
  return id;
}

std::optional<JobStatus> JobQueue::status(JobId id) const {
  std::lock_guard lock(impl_->mutex);
  const auto found = impl_->jobs.find(id);
  if (found == impl_->jobs.end()) return std::nullopt;
  return snapshot(found->second);
}

std::vector<JobStatus> JobQueue::all() const {
  std::lock_guard lock(impl_->mutex);
  std::vector<JobStatus> all;
  for (auto job = impl_->jobs.rbegin(); job != impl_->jobs.rend(); ++job)
    all.push_back(snapshot(job->second));
  return all;
}

std::array<std::size_t, 5> JobQueue::counts() const {
  std::array<std::size_t, 5> counts{};
  std::lock_guard lock(impl_->mutex);
  for (const auto& [id, job] : impl_->jobs) ++counts[static_cast<std::size_t>(job.status.state)];
  return counts;
}

bool JobQueue::cancel(JobId id) {
  std::unique_lock lock(impl_->mutex);
  const auto found = impl_->jobs.find(id);
  if (found == impl_->jobs.end() || is_over(found->second.status.state)) return false;
  Job& job = found->second;
  job.progress->cancel();
  if (job.status.state == JobState::queued) {
    std::erase(impl_->waiting, id);
    Impl::end(job, cancelled_problem(), job.status);
    const JobStatus ended = job.status;
    lock.unlock();
    impl_->keep_end(ended, false);
  }
  return true;
}

}  // namespace strata::jobs
