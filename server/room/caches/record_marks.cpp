#include "room/caches/record_marks.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cmath>

#include "core/log.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::room {

struct RecordMarks::Shown {
  std::vector<LayerMarks> layers;
  std::weak_ptr<const std::vector<render::DrawnMark>> marks;
};

RecordMarks::~RecordMarks() = default;

RecordMarks::RecordMarks(store::Store& store, boost::asio::thread_pool& workers,
                         std::int64_t model_id, std::function<void()> ready)
    : store_(store), workers_(workers), model_id_(model_id), ready_(std::move(ready)) {}

Result<RecordMarks::Marks> RecordMarks::read(const Wanted& wanted,
                                             std::optional<std::int64_t> at) const {
  auto marks =
      STRATA_TRY(store_.records().marks(wanted.first, least_role(wanted.second), model_id_, at));
  return marks.empty() ? nullptr : std::make_shared<const std::vector<KeyMark>>(std::move(marks));
}

Result<RecordMarks::Marks> RecordMarks::when(std::int64_t table_id, Visibility sight,
                                             std::int64_t sequence) const {
  const auto at = STRATA_TRY(store_.tables().sequence_when(table_id, model_id_, sequence));
  return read({table_id, sight}, at);
}

RecordMarks::Marks RecordMarks::find(std::int64_t table_id, Visibility sight) {
  const Wanted wanted{table_id, sight};
  std::lock_guard lock(mutex_);
  Entry& entry = entries_[wanted];
  start(wanted, entry);
  return entry.marks;
}

Result<RecordMarks::Marks> RecordMarks::newest(std::int64_t table_id, Visibility sight) {
  const Wanted wanted{table_id, sight};
  {
    std::lock_guard lock(mutex_);
    Entry& entry = entries_[wanted];
    if (entry.known && !entry.outdated && !entry.reading) return entry.marks;
    if (!entry.known) entry.outdated = false;  // records that change from now on make it so again
  }
  auto marks = read(wanted);
  std::lock_guard lock(mutex_);
  Entry& entry = entries_[wanted];
  if (!marks) {
    entry.outdated = true;
    return entry.known ? Result<Marks>(entry.marks) : marks;
  }
  // A worker that was faster has read them at least as late.
  if (!entry.known) {
    entry.marks = *marks;
    entry.known = true;
  }
  return marks;
}

void RecordMarks::start(const Wanted& wanted, Entry& entry) {
  if (stopped_ || entry.reading || !entry.outdated) return;
  entry.reading = true;
  entry.outdated = false;
  boost::asio::post(workers_, [self = shared_from_this(), wanted] { self->run(wanted); });
}

void RecordMarks::run(const Wanted& wanted) {
  auto marks = read(wanted);
  if (!marks)
    log::warning("lines and points of table " + std::to_string(wanted.first) + ": " +
                 marks.error().detail);
  bool differ = false;
  {
    std::lock_guard lock(mutex_);
    if (stopped_) return;
    Entry& entry = entries_[wanted];
    entry.reading = false;
    // What cannot be read stays as it was, until records change again.
    entry.known |= marks.has_value();
    if (marks && !(!entry.marks && !*marks) &&
        !(entry.marks && *marks && *entry.marks == **marks)) {
      entry.marks = std::move(*marks);
      differ = true;
    }
    start(wanted, entry);
  }
  if (differ && ready_) ready_();
}

void RecordMarks::records_changed(std::int64_t table_id) {
  std::lock_guard lock(mutex_);
  for (auto& [wanted, entry] : entries_) {
    if (wanted.first != table_id) continue;
    entry.outdated = true;
    start(wanted, entry);
  }
}

void RecordMarks::stop() {
  std::lock_guard lock(mutex_);
  stopped_ = true;
}

render::MarksShown RecordMarks::shown(const std::vector<LayerMarks>& layers) {
  std::lock_guard lock(mutex_);
  std::erase_if(shown_, [](const Shown& one) { return one.marks.expired(); });
  for (const Shown& one : shown_)
    if (one.layers == layers)
      if (auto marks = one.marks.lock()) return marks;
  auto marks = show_marks(layers);
  if (marks) shown_.push_back({layers, marks});
  return marks;
}

render::MarksShown show_marks(const std::vector<LayerMarks>& layers) {
  auto shown = std::make_shared<std::vector<render::DrawnMark>>();
  for (const LayerMarks& layer : layers) {
    if (!layer.marks) continue;
    for (const KeyMark& each : *layer.marks) {
      Rgba color = color_of(*layer.palette, static_cast<double>(each.key));
      color[3] =
          static_cast<std::uint8_t>(std::lround(color[3] * std::clamp(layer.opacity, 0.0f, 1.0f)));
      if (color[3] > 0) shown->push_back({each.mark.places, color});
    }
  }
  if (shown->empty()) return nullptr;
  return shown;
}

}  // namespace strata::room
