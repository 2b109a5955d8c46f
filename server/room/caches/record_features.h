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

// The lines and points that records have on an open model, by table and by the least seen of the
// columns that are looked at (`sight`). They are read on a worker when a view first needs them, and
// anew when records change. Thread-safe.
class RecordFeatures : public std::enable_shared_from_this<RecordFeatures> {
 public:
  using SurfaceFeatures =
      std::shared_ptr<const std::vector<KeyFeature>>;  // by key; told apart by the object

  // `ready` is called, on any thread, whenever marks that were asked for are there and differ from
  // before.
  RecordFeatures(store::Store& store, boost::asio::thread_pool& workers, ModelId model_id,
                 std::function<void()> ready);
  ~RecordFeatures();

  // The newest that are there; null: none are, as far as is known.
  SurfaceFeatures find(TableId table_id, Visibility sight);
  // Those of now, read on the calling thread where they are not known. While the database is away,
  // the last that were. Blocks.
  Result<SurfaceFeatures> newest(TableId table_id, Visibility sight);
  // Those of when an edit of the model was made. Blocks.
  Result<SurfaceFeatures> when(TableId table_id, Visibility sight, std::int64_t sequence) const;
  void records_changed(TableId table_id);
  // `show_features`, as one object for all who show the same now: views are told by it whether they
  // have the same picture.
  render::FeaturesShown shown(const std::vector<LayerFeatures>& layers);
  void stop();  // nothing more is read, and `ready` not called

 private:
  struct Entry {
    SurfaceFeatures features;
    bool known = false;  // they were read once
    bool reading = false;
    bool outdated = true;
  };
  using Wanted = std::pair<TableId, Visibility>;
  void start(const Wanted& wanted, Entry& entry);  // with the mutex held
  void run(const Wanted& wanted);
  // `at` of the table
  Result<SurfaceFeatures> read(const Wanted& wanted, std::optional<std::int64_t> at = {}) const;

  store::Store& store_;
  boost::asio::thread_pool& workers_;
  const ModelId model_id_;
  const std::function<void()> ready_;
  std::mutex mutex_;
  std::map<Wanted, Entry> entries_;
  struct Shown;
  std::vector<Shown> shown_;
  bool stopped_ = false;
};

// SurfaceFeatures of one layer's records, as the layer is drawn: in the colours of their keys, with
// its opacity.
struct LayerFeatures {
  RecordFeatures::SurfaceFeatures features;
  std::shared_ptr<const Palette> palette;  // by key
  float opacity = 1;
  bool operator==(const LayerFeatures&) const = default;
};
// What is to be drawn of them; null: nothing.
render::FeaturesShown show_features(const std::vector<LayerFeatures>& layers);

}  // namespace strata::room
