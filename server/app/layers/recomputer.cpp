#include "app/layers/recomputer.h"

#include <algorithm>
#include <exception>

#include "app/layers/formula_layers.h"
#include "core/log.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "room/edits.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/content/layers.h"
#include "store/store.h"

namespace strata::app {
namespace {

constexpr std::chrono::seconds kBetweenLooks{1}, kFirstPause{5}, kMaxPause{600};
constexpr int kMaxChecks = 10;
// The author in the history of the layer is the server, which may edit locked layers.
const Author kAuthor("Strata", Role::owner);

}  // namespace

Recomputer::Recomputer(const Services& services)
    : services_(services), thread_([this] { run(); }) {}

void Recomputer::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  progress_.cancel();
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool Recomputer::is_stopping() {
  const std::lock_guard lock(mutex_);
  return stopping_;
}

void Recomputer::run() {
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      if (wake_.wait_for(lock, kBetweenLooks, [this] { return stopping_; })) return;
    }
    try {
      const auto layers = services_.store.layers().to_recompute();
      if (!layers) continue;  // the database is unreachable
      for (const Layer& layer : *layers) {
        if (is_stopping()) return;
        recompute(layer);
      }
      const auto uncounted = services_.store.layers().to_sum();
      if (!uncounted) continue;
      for (const Layer& layer : *uncounted) {
        if (is_stopping()) return;
        attempt(layer, "counted", [&](const std::shared_ptr<room::Room>& room) {
          return room->edits().keep_sums(layer.id);
        });
      }
    } catch (const std::exception& error) {
      log::error(std::string("computing layers failed: ") + error.what());
    }
  }
}

bool Recomputer::is_quiet(const room::Room& room, LayerId layer_id) {
  Wait& wait = waits_[layer_id];
  const std::int64_t sequence = room.edits().sequence();
  if (wait.sequence != sequence && ++wait.checks < kMaxChecks) {
    wait.sequence = sequence;
    return false;
  }
  waits_.erase(layer_id);
  return true;
}

void Recomputer::attempt(
    const Layer& layer, const char* what,
    const std::function<Result<void>(const std::shared_ptr<room::Room>&)>& work) {
  const auto now = std::chrono::steady_clock::now();
  const auto failed = failures_.find(layer.id);
  if (failed != failures_.end() && now < failed->second.again) return;
  auto room = services_.rooms.open(to_string(layer.model_id), kAuthor.role);
  if (room && !is_quiet(**room, layer.id)) return;
  const Result<void> done = room ? work(*room) : tl::unexpected(room.error());
  if (done) {
    failures_.erase(layer.id);
    return;
  }
  // The node that owns the model computes the layer.
  if (done.error().code == ErrorCode::moved) {
    failures_[layer.id] = {now + kFirstPause, kFirstPause};
    return;
  }
  const auto pause =
      failed == failures_.end() ? kFirstPause : std::min(kMaxPause, 2 * failed->second.pause);
  failures_[layer.id] = {now + pause, pause};
  // Does not log a layer that was deleted or that the open room does not contain yet.
  if (failed != failures_.end() || is_stopping() || done.error().code == ErrorCode::not_found)
    return;
  if (services_.store.layers().find(layer.model_id, to_string(layer.id), Role::owner))
    log::warning("layer " + to_string(layer.id) + " could not be " + what + ": " +
                 done.error().detail);
}

void Recomputer::recompute(const Layer& layer) {
  attempt(layer, "computed", [&](const std::shared_ptr<room::Room>& room) -> Result<void> {
    STRATA_TRY(compute_layer(services_, room, layer, kAuthor, progress_));
    return {};
  });
}

}  // namespace strata::app
