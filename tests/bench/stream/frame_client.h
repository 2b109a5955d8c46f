#pragma once

#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <functional>
#include <iostream>
#include <mutex>
#include <string_view>

#include "bench/harness.h"
#include "protocol/frame_header.h"
#include "room/participants.h"
#include "room/room.h"

namespace strata::bench {

// Replaces the socket. Records the time at which it receives a frame, and acknowledges the frame
// like a client that draws immediately.
class FrameClient {
 public:
  struct Arrival {
    double at_ms;
    protocol::FrameHeader header;
    std::size_t bytes;
    std::size_t content;  // a hash of the frame data after the header
  };
  void receive(const stream::FrameMessages& frame) {
    const double at = now_ms();
    std::lock_guard lock(mutex_);
    for (const stream::FrameBytes& message : frame) {
      auto header = must(protocol::decode_frame_header(*message));
      const std::string_view payload(reinterpret_cast<const char*>(message->data()),
                                     message->size());
      const std::size_t content =
          std::hash<std::string_view>()(payload.substr(payload.size() - header.payload_bytes));
      arrivals_.push_back({at, header, message->size(), content});
    }
    changed_.notify_all();
  }
  template <class Predicate>
  Arrival wait_for(room::Participant& member, Predicate predicate) {
    std::unique_lock lock(mutex_);
    while (true) {
      if (!changed_.wait_for(lock, std::chrono::seconds(30), [&] { return !arrivals_.empty(); })) {
        std::cerr << "strata-bench: no frame came in 30 s" << std::endl;
        std::exit(1);
      }
      const Arrival arrival = arrivals_.front();
      arrivals_.pop_front();
      lock.unlock();
      if (arrival.header.last) member.ack(arrival.header.view_id, arrival.header.frame);
      if (predicate(arrival)) return arrival;
      lock.lock();
    }
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Arrival> arrivals_;
};

}  // namespace strata::bench
