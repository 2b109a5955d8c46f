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
#include "core/uuid.h"
#include "domain/scene/stroke.h"

namespace strata::app {

// The settings in `stroke.begin`, which apply to all batches of a stroke.
struct StrokeTool {
  LayerId layer_id = 0;
  StrokeBatch batch;      // without a path
  nlohmann::json record;  // the journal record, without a path
  bool operator==(const StrokeTool& other) const {
    return layer_id == other.layer_id && record == other.record;
  }
};

// Tracks the strokes of people across connections: each `stroke.extend` is a separate edit whose
// path starts at the end of the previous batch, also if a client sends a batch again after a
// reconnect. Forgets strokes without a call for ten minutes, and the oldest if a person has very
// many. Thread-safe.
class StrokeTracker {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMaxStrokes = 256;   // per person and model
  static constexpr std::size_t kMaxBatches = 8192;  // remembered per stroke
  static constexpr std::size_t kMaxPath = 4096;     // points of an edit, with the joining point
  static constexpr std::chrono::minutes kKeepFor{10};

  struct Owner {
    ModelId model_id = 0;
    std::string user;
    auto operator<=>(const Owner&) const = default;
  };

  // Repeating the same `begin` resumes the stroke; a different one for a known stroke is refused
  // (409).
  Result<void> begin(const Owner& owner, const Uuid& stroke, StrokeTool tool,
                     Clock::time_point now = Clock::now());

  // True if the tracker does not have the previous batch (the server was restarted): then pass the
  // end of batch n-1 to `continue_from`, if it can be found, before `extend`.
  bool lacks_start(const Owner& owner, const Uuid& stroke, int n) const;
  struct End {  // of a batch
    glm::dvec2 point{0};
    double width = 1;
    bool operator==(const End&) const = default;
  };
  void continue_from(const Owner& owner, const Uuid& stroke, int n, const End& end);

  struct Batch {
    StrokeTool tool;
    std::vector<glm::dvec2> path;  // starts at the end of the previous batch
    std::vector<double> widths{};  // of its points; empty: all are 1
  };
  // Refuses an unknown stroke (404), a batch out of order, a number of another id, an ended stroke
  // (409), a path that is too long with the joining point, and widths of another number (422). A
  // repeated id returns the same batch and changes nothing.
  Result<Batch> extend(const Owner& owner, const Uuid& stroke, const Uuid& id, int n,
                       const std::vector<glm::dvec2>& path, const std::vector<double>& widths = {},
                       Clock::time_point now = Clock::now());
  void saved(const Owner& owner, const Uuid& stroke, int n);
  Result<void> end(const Owner& owner, const Uuid& stroke);

  struct Progress {
    Uuid stroke;
    int n = -1;  // all batches up to this one are saved; -1: none
  };
  std::vector<Progress> open_strokes(const Owner& owner) const;
  std::optional<StrokeTool> tool(const Owner& owner, const Uuid& stroke) const;

 private:
  struct PastBatch {
    Uuid id;
    std::optional<End> start;  // the end of the previous batch
    bool is_saved = false;
  };
  struct Stroke {
    StrokeTool tool;
    int first_n = 0;  // number of batches.front()
    std::deque<PastBatch> batches;
    std::optional<End> last;  // the end of the newest batch
    bool ended = false;
    Clock::time_point touched;
    // a later batch may be saved before an earlier one that was refused and is sent again
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
