#include "app/strokes/stroke_tracker.h"

#include <algorithm>

namespace strata::app {

const StrokeTracker::Stroke* StrokeTracker::find(const Owner& owner, const Uuid& stroke) const {
  auto strokes = owners_.find(owner);
  if (strokes == owners_.end()) return nullptr;
  auto found = strokes->second.find(stroke);
  return found == strokes->second.end() ? nullptr : &found->second;
}

StrokeTracker::Stroke* StrokeTracker::find(const Owner& owner, const Uuid& stroke) {
  return const_cast<Stroke*>(std::as_const(*this).find(owner, stroke));
}

int StrokeTracker::Stroke::saved_through() const {
  const auto gap = std::find_if_not(batches.begin(), batches.end(),
                                    [](const PastBatch& batch) { return batch.is_saved; });
  return first_n - 1 + static_cast<int>(gap - batches.begin());
}

void StrokeTracker::forget_old(Clock::time_point now) {
  for (auto strokes = owners_.begin(); strokes != owners_.end();) {
    std::erase_if(strokes->second,
                  [&](const auto& item) { return now - item.second.touched > kKeepFor; });
    strokes = strokes->second.empty() ? owners_.erase(strokes) : std::next(strokes);
  }
}

Result<void> StrokeTracker::begin(const Owner& owner, const Uuid& stroke, StrokeTool tool,
                                  Clock::time_point now) {
  std::lock_guard lock(mutex_);
  forget_old(now);
  if (Stroke* known = find(owner, stroke)) {
    if (!(known->tool == tool))
      return fail(ErrorCode::conflict, "Stroke id already used",
                  "This connection began a stroke with this id, but with another layer, value, "
                  "camera or brush. Use a new id.",
                  "stroke");
    known->ended = false;
    known->touched = now;
    return {};
  }
  Strokes& strokes = owners_[owner];
  if (strokes.size() >= kMaxStrokes)
    strokes.erase(std::min_element(
        strokes.begin(), strokes.end(),
        [](const auto& a, const auto& b) { return a.second.touched < b.second.touched; }));
  Stroke& made = strokes[stroke];
  made.tool = std::move(tool);
  made.touched = now;
  return {};
}

bool StrokeTracker::lacks_start(const Owner& owner, const Uuid& stroke, int n) const {
  std::lock_guard lock(mutex_);
  const Stroke* known = find(owner, stroke);
  return known && known->batches.empty() && !known->last && n > 0;
}

void StrokeTracker::continue_from(const Owner& owner, const Uuid& stroke, int n, const End& end) {
  std::lock_guard lock(mutex_);
  Stroke* known = find(owner, stroke);
  if (!known || !known->batches.empty()) return;
  known->first_n = n;
  known->last = end;
}

Result<StrokeTracker::Batch> StrokeTracker::extend(const Owner& owner, const Uuid& stroke,
                                                   const Uuid& id, int n,
                                                   const std::vector<glm::dvec2>& path,
                                                   const std::vector<double>& widths,
                                                   Clock::time_point now) {
  std::lock_guard lock(mutex_);
  Stroke* known = find(owner, stroke);
  if (!known)
    return fail(ErrorCode::not_found, "Unknown stroke",
                "The server has no stroke with this id. Send stroke.begin first.", "stroke");
  // The first batch after a restart may have any number because the earlier ones are in the
  // journal.
  if (known->batches.empty() && !known->last) known->first_n = n;
  const int next = known->first_n + static_cast<int>(known->batches.size());
  if (n > next)
    return fail(ErrorCode::conflict, "Batch out of order",
                "The next batch of this stroke must have the number " + std::to_string(next) + ".",
                "n");
  if (n < known->first_n)
    return fail(ErrorCode::conflict, "Batch too old",
                "Batches before number " + std::to_string(known->first_n) +
                    " of this stroke can no longer be repeated.",
                "n");
  const bool is_new = n == next;
  if (is_new && known->ended)
    return fail(ErrorCode::conflict, "Stroke ended", "This stroke has ended. Begin a new one.",
                "stroke");
  if (!is_new && known->batches[static_cast<std::size_t>(n - known->first_n)].id != id)
    return fail(ErrorCode::conflict, "Batch number already used",
                "Another batch of this stroke has this number. Use the next number.", "n");

  const std::optional<End> start =
      is_new ? known->last : known->batches[static_cast<std::size_t>(n - known->first_n)].start;
  if (path.empty() || path.size() + (start ? 1 : 0) > kMaxPath)
    return fail(ErrorCode::invalid, "Path too long",
                "A batch can have 1 to " + std::to_string(kMaxPath - 1) +
                    " points. Send a longer path in several batches.",
                "path");
  if (!widths.empty() && widths.size() != path.size())
    return fail(ErrorCode::invalid, "Wrong number of widths",
                "Send one width for each point of the path, or no widths.", "widths");
  known->touched = now;
  if (is_new) {
    known->batches.push_back({id, start});
    known->last = End{path.back(), widths.empty() ? 1 : widths.back()};
    if (known->batches.size() > kMaxBatches) {
      known->batches.pop_front();
      ++known->first_n;
    }
  }
  Batch batch{known->tool, {}, widths};
  batch.path.reserve(path.size() + 1);
  if (start) batch.path.push_back(start->point);
  batch.path.insert(batch.path.end(), path.begin(), path.end());
  if (start && (start->width != 1 || !widths.empty())) {
    if (widths.empty()) batch.widths.assign(path.size(), 1);
    batch.widths.insert(batch.widths.begin(), start->width);
  }
  return batch;
}

void StrokeTracker::saved(const Owner& owner, const Uuid& stroke, int n) {
  std::lock_guard lock(mutex_);
  Stroke* known = find(owner, stroke);
  if (!known || n < known->first_n || n >= known->first_n + static_cast<int>(known->batches.size()))
    return;
  known->batches[static_cast<std::size_t>(n - known->first_n)].is_saved = true;
}

Result<void> StrokeTracker::end(const Owner& owner, const Uuid& stroke) {
  std::lock_guard lock(mutex_);
  Stroke* known = find(owner, stroke);
  if (!known)
    return fail(ErrorCode::not_found, "Unknown stroke",
                "The server has no stroke with this id, so it cannot end the stroke.", "stroke");
  known->ended = true;
  return {};
}

std::vector<StrokeTracker::Progress> StrokeTracker::open_strokes(const Owner& owner) const {
  std::lock_guard lock(mutex_);
  std::vector<Progress> open;
  auto strokes = owners_.find(owner);
  if (strokes == owners_.end()) return open;
  for (const auto& [id, stroke] : strokes->second)
    if (!stroke.ended) open.push_back({id, stroke.saved_through()});
  return open;
}

std::optional<StrokeTool> StrokeTracker::tool(const Owner& owner, const Uuid& stroke) const {
  std::lock_guard lock(mutex_);
  const Stroke* known = find(owner, stroke);
  if (!known) return std::nullopt;
  return known->tool;
}

}  // namespace strata::app
