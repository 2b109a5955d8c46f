#pragma once

#include <boost/asio/thread_pool.hpp>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <tuple>
#include <vector>

#include "core/ids.h"
#include "core/memory_ledger.h"
#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "domain/people/visibility.h"
#include "render/renderer.h"
#include "room/caches/record_features.h"
#include "store/store.h"

namespace strata::room {

// The state of a layer after one of its edits: a copy on the GPU that is never painted. The
// destructor removes the copy.
struct PastLayer {
  PastLayer(render::Renderer& on, TileMirror::Snapshot content)
      : renderer(on), snapshot(std::move(content)) {}
  ~PastLayer();
  PastLayer(const PastLayer&) = delete;
  PastLayer& operator=(const PastLayer&) = delete;

  render::Renderer& renderer;
  const TileMirror::Snapshot snapshot;
  render::LayerHandle handle = 0;
  MemoryLedger::Share memory;  // for the tiles that the newest state does not share
};

// The layers and features of a model after an edit.
struct PastMoment {
  std::int64_t sequence = 0;
  render::ModelHandle model = 0;
  std::map<LayerId, std::shared_ptr<const PastLayer>> layers;
  std::map<TableId, RecordFeatures::SurfaceFeatures> features;
};

// The past states of an open model, for views of an earlier state. A worker reads them from the
// journal. It reads only the tiles that differ from a known state, and shares all others with that
// state. So it reads only the changed tiles when a view moves to another edit. Unused states take
// at most kKeptBytes of memory, which the ledger counts. Thread-safe.
class PastLayers : public std::enable_shared_from_this<PastLayers> {
 public:
  static constexpr std::size_t kKeptLayers = 24;
  static constexpr std::uint64_t kKeptBytes = 128u << 20;

  // Returns the newest state of a layer if the journal contains all edits of this state and the
  // state has the value type of the layer.
  using Newest = std::function<std::optional<TileMirror::Snapshot>(const Layer&)>;
  // `ready` is called, on any thread, when a requested moment is ready or has failed.
  PastLayers(store::Store& store, render::Renderer& renderer, boost::asio::thread_pool& workers,
             MemoryLedger& memory, std::shared_ptr<RecordFeatures> features, ModelId model_id,
             Newest newest, std::function<void()> ready);
  ~PastLayers();

  struct Request {
    std::int64_t at = 0;
    std::vector<Layer> layers;  // the layers that are shown
    // The most restricted visibility of the columns that may be read.
    Visibility sight = Visibility::everyone;
  };
  struct Found {
    std::shared_ptr<const PastMoment> moment;  // null if no moment is ready yet
    std::shared_ptr<const Error> problem;      // reason why the requested moment cannot be shown
  };
  // The requests of one view.
  class Place;
  std::shared_ptr<Place> new_place();
  // Returns the last moment that is ready. It may belong to an earlier request. A worker processes
  // the newest request of each `Place`, and skips the requests before it.
  Found find(const std::shared_ptr<Place>& place, const Request& request);

  // Drops the copies on the GPU, which were deleted together with the old model.
  void set_model(render::ModelHandle model);
  // Allows trying failed requests again, because the database was unreachable. `find` starts them.
  void allow_retries();
  bool drop_unused();  // returns false if nothing was dropped
  void stop();         // stops reading, and no longer calls `ready`

 private:
  // The last element is the sequence of the layer's last edit.
  using Key = std::tuple<LayerId, ValueType, std::int64_t>;
  struct Kept {
    Key key;
    std::shared_ptr<const PastLayer> layer;
  };
  void run(const std::shared_ptr<Place>& place);
  Result<std::shared_ptr<const PastMoment>> make(const Request& request, render::ModelHandle model);
  Result<std::shared_ptr<const PastLayer>> layer_at(const Layer& layer, std::int64_t sequence,
                                                    render::ModelHandle model);
  void keep(Kept kept);  // call while holding the mutex

  store::Store& store_;
  render::Renderer& renderer_;
  boost::asio::thread_pool& workers_;
  MemoryLedger& memory_;
  const std::shared_ptr<RecordFeatures> features_;
  const ModelId model_id_;
  const Newest newest_;
  const std::function<void()> ready_;
  std::mutex mutex_;
  std::list<Kept> kept_;  // in order of last use, the newest first
  render::ModelHandle model_ = 0;
  int retries_ = 0;  // the number of calls of `allow_retries`
  bool stopped_ = false;
};

}  // namespace strata::room
