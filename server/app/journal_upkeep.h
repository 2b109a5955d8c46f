#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "room/rooms.h"
#include "store/journal/journal_merger.h"
#include "store/store.h"

namespace strata::app {

// Merges the journals of the open models (store/journal/journal_merger.h), some time after strokes
// have ended. Works in small steps, and waits between them for several times their duration, so
// that painting does not become slower. A step that fails is repeated later.
class JournalUpkeep {
 public:
  // Merges strokes that ended longer than `merge_after` ago. Does nothing if `merge_after` is 0.
  // `store` and `rooms` must outlive the object.
  JournalUpkeep(store::Store& store, room::Rooms& rooms, std::chrono::seconds merge_after);
  ~JournalUpkeep() { stop(); }
  void stop();  // waits for the current step

 private:
  using Clock = std::chrono::steady_clock;
  void run();
  // Returns whether more edits can be merged immediately.
  bool merge_all();
  bool merge(const room::Rooms::Claim& claim);
  bool pause_between_steps();  // returns false if the server stops
  void report(const Error& problem);

  room::Rooms& rooms_;
  const std::chrono::seconds merge_after_;
  store::JournalMerger merger_;
  Clock::time_point step_began_;
  bool failed_ = false;  // the last merge failed, and the log contains the reason
  std::mutex mutex_;
  std::condition_variable wake_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace strata::app
