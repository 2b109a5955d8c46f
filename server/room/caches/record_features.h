#pragma once

#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "core/ids.h"
#include "domain/layers/palette.h"
#include "domain/people/visibility.h"
#include "domain/tables/surface_feature.h"
#include "render/renderer.h"
#include "store/store.h"

namespace strata::room {

struct LayerFeatures;

// The lines and points that records have on an open model, by table and by the most restricted
// visibility of the columns that are read (`sight`). A worker reads them when a view first needs
// them, and again when records change. Thread-safe.
class RecordFeatures : public std::enable_shared_from_this<RecordFeatures> {
 public:
  using SurfaceFeatures =
      std::shared_ptr<const std::vector<KeyFeature>>;  // by key; compared by address

  // `ready` is called, on any thread, whenever requested features were read and differ from before.
  RecordFeatures(store::Store& store, boost::asio::thread_pool& workers, ModelId model_id,
                 std::function<void()> ready);
  ~RecordFeatures();

  // Returns the newest features that were read; null: none known.
  SurfaceFeatures find(TableId table_id, Visibility sight);
  // Returns the present features, and reads them on the calling thread if they are not known. If
  // the database is unreachable, returns the last known ones. Blocks.
  Result<SurfaceFeatures> newest(TableId table_id, Visibility sight);
  // Returns the features at the time of an edit of the model. Blocks.
  Result<SurfaceFeatures> when(TableId table_id, Visibility sight, std::int64_t sequence) const;
  void records_changed(TableId table_id);
  // Returns the result of `show_features` as one object for all views that show the same features,
  // so that views can compare pictures by it.
  render::FeaturesShown shown(const std::vector<LayerFeatures>& layers);
  void stop();  // reads nothing more, and does not call `ready`

 private:
  struct Entry {
    SurfaceFeatures features;
    bool known = false;  // they were read once
    bool reading = false;
    bool outdated = true;
  };
  using Key = std::pair<TableId, Visibility>;
  void start(const Key& key, Entry& entry);  // with the mutex held
  void run(const Key& key);
  // `at` of the table
  Result<SurfaceFeatures> read(const Key& key, std::optional<std::int64_t> at = {}) const;

  store::Store& store_;
  boost::asio::thread_pool& workers_;
  const ModelId model_id_;
  const std::function<void()> ready_;
  std::mutex mutex_;
  std::map<Key, Entry> entries_;
  struct Shown;
  std::vector<Shown> shown_;
  bool stopped_ = false;
};

// SurfaceFeatures of one layer's records, drawn like the layer: in the colors of their keys, with
// its opacity.
struct LayerFeatures {
  RecordFeatures::SurfaceFeatures features;
  std::shared_ptr<const Palette> palette;  // by key
  float opacity = 1;
  bool operator==(const LayerFeatures&) const = default;
};
// Returns the features to draw; null: nothing to draw.
render::FeaturesShown show_features(const std::vector<LayerFeatures>& layers);

}  // namespace strata::room
