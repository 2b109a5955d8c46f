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

// What `stroke.begin` fixed for all batches of a stroke.
struct StrokeTool {
  LayerId layer_id = 0;
  StrokeBatch batch;      // without a path
  nlohmann::json record;  // the edit for the journal, without a path
  bool operator==(const StrokeTool& other) const {
    return layer_id == other.layer_id && record == other.record;
  }
};

// Remembers the strokes of people across connections: each `stroke.extend` is an edit of its own
// whose path starts where the batch before ended, also when a batch is sent again after a
// reconnect. Forgets strokes that nobody touched for ten minutes, and the oldest when a person has
// very many. Thread-safe.
class StrokeTracker {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMaxStrokes = 256;   // of one person in one model
  static constexpr std::size_t kMaxBatches = 8192;  // remembered of one stroke
  static constexpr std::size_t kMaxPath = 4096;     // points of an edit, the joining one included
  static constexpr std::chrono::minutes kKeepFor{10};

  struct Owner {
    ModelId model_id = 0;
    std::string user;
    auto operator<=>(const Owner&) const = default;
  };

  // The same `begin` again is harmless and takes the stroke up anew; a different one for a known
  // stroke is refused (409).
  Result<void> begin(const Owner& owner, const Uuid& stroke, StrokeTool tool,
                     Clock::time_point now = Clock::now());

  // True when the batch follows one that this book has not seen (the server was restarted in
  // between): tell the point where batch n-1 ended by `continue_from`, if it can be found, before
  // `extend`.
  bool lacks_start(const Owner& owner, const Uuid& stroke, int n) const;
  struct End {  // of a batch
    glm::dvec2 point{0};
    double width = 1;
    bool operator==(const End&) const = default;
  };
  void continue_from(const Owner& owner, const Uuid& stroke, int n, const End& end);

  struct Batch {
    StrokeTool tool;
    std::vector<glm::dvec2> path;  // joined to the batch before
    std::vector<double> widths{};  // of its points; none: all are 1
  };
  // Refused: an unknown stroke (404), a batch out of order, a number already taken by another id,
  // an ended stroke (409), a path that is too long with the joining point, widths that do not fit
  // it (422). A repeated id gives the same batch again and advances nothing.
  Result<Batch> extend(const Owner& owner, const Uuid& stroke, const Uuid& id, int n,
                       const std::vector<glm::dvec2>& path, const std::vector<double>& widths = {},
                       Clock::time_point now = Clock::now());
  void saved(const Owner& owner, const Uuid& stroke, int n);
  Result<void> end(const Owner& owner, const Uuid& stroke);

  struct Progress {
    Uuid stroke;
    int n = -1;  // every batch up to this one is saved; -1: none
  };
  std::vector<Progress> open_strokes(const Owner& owner) const;
  std::optional<StrokeTool> tool(const Owner& owner, const Uuid& stroke) const;

 private:
  struct PastBatch {
    Uuid id;
    std::optional<End> start;  // where the batch before ended
    bool is_saved = false;
  };
  struct Stroke {
    StrokeTool tool;
    int first_n = 0;  // number of batches.front()
    std::deque<PastBatch> batches;
    std::optional<End> last;  // where the newest batch ended
    bool ended = false;
    Clock::time_point touched;
    // a later batch can be saved while an earlier one was refused and waits to be sent again
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
