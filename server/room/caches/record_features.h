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
#include "room/caches/surface_lookup.h"
#include "store/store.h"

namespace strata::room {

struct LayerFeatures;

// The lines and points of records on an open model, by table and by the most restricted visibility
// of the columns that are read (`sight`). A worker reads them when a view first needs them, and
// again when records change. Thread-safe.
class RecordFeatures : public std::enable_shared_from_this<RecordFeatures> {
 public:
  using SurfaceFeatures =
      std::shared_ptr<const std::vector<KeyFeature>>;  // by key; compared by address

  // Calls `ready`, on any thread, after it has read features that differ from the previous ones.
  RecordFeatures(store::Store& store, boost::asio::thread_pool& workers, ModelId model_id,
                 std::shared_ptr<SurfaceLookup> surface, std::function<void()> ready);
  ~RecordFeatures();

  // Returns the newest features that were read, or null before the first reading.
  SurfaceFeatures find(TableId table_id, Visibility sight);
  // Returns the present features. Reads them on the calling thread if they are not in memory. If
  // the database is unreachable, returns the last known features. Blocks.
  Result<SurfaceFeatures> newest(TableId table_id, Visibility sight);
  // Returns the features after an edit of the model. Blocks.
  Result<SurfaceFeatures> when(TableId table_id, Visibility sight, std::int64_t sequence) const;
  void records_changed(TableId table_id);
  void read_again();  // reads all features again, because the database was unreachable
  // Returns the result of `show_features`. Views that show the same features get the same object,
  // so a changed address means changed features.
  render::FeaturesShown shown(const std::vector<LayerFeatures>& layers);
  void stop();  // stops reading, and no longer calls `ready`

 private:
  struct Entry {
    SurfaceFeatures features;
    bool known = false;  // the features were read at least once
    bool reading = false;
    bool outdated = true;
  };
  using Key = std::pair<TableId, Visibility>;
  void start(const Key& key, Entry& entry);  // call while holding the mutex
  void run(const Key& key);
  // Reads the features. `at` is a sequence of the table.
  Result<SurfaceFeatures> read(const Key& key, std::optional<std::int64_t> at = {}) const;

  store::Store& store_;
  boost::asio::thread_pool& workers_;
  const ModelId model_id_;
  const std::shared_ptr<SurfaceLookup> surface_;
  const std::function<void()> ready_;
  std::mutex mutex_;
  std::map<Key, Entry> entries_;
  struct Shown;
  std::vector<Shown> shown_;
  bool stopped_ = false;
};

// The features of the records of one layer. They are drawn like the layer: in the colors of their
// keys, and with its opacity.
struct LayerFeatures {
  RecordFeatures::SurfaceFeatures features;
  std::shared_ptr<const Palette> palette;  // by key
  float opacity = 1;
  bool operator==(const LayerFeatures&) const = default;
};
// Returns the features to draw, or null if there is nothing to draw.
render::FeaturesShown show_features(const std::vector<LayerFeatures>& layers);

}  // namespace strata::room
