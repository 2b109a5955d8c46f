#include "app/journal_upkeep.h"

#include <algorithm>
#include <utility>

#include "core/log.h"
#include "core/version.h"

namespace strata::app {
namespace {

constexpr std::chrono::seconds kMostBetweenLooks{15};
// A step may use a fifth of the time of one core.
constexpr int kPausePerStep = 4;
constexpr std::chrono::milliseconds kShortestPause{5}, kLongestPause{2000};

}  // namespace

JournalUpkeep::JournalUpkeep(store::Store& store, room::Rooms& rooms,
                             std::chrono::seconds merge_after)
    : rooms_(rooms), merge_after_(merge_after), merger_(store.journal()) {
  if (merge_after_.count() > 0) thread_ = std::thread([this] { run(); });
}

void JournalUpkeep::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void JournalUpkeep::run() {
  const auto between_looks = std::min(merge_after_, kMostBetweenLooks);
  for (bool more = false;;) {
    if (!more) {
      std::unique_lock lock(mutex_);
      if (wake_.wait_for(lock, between_looks, [this] { return stopping_; })) return;
    }
    more = merge_all();
    const std::lock_guard lock(mutex_);
    if (stopping_) return;
  }
}

bool JournalUpkeep::merge_all() {
  const auto claims = rooms_.claims();
  if (claims.empty()) return false;
  const auto may = merger_.may_merge(version());
  if (!may) report(may.error());
  if (!may || !*may) return false;
  bool more = false;
  for (const auto& claim : claims) more = merge(claim) || more;
  return more;
}

bool JournalUpkeep::merge(const room::Rooms::Claim& claim) {
  step_began_ = Clock::now();
  const auto done =
      merger_.merge(claim.model, claim.epoch, std::chrono::system_clock::now() - merge_after_,
                    [this] { return pause_between_steps(); });
  if (!done) {
    report(done.error());
    return false;
  }
  failed_ = false;
  if (done->edits > 0 && log::is_enabled(log::Level::debug)) {
    const log::Field fields[] = {
        {"model", claim.model.number()}, {"edits", done->edits}, {"revisions", done->revisions}};
    log::write(log::Level::debug, "journal: merged the batches of strokes", fields);
  }
  return done->more;
}

bool JournalUpkeep::pause_between_steps() {
  const auto pause = std::clamp<Clock::duration>(kPausePerStep * (Clock::now() - step_began_),
                                                 kShortestPause, kLongestPause);
  std::unique_lock lock(mutex_);
  const bool stops = wake_.wait_for(lock, pause, [this] { return stopping_; });
  step_began_ = Clock::now();
  return !stops;
}

// Logs only the first of several failures, because the journal is correct without a merge. Ignores
// the errors of a room that has closed, and of an undo at the same time.
void JournalUpkeep::report(const Error& problem) {
  if (problem.code == ErrorCode::moved || problem.code == ErrorCode::conflict) return;
  if (std::exchange(failed_, true)) return;
  log::warning("journal: strokes could not be merged, trying again: " + problem.detail);
}

}  // namespace strata::app
