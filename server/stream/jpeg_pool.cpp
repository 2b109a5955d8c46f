#include "stream/jpeg_pool.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <list>
#include <mutex>
#include <span>
#include <thread>
#include <utility>

#include "core/log.h"
#include "render/thread/screen_rect.h"

namespace strata::stream {
namespace {

// The encoding of one frame with one setting, and its callbacks. Kept while the frame exists,
// because another viewer may request the same encoding.
struct Work {
  std::weak_ptr<const render::Frame> frame;
  JpegSettings settings;
  std::vector<JpegPool::Done> waiting;
  bool encoded = false;
  Jpegs jpegs;
  double took_ms = 0;

  bool is_of(const render::SharedFrame& other, JpegSettings requested) const {
    return settings == requested && !frame.owner_before(other) && !other.owner_before(frame);
  }
};

struct Job {
  std::shared_ptr<Work> work;
  render::SharedFrame frame;
};

Jpegs jpegs_of(const render::Frame& frame, JpegSettings settings) {
  try {
    std::vector<std::vector<std::uint8_t>> jpegs;
    std::span<const std::uint8_t> left = frame.pixels;
    for (const render::PixelRect& rect : frame.rects) {
      const auto pixels = left.first(std::min(render::rgba_bytes(rect), left.size()));
      left = left.subspan(pixels.size());
      jpegs.push_back(encode_jpeg(pixels, rect.width, rect.height, settings));
    }
    return std::make_shared<const std::vector<std::vector<std::uint8_t>>>(std::move(jpegs));
  } catch (const std::exception& error) {
    log::error(error.what());
    return nullptr;
  }
}

}  // namespace

struct JpegPool::Impl {
  mutable std::mutex mutex;
  std::condition_variable changed;
  std::list<std::shared_ptr<Work>> known;
  std::deque<Job> jobs;
  std::uint64_t encoded = 0;
  bool stopping = false;
  std::vector<std::thread> threads;

  void run() {
    for (;;) {
      std::unique_lock lock(mutex);
      changed.wait(lock, [&] { return stopping || !jobs.empty(); });
      if (stopping) return;
      Job job = std::move(jobs.front());
      jobs.pop_front();
      Work& work = *job.work;
      if (!work.encoded) {
        lock.unlock();
        const auto start = std::chrono::steady_clock::now();
        Jpegs jpegs = jpegs_of(*job.frame, work.settings);
        const std::chrono::duration<double, std::milli> elapsed =
            std::chrono::steady_clock::now() - start;
        lock.lock();
        work.encoded = true;
        work.jpegs = std::move(jpegs);
        work.took_ms = elapsed.count();
        ++encoded;
      }
      const auto waiting = std::exchange(work.waiting, {});
      lock.unlock();
      for (const Done& done : waiting) done(work.jpegs, work.took_ms);
    }
  }
};

JpegPool::JpegPool(int threads) : impl_(std::make_unique<Impl>()) {
  for (int i = 0; i < std::max(1, threads); ++i)
    impl_->threads.emplace_back([impl = impl_.get()] { impl->run(); });
}

JpegPool::~JpegPool() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->stopping = true;
    impl_->changed.notify_all();
  }
  for (auto& thread : impl_->threads) thread.join();
}

void JpegPool::encode(render::SharedFrame frame, JpegSettings settings, Done done) {
  std::lock_guard lock(impl_->mutex);
  if (impl_->stopping) return;
  std::erase_if(impl_->known, [](const auto& work) { return work->frame.expired(); });
  const auto same = std::find_if(impl_->known.begin(), impl_->known.end(),
                                 [&](const auto& work) { return work->is_of(frame, settings); });
  const auto work = same != impl_->known.end() ? *same
                                               : impl_->known.emplace_back(std::make_shared<Work>(
                                                     Work{frame, settings, {}, false, {}, 0}));
  work->waiting.push_back(std::move(done));
  // A request during the encoding waits for the same result.
  if (work->waiting.size() > 1 || (same != impl_->known.end() && !work->encoded)) return;
  impl_->jobs.push_back({work, std::move(frame)});
  impl_->changed.notify_one();
}

std::uint64_t JpegPool::encoded() const {
  std::lock_guard lock(impl_->mutex);
  return impl_->encoded;
}

}  // namespace strata::stream
