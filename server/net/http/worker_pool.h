#pragma once

#include <functional>
#include <thread>
#include <vector>

#include "core/bounded_queue.h"

namespace strata::net {

// Threads for work that may block, such as database access, queries and image encoding. The threads
// of the sockets therefore never block.
class WorkerPool {
 public:
  WorkerPool(int threads, std::size_t max_waiting) : queue_(max_waiting) {
    for (int i = 0; i < threads; ++i)
      threads_.emplace_back([this] {
        while (auto work = queue_.pop()) (*work)();
      });
  }
  ~WorkerPool() { stop(); }

  // Returns false if the queue is full or the pool has stopped. The caller then responds with 503.
  bool post(std::function<void()> work) { return queue_.push(std::move(work)); }
  std::size_t waiting() const { return queue_.size(); }

  // Finishes the queued work and joins the threads.
  void stop() {
    queue_.close();
    for (auto& thread : threads_)
      if (thread.joinable()) thread.join();
  }

 private:
  BoundedQueue<std::function<void()>> queue_;
  std::vector<std::thread> threads_;
};

}  // namespace strata::net
