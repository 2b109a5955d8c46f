#include "stream/jpeg_pool.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "core/log.h"

namespace strata::stream {
namespace {

struct Job {
  std::vector<std::uint8_t> rgba;
  int width = 0, height = 0;
  JpegSettings settings;
  std::function<void(std::vector<std::uint8_t>, double)> done;
};

void work_on(Job job) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::uint8_t> jpeg;
  try {
    jpeg = encode_jpeg(job.rgba, job.width, job.height, job.settings);
  } catch (const std::exception& error) {
    log::error(error.what());
  }
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
  job.done(std::move(jpeg), elapsed.count());
}

}  // namespace

struct JpegPool::Impl {
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<Job> jobs;
  bool stopping = false;
  std::vector<std::thread> threads;

  void run() {
    for (;;) {
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return stopping || !jobs.empty(); });
      if (stopping) return;
      Job job = std::move(jobs.front());
      jobs.pop_front();
      lock.unlock();
      work_on(std::move(job));
    }
  }
};

JpegPool::JpegPool(int threads) : impl_(std::make_unique<Impl>()) {
  for (int i = 0; i < std::max(1, threads); ++i) impl_->threads.emplace_back([impl = impl_.get()] { impl->run(); });
}

JpegPool::~JpegPool() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->stopping = true;
    impl_->changed.notify_all();
  }
  for (auto& thread : impl_->threads) thread.join();
}

void JpegPool::encode(std::vector<std::uint8_t> rgba, int width, int height, JpegSettings settings,
                      std::function<void(std::vector<std::uint8_t>, double)> done) {
  std::lock_guard lock(impl_->mutex);
  if (impl_->stopping) return;
  impl_->jobs.push_back({std::move(rgba), width, height, settings, std::move(done)});
  impl_->changed.notify_one();
}

}  // namespace strata::stream
