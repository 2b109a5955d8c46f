#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "net/live_session.h"

namespace strata::net {

// The open WebSockets, so that a stopping server can say goodbye. Thread-safe.
class LiveSockets {
 public:
  void add(std::weak_ptr<LiveSocket> socket) {
    std::lock_guard lock(mutex_);
    std::erase_if(sockets_, [](const auto& known) { return known.expired(); });
    sockets_.push_back(std::move(socket));
  }
  void close_all(int code, const std::string& reason) {
    std::vector<std::weak_ptr<LiveSocket>> sockets;
    {
      std::lock_guard lock(mutex_);
      sockets.swap(sockets_);
    }
    for (const auto& weak : sockets)
      if (auto socket = weak.lock()) socket->close(code, reason);
  }

 private:
  std::mutex mutex_;
  std::vector<std::weak_ptr<LiveSocket>> sockets_;
};

}  // namespace strata::net
