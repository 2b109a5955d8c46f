#pragma once

#include <atomic>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "domain/scene/model.h"
#include "room/at.h"
#include "room/caches/appearance_cache.h"
#include "room/caches/past_layers.h"
#include "room/caches/record_colors.h"
#include "room/caches/record_features.h"
#include "room/caches/surface_image_cache.h"
#include "room/caches/surface_lookup.h"
#include "room/caches/surface_maps.h"
#include "room/edit_timings.h"
#include "room/open/contents.h"
#include "room/pipeline/edit_pipeline.h"
#include "room/pipeline/layer_state.h"
#include "room/pipeline/retired_keys.h"
#include "room/pipeline/strand.h"
#include "room/room.h"
#include "room/rooms.h"
#include "stream/viewer.h"

namespace strata::room {

class OpenRoom;

// The objects that all rooms share.
struct RoomServices {
  store::Store& store;
  store::JournalWriter& writer;
  render::Renderer& renderer;
  stream::StreamContext stream;
  boost::asio::thread_pool& strands;  // run the strands of rooms: short work that does not wait
  boost::asio::thread_pool& workers;  // run long work: baking, history, loading
  MemoryLedger& memory;               // budget for the data of the rooms, without data on the GPU
  // Read from the journal before each edit. They wait only for the database.
  boost::asio::thread_pool& readers;
  const RetiredKeys& retired_keys;
  RoomOptions options;
  // Called on a worker after a room has found out that another server has its model.
  std::function<void(const std::shared_ptr<OpenRoom>&, const Error& why)> on_deposed;
  EditTimings& timings;
};

// The implementation of a room: its state, its lifetime, and its recovery. The parts of the room
// provide its services. Each part has its own files in this folder.
class OpenRoom final : public Room,
                       public PipelineHost,
                       public std::enable_shared_from_this<OpenRoom> {
 public:
  // Claims the model (store/nodes/nodes.h) and loads all data. Blocks. Returns `moved` if another
  // node has the model.
  static Result<std::shared_ptr<OpenRoom>> open(const RoomServices& services,
                                                const std::string& model_ref);
  // Loads a model that another node has, to show it only. The room follows the journal
  // (room/open/following.h). Blocks.
  static Result<std::shared_ptr<OpenRoom>> follow(const RoomServices& services,
                                                  const std::string& model_ref);
  OpenRoom(const RoomServices& services, Model model, std::int64_t epoch,
           render::ModelGeometry geometry);
  ~OpenRoom() override;

  Model model() const override;
  Result<Model> update_model(Model model, const store::IdempotentResponse<Model>& answer) override;
  Result<void> settle();  // returns when every earlier edit is durable; blocks

  // --- PipelineHost (on the strand)
  LayerState* find_layer(LayerId id) override;
  std::vector<query::LayerView> layer_snapshots() override;
  render::ModelHandle model_handle() const override;  // also for participants
  const Model& pipeline_model() const override { return model_; }
  void styles_changed() override;
  void set_sequence(LayerState& layer, std::int64_t sequence) override;
  void content_changed(const LayerState& layer, const std::optional<render::FrameRequest::Box>& box,
                       std::int64_t sequence) override;
  void edit_applied(const Listener::Edit& edit) override;
  void edit_saved(const Listener::Edit& edit) override;
  void edits_unsaved(const std::vector<Listener::Edit>& edits, const Error& why) override;
  void journal_differs() override;
  void deposed(const Error& reason) override;
  void paused() override;
  void saving_continued() override;

  // --- for participants
  class ParticipantsPart;
  ParticipantsPart& people() { return *participants_part_; }
  stream::StreamContext stream_context() const { return services_.stream; }
  SurfaceImageCache& surface_image_cache() const { return *surface_image_cache_; }
  RecordColors& record_colors() const { return *record_colors_; }
  RecordFeatures& record_features() const { return *record_features_; }
  PastLayers& past_layers() const { return *past_layers_; }
  std::vector<LayerState> layer_states() const;  // in drawing order
  // the contact shadow of the model in `light`; null: no shadow
  std::shared_ptr<const mesh::ContactShadow> contact_shadow(const Light& light) const;
  std::optional<LayerState> layer_state(LayerId id) const;

  // --- for Rooms
  void gpu_lost();
  // Returns whether the room has been empty for `close_after`.
  bool is_idle(std::chrono::steady_clock::time_point now) const;
  void touch();
  std::size_t participant_count() const;  // number of connections
  std::size_t take_leave_count();         // number of connections that left since the last call
  const SurfaceMaps& maps() const { return *maps_; }
  // Drops past states that no view shows, or else the texel graphs. If there is neither, drops the
  // least recently used map, but only while nothing is being painted. Blocks.
  bool drop_map();
  // Drops maps of very fine layers that were unused for a while.
  bool drop_large_unused_maps(std::chrono::steady_clock::time_point now);
  void take_no_edits() { takes_edits_ = false; }          // refuses new edits
  bool has_no_edits() const { return unanswered_ == 0; }  // every edit is durable or refused
  // Refuses waiting and later edits, and releases the GPU objects. Blocks.
  void close(const Error& why);
  void close_deleted();  // call after the model was deleted; notifies listeners first
  // Refuses edits with `moved`, and notifies listeners that the model has moved, which is their
  // last event. Does not wait for the database. Call `close` later.
  void move_away(const Error& why);
  // Refuses edits with `why` and notifies listeners, until `continue_saving`. Views are still
  // drawn. Does not wait for the database.
  void stop_saving(const Error& why);
  // Compares the room with the journal. If another server has claimed the model, notifies listeners
  // that it has moved. Otherwise accepts edits and notifies listeners.
  void continue_saving();
  // Returns whether the room is known to have all edits of the model. False from `stop_saving`
  // until the comparison has succeeded.
  bool is_current() const { return is_current_; }
  // Gives up the claim, so that another node can open the model. Blocks. Does nothing if the server
  // runs alone, because its claims have no owner.
  void release();
  ModelId id() const { return model_id_; }
  std::int64_t epoch() const { return epoch_; }  // epoch of the claim (store/nodes/nodes.h)
  class FollowingPart;
  FollowingPart* following() { return following_part_.get(); }  // null: the room has a claim

 private:
  class LayersPart;
  class EditsPart;
  class QueriesPart;
  class SurfacePart;
  class PicturesPart;
  class SurfaceImagesPart;

  // `epoch` is that of the claim. Nothing: the room follows another node.
  static Result<std::shared_ptr<OpenRoom>> load(const RoomServices& services, Model model,
                                                std::optional<std::int64_t> epoch);
  // Runs `work` on a worker when every earlier edit is durable. No edit and no recovery starts
  // while it runs. Blocks. Returns `moved` if another node has claimed the model, also if this room
  // follows it.
  template <class T>
  Result<T> exclusively(std::function<Result<T>()> work);
  Result<void> check_not_deposed();
  // Returns `moved` if the room follows another node. Such a room writes nothing.
  Result<void> check_claimed() const;
  void tell_moved(const Error& why);    // on the strand
  void show_model(const Model& model);  // replaces the properties, and notifies listeners; blocks
  // Marks the layers as stale that are computed from this layer. Runs on the strand.
  void outdate_readers(LayerId layer_id, std::int64_t sequence);
  // Defined in recovery.cpp.
  void recover();
  void on_gpu_filled(int losses_before, const Result<GpuContents>& contents);
  void on_journal_read(Result<JournalContents> contents);
  void on_metadata_read(int changes_before, const Result<ModelMetadata>& metadata,
                        std::shared_ptr<const mesh::ContactShadow> shadow);
  // Ends the suspension when the room has everything that the database has.
  void report_current();
  // Replaces the model by the stored one, and notifies listeners. Runs on the strand. `shadow` is
  // used if the upward direction has changed.
  void replace_model(const Model& stored, std::shared_ptr<const mesh::ContactShadow> shadow);
  void retry_recovery(const Error& why);
  // As in gpu_problem.h, unless the room is closed.
  Error gpu_problem(const Error& why) const;
  std::uint64_t mirror_bytes() const;  // call while holding `mutex_`
  std::shared_ptr<const mesh::ContactShadow> make_contact_shadow(const std::string& up) const;
  std::vector<Layer> layer_list() const;
  Result<LayerState> state(const std::string& ref) const;
  // Returns an `invalid` error at `at` for a sequence that is not durable yet.
  Result<void> check_durable(At at) const;
  std::optional<TileMirror::Snapshot> durable_tiles(const Layer& layer) const;
  Result<TileMirror::Snapshot> tiles_at(const LayerState& state, At at) const;
  Result<std::vector<query::LayerView>> layer_views(const std::vector<std::string>& refs,
                                                    At at) const;
  Result<std::shared_ptr<const mesh::SurfaceMap>> surface_map(int resolution);

  const RoomServices services_;
  const ModelId model_id_;
  const std::int64_t epoch_;
  const std::shared_ptr<const mesh::Geometry> geometry_;
  // Coarser copies of the mesh, for moving cameras.
  const std::vector<std::shared_ptr<const mesh::Geometry>> coarser_;
  const Strand strand_;
  const std::shared_ptr<SurfaceMaps> maps_;
  std::shared_ptr<SurfaceImageCache> surface_image_cache_;
  std::shared_ptr<RecordColors> record_colors_;
  std::shared_ptr<RecordFeatures> record_features_;
  std::shared_ptr<PastLayers> past_layers_;
  const std::shared_ptr<SurfaceLookup> surface_lookup_;
  const std::shared_ptr<AppearanceCache> appearance_;
  std::shared_ptr<EditPipeline> pipeline_;

  // Changed on the strand while holding `mutex_`. The strand may read without the mutex, and other
  // threads must hold it.
  mutable std::mutex mutex_;
  Model model_;
  std::map<LayerId, LayerState> layers_;
  MemoryLedger::Share geometry_share_, mirrors_share_;
  render::ModelHandle model_handle_ = 0;
  std::shared_ptr<const mesh::ContactShadow> contact_shadow_;  // for `model_.up`
  std::chrono::steady_clock::time_point last_used_;            // all threads must hold `mutex_`
  // The reason why the room is closed. All threads must hold `mutex_`.
  std::optional<Error> closed_;

  std::atomic<std::int64_t> sequence_{0}, durable_{0};
  std::atomic<std::size_t> unanswered_{0};  // edits, and changes to layers that wait for edits
  std::atomic<bool> takes_edits_{true};
  std::atomic<bool> is_current_{true};  // changed on the strand

  struct Recovery {  // used on the strand
    static constexpr std::chrono::milliseconds kFirstRetry{250}, kLastRetry{8000};
    explicit Recovery(const Strand& strand) : timer(strand) {}
    bool gpu_lacks_all = false;
    bool journal_differs = false;
    // From `continue_saving` until the model, its layers and images were read again. A change may
    // have been saved although its response was lost, so the room does not have it.
    bool metadata_outdated = false;
    bool compared = false;  // the journal was compared since `continue_saving`
    // Counts the changes that outdate metadata which are being read: calls of `stop_saving`, and
    // images that were created or deleted.
    int metadata_changes = 0;
    bool working = false;  // a recovery is running
    bool closed = false;
    int gpu_losses = 0;
    std::chrono::milliseconds retry_in = kFirstRetry;
    boost::asio::steady_timer timer;
  } recovery_;
  std::optional<Error> moved_;  // why the model moved away; used on the strand

  const std::unique_ptr<LayersPart> layers_part_;
  const std::unique_ptr<EditsPart> edits_part_;
  const std::unique_ptr<QueriesPart> queries_part_;
  const std::unique_ptr<SurfacePart> surface_part_;
  const std::unique_ptr<PicturesPart> pictures_part_;
  const std::unique_ptr<SurfaceImagesPart> surface_images_part_;
  const std::unique_ptr<ParticipantsPart> participants_part_;
  std::unique_ptr<FollowingPart> following_part_;  // set before the room is shared
};

template <class T>
Result<T> OpenRoom::exclusively(std::function<Result<T>()> work) {
  STRATA_TRY(check_claimed());
  auto promise = std::make_shared<std::promise<Result<T>>>();
  auto future = promise->get_future();
  ++unanswered_;
  boost::asio::post(strand_, [self = shared_from_this(), promise, work = std::move(work)] {
    self->pipeline_->when_idle([self, promise, work](const Result<void>& may) {
      const auto owned = may ? self->check_not_deposed() : may;
      if (owned)
        promise->set_value(work());
      else
        promise->set_value(tl::unexpected(owned.error()));
    });
  });
  auto result = future.get();
  --unanswered_;
  return result;
}

}  // namespace strata::room
