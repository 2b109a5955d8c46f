#pragma once

#include <chrono>
#include <deque>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/ids.h"
#include "core/trace.h"
#include "core/uuid.h"
#include "domain/scene/stroke.h"

namespace strata::app {

// The settings in `stroke.begin`. They apply to all batches of a stroke.
struct StrokeTool {
  LayerId layer_id = 0;
  StrokeBatch batch;      // without the path
  nlohmann::json record;  // the journal record without the path
  TraceId trace{};        // trace of the first `stroke.begin`, for all batches
  bool operator==(const StrokeTool& other) const {
    return layer_id == other.layer_id && record == other.record;
  }
};

// Tracks strokes across connections. Each `stroke.extend` is a separate edit. Its path starts at
// the end of the previous batch, even if a client sends a batch again after a reconnect. Removes
// strokes that were not used for ten minutes, and the oldest strokes of a user who has too many.
// Thread-safe.
class StrokeTracker {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMaxStrokes = 256;   // per user and model
  static constexpr std::size_t kMaxBatches = 8192;  // stored per stroke
  static constexpr std::size_t kMaxPath = 4096;     // points per edit, including the joining point
  static constexpr std::chrono::minutes kKeepFor{10};

  struct Owner {
    ModelId model_id = 0;
    std::string user;
    auto operator<=>(const Owner&) const = default;
  };

  // Resumes the stroke if the same `begin` is repeated. Refuses a different `begin` for a known
  // stroke (409).
  Result<void> begin(const Owner& owner, const Uuid& stroke, StrokeTool tool,
                     Clock::time_point now = Clock::now());

  // Returns true if the tracker does not have the previous batch because the server was restarted.
  // In that case, find the end of batch n-1 and pass it to `continue_from` before you call
  // `extend`.
  bool lacks_start(const Owner& owner, const Uuid& stroke, int n) const;
  struct End {  // the end of a batch
    glm::dvec2 point{0};
    double width = 1;
    bool operator==(const End&) const = default;
  };
  void continue_from(const Owner& owner, const Uuid& stroke, int n, const End& end);

  struct Batch {
    StrokeTool tool;
    std::vector<glm::dvec2> path;  // starts at the end of the previous batch
    std::vector<double> widths{};  // of the points; empty: all widths are 1
  };
  // Returns 404 for an unknown stroke. Returns 409 for a batch out of order, a number that belongs
  // to another id, and an ended stroke. Returns 422 for a path that is too long with the joining
  // point, and for a wrong number of widths. For a repeated id, returns the batch of the first
  // call, and changes nothing.
  Result<Batch> extend(const Owner& owner, const Uuid& stroke, const Uuid& id, int n,
                       const std::vector<glm::dvec2>& path, const std::vector<double>& widths = {},
                       Clock::time_point now = Clock::now());
  void saved(const Owner& owner, const Uuid& stroke, int n);
  Result<void> end(const Owner& owner, const Uuid& stroke);

  struct Progress {
    Uuid stroke;
    int n = -1;  // all batches up to this one are saved; -1: no batch
  };
  std::vector<Progress> open_strokes(const Owner& owner) const;
  std::optional<StrokeTool> tool(const Owner& owner, const Uuid& stroke) const;

 private:
  struct PastBatch {
    Uuid id;
    std::optional<End> start;  // end of the previous batch
    bool is_saved = false;
  };
  struct Stroke {
    StrokeTool tool;
    int first_n = 0;  // number of batches.front()
    std::deque<PastBatch> batches;
    std::optional<End> last;  // end of the newest batch
    bool ended = false;
    Clock::time_point touched;
    // A later batch may be saved before an earlier one that was refused and is sent again.
    int saved_through() const;
  };
  using Strokes = std::unordered_map<Uuid, Stroke>;
  Stroke* find(const Owner& owner, const Uuid& stroke);
  const Stroke* find(const Owner& owner, const Uuid& stroke) const;
  void forget_old(Clock::time_point now);

  mutable std::mutex mutex_;
  std::map<Owner, Strokes> owners_;
};

}  // namespace strata::app
