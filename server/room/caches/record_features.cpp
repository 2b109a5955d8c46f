#include "room/caches/record_features.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cmath>

#include "core/log.h"
#include "query/sampling/feature_parts.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::room {

struct RecordFeatures::Shown {
  std::vector<LayerFeatures> layers;
  std::weak_ptr<const std::vector<render::DrawnFeature>> features;
};

RecordFeatures::~RecordFeatures() = default;

RecordFeatures::RecordFeatures(store::Store& store, boost::asio::thread_pool& workers,
                               ModelId model_id, std::shared_ptr<SurfaceLookup> surface,
                               std::function<void()> ready)
    : store_(store),
      workers_(workers),
      model_id_(model_id),
      surface_(std::move(surface)),
      ready_(std::move(ready)) {}

Result<RecordFeatures::SurfaceFeatures> RecordFeatures::read(const Key& key,
                                                             std::optional<std::int64_t> at) const {
  auto features =
      STRATA_TRY(store_.records().features(key.first, least_role(key.second), model_id_, at));
  if (const mesh::Geometry& geometry = surface_->geometry();
      !geometry.part_ends.empty() && !features.empty())
    query::find_parts(features, geometry, *surface_->tree());
  return features.empty() ? nullptr
                          : std::make_shared<const std::vector<KeyFeature>>(std::move(features));
}

Result<RecordFeatures::SurfaceFeatures> RecordFeatures::when(TableId table_id, Visibility sight,
                                                             std::int64_t sequence) const {
  const auto at = STRATA_TRY(store_.tables().sequence_when(table_id, model_id_, sequence));
  return read({table_id, sight}, at);
}

RecordFeatures::SurfaceFeatures RecordFeatures::find(TableId table_id, Visibility sight) {
  const Key key{table_id, sight};
  std::lock_guard lock(mutex_);
  Entry& entry = entries_[key];
  start(key, entry);
  return entry.features;
}

Result<RecordFeatures::SurfaceFeatures> RecordFeatures::newest(TableId table_id, Visibility sight) {
  const Key key{table_id, sight};
  {
    std::lock_guard lock(mutex_);
    Entry& entry = entries_[key];
    if (entry.known && !entry.outdated && !entry.reading) return entry.features;
    if (!entry.known) entry.outdated = false;  // a later change to records sets it again
  }
  auto features = read(key);
  std::lock_guard lock(mutex_);
  Entry& entry = entries_[key];
  if (!features) {
    entry.outdated = true;
    return entry.known ? Result<SurfaceFeatures>(entry.features) : features;
  }
  // If a worker has read the features in the meantime, its result is at least as new as this one.
  if (!entry.known) {
    entry.features = *features;
    entry.known = true;
  }
  return features;
}

void RecordFeatures::start(const Key& key, Entry& entry) {
  if (stopped_ || entry.reading || !entry.outdated) return;
  entry.reading = true;
  entry.outdated = false;
  boost::asio::post(workers_, [self = shared_from_this(), key] { self->run(key); });
}

void RecordFeatures::run(const Key& key) {
  auto features = read(key);
  if (!features)
    log::warning("lines and points of table " + to_string(key.first) + ": " +
                 features.error().detail);
  bool differ = false;
  {
    std::lock_guard lock(mutex_);
    if (stopped_) return;
    Entry& entry = entries_[key];
    entry.reading = false;
    // If the features cannot be read, they stay unchanged until records change again.
    entry.known |= features.has_value();
    if (features && !(!entry.features && !*features) &&
        !(entry.features && *features && *entry.features == **features)) {
      entry.features = std::move(*features);
      differ = true;
    }
    start(key, entry);
  }
  if (differ && ready_) ready_();
}

void RecordFeatures::records_changed(TableId table_id) {
  std::lock_guard lock(mutex_);
  for (auto& [key, entry] : entries_) {
    if (key.first != table_id) continue;
    entry.outdated = true;
    start(key, entry);
  }
}

void RecordFeatures::read_again() {
  std::lock_guard lock(mutex_);
  for (auto& [key, entry] : entries_) {
    entry.outdated = true;
    start(key, entry);
  }
}

void RecordFeatures::stop() {
  std::lock_guard lock(mutex_);
  stopped_ = true;
}

render::FeaturesShown RecordFeatures::shown(const std::vector<LayerFeatures>& layers) {
  std::lock_guard lock(mutex_);
  std::erase_if(shown_, [](const Shown& one) { return one.features.expired(); });
  for (const Shown& one : shown_)
    if (one.layers == layers)
      if (auto features = one.features.lock()) return features;
  auto features = show_features(layers);
  if (features) shown_.push_back({layers, features});
  return features;
}

render::FeaturesShown show_features(const std::vector<LayerFeatures>& layers) {
  auto shown = std::make_shared<std::vector<render::DrawnFeature>>();
  for (const LayerFeatures& layer : layers) {
    if (!layer.features) continue;
    for (const KeyFeature& each : *layer.features) {
      Rgba color = color_of(*layer.palette, static_cast<double>(each.key));
      color[3] =
          static_cast<std::uint8_t>(std::lround(color[3] * std::clamp(layer.opacity, 0.0f, 1.0f)));
      if (color[3] > 0) shown->push_back({each.feature.places, color, each.part});
    }
  }
  if (shown->empty()) return nullptr;
  return shown;
}

}  // namespace strata::room
