#pragma once

#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>

#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "domain/scene/look.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "expression/expression.h"
#include "room/contents.h"
#include "room/edit_pipeline.h"
#include "room/followers.h"
#include "room/look_shelf.h"
#include "room/member.h"
#include "room/record_colors.h"
#include "room/record_marks.h"
#include "room/retired_keys.h"
#include "room/room.h"
#include "store/content/first_answer.h"

namespace strata::room {

// What rooms share.
struct RoomParts {
  store::Store& store;
  store::JournalWriter& writer;
  render::Renderer& renderer;
  stream::StreamContext stream;
  boost::asio::thread_pool& strands;  // room strands run here: short work, nothing that waits
  boost::asio::thread_pool& workers;  // bakes, history, loading: long work
  MemoryLedger& memory;               // of what rooms hold, but for the GPU's
  // questions to the journal before each edit: they wait for the database only
  boost::asio::thread_pool& readers;
  const RetiredKeys& retired_keys;
  RoomOptions options;
};

class OpenRoom final : public Room,
                       public PipelineHost,
                       public std::enable_shared_from_this<OpenRoom> {
 public:
  // Loads everything; blocks.
  static Result<std::shared_ptr<OpenRoom>> open(const RoomParts& parts,
                                                const std::string& model_ref);
  OpenRoom(const RoomParts& parts, Model model, render::ModelGeometry geometry);
  ~OpenRoom() override;

  // --- Room
  Model model() const override;
  std::vector<Layer> layers() const override;
  Result<Layer> layer(const std::string& ref) const override;
  std::int64_t sequence() const override;
  std::int64_t durable_sequence() const override;
  DurableState durable_state() const override;
  void edit(EditRequest request, Applied applied, Saved saved) override;
  std::unique_ptr<Member> join(Author who, Portrait portrait, Listener* listener,
                               stream::Viewer::Send send) override;
  std::vector<Presence> presence(const Uuid& receiver) const override;
  Result<Layer> create_layer(Layer layer, const store::FirstAnswer<Layer>& answer,
                             std::vector<Column> columns) override;
  Result<Layer> update_layer(Layer layer, const store::FirstAnswer<Layer>& answer) override;
  Result<Layer> widen_layer(const Layer& layer, ValueType type,
                            const store::FirstAnswer<Layer>& answer) override;
  Result<void> delete_layer(std::int64_t id, const store::FirstAnswer<>& answer) override;
  Result<void> bin_layer(std::int64_t id, const store::FirstAnswer<>& answer) override;
  Result<store::BinRestored> restore_layer(
      const store::BinEntry& entry, const store::FirstAnswer<store::BinRestored>& answer) override;
  Result<Layer> layer_computed(std::int64_t id, const std::string& expression,
                               std::int64_t sequence,
                               const std::map<std::int64_t, std::int64_t>& tables) override;
  void records_changed(std::int64_t table_id) override;
  Result<void> check_expression(const Expression& expression, const std::string& field,
                                Visibility layer) const override;
  Result<Model> update_model(Model model, const store::FirstAnswer<Model>& answer) override;
  Result<query::SurfacePoint> position(const glm::dvec3& world,
                                       const std::vector<std::string>& layers, At at) override;
  Result<std::vector<query::SurfacePoint>> positions(const std::vector<glm::dvec3>& world,
                                                     const std::vector<std::string>& layers,
                                                     At at) override;
  Result<query::SurfacePoint> pick(const Camera& camera, double x, double y,
                                   const std::vector<std::string>& layers, At at) override;
  Result<query::Statistics> statistics(const std::string& layer, const Selection& selection,
                                       StatisticsWanted wanted) override;
  Result<SelectedArea> select(const Selection& selection, const std::vector<std::string>& layers,
                              StatisticsWanted wanted) override;
  Result<query::Profile> profile(const ProfileLine& line, const std::vector<std::string>& layers,
                                 At at) override;
  Result<query::CrossTable> cross_table(const std::string& rows, const std::string& columns,
                                        const Selection& selection) override;
  Result<query::Quantities> quantities(const std::string& layer, At at) override;
  Result<LayerAreas> layer_areas(const std::string& layer, At at) override;
  Result<query::SurfaceTexels> surface_texels(const std::string& layer,
                                              const Selection& selection) override;
  Result<TileMap> dabs(const Layer& layer, const std::vector<PlacedValue>& values, double radius,
                       double tolerance) override;
  Result<TileMap> project(const Layer& layer, const glm::dvec3& direction,
                          const ValueAt& value_at) override;
  Result<std::map<std::int64_t, query::KeyArea>> key_areas(const std::string& layer) override;
  Result<void> sum_layer(std::int64_t layer_id) override;
  Result<void> settle();  // returns when every edit before is durable; blocks
  Result<TileMirror::Snapshot> tiles(const std::string& layer,
                                     std::optional<std::int64_t> at) override;
  std::shared_ptr<const mesh::Geometry> geometry() const override { return geometry_; }
  std::shared_ptr<const mesh::SearchTree> search_tree() override { return surface_->tree(); }
  Result<std::shared_ptr<const mesh::SurfaceMap>> surface_map(int resolution) override;
  Result<void> pictures(const PictureRequest& request, std::span<const PicturePart> parts,
                        const SeePicture& see) override;
  Result<std::vector<std::optional<std::uint32_t>>> seen_keys(const std::string& layer,
                                                              const Camera& camera, int columns,
                                                              int rows, At at) override;
  Result<std::vector<query::SeenLayer>> seen_layers(const std::vector<std::string>& layers,
                                                    const std::vector<query::LayerCover>& covers,
                                                    const Camera& camera, int columns, int rows,
                                                    At at) override;
  std::vector<Look> looks() const override { return look_shelf_->all(); }
  Result<Look> look(const std::string& ref) const override;
  Result<Look> create_look(Look look, std::span<const std::uint8_t> picture,
                           const store::FirstAnswer<Look>& answer) override;
  Result<Look> update_look(const Look& look, const store::FirstAnswer<Look>& answer) override;
  Result<void> delete_look(std::int64_t id, const store::FirstAnswer<>& answer) override;

  // --- PipelineHost (on the strand)
  LayerState* find_layer(std::int64_t id) override;
  std::vector<query::LayerView> layer_snapshots() override;
  render::ModelHandle model_handle() const override;  // also for members
  const Model& pipeline_model() const override { return model_; }
  void styles_changed() override { sort_layers_changed(); }
  void set_sequence(LayerState& layer, std::int64_t sequence) override;
  void content_changed(const LayerState& layer, const std::optional<render::FrameRequest::Box>& box,
                       std::int64_t sequence) override;
  void edit_applied(const Listener::Edit& edit) override;
  void edit_saved(const Listener::Edit& edit) override;
  void edits_unsaved(const std::vector<Listener::Edit>& edits, const Error& why) override;
  void journal_differs() override;
  void paused() override;

  // --- for members
  stream::StreamContext stream_context() const { return parts_.stream; }
  LookShelf& look_shelf() const { return *look_shelf_; }
  RecordColors& record_colors() const { return *record_colors_; }
  RecordMarks& record_marks() const { return *record_marks_; }
  std::vector<LayerState> layer_states() const;  // in drawing order
  std::optional<LayerState> layer_state(std::int64_t id) const;
  void leave(RoomMember* member);
  void announce_presence();
  // Instead of whom they followed before; nothing: they follow nobody. Refused (not_found): nobody
  // here has that session; else as by Followers.
  Result<void> follow(const Uuid& follower, const std::optional<Uuid>& leader);
  void camera_moved(const Uuid& session);  // tells those who follow it

  // --- for Rooms
  void gpu_lost();
  bool deserted(std::chrono::steady_clock::time_point now) const;  // nobody for `close_after`
  void touch();
  std::size_t people() const;   // who are in it, a connection each
  std::size_t take_departed();  // who have left it since this was asked
  const SurfaceMaps& maps() const { return *maps_; }
  bool drop_map();
  // Lets go of what a question about a very fine layer has left, and nobody used for a while.
  // the one that was not used for the longest time, where nothing is being painted. Blocks
  bool drop_large_unused_maps(std::chrono::steady_clock::time_point now);
  void take_no_edits() { takes_edits_ = false; }  // new ones are refused
  bool idle() const { return unanswered_ == 0; }  // every edit is durable or refused
  // refuses what waits and what comes, lets go of the GPU; blocks
  void shut(const Error& why);
  void shut_deleted();  // as the model was deleted: people are told first
  std::int64_t id() const { return model_id_; }

 private:
  template <class Work>
  auto on_strand(Work work) const;                        // runs there and waits for the result
  void tell(const std::function<void(Listener&)>& tell);  // every listener
  // of who sees the layer
  void tell_seen(const Layer& layer, const std::function<void(Listener&)>& tell);
  // Who begins to see the layer hears that it was made, who ends that it was deleted. `before`:
  // nothing, where it is new.
  void tell_layer(std::optional<Visibility> before, const Layer& layer);
  // Runs `work` on a worker when every edit before it is durable. No edit starts meanwhile, and no
  // recovery. Blocks.
  template <class T>
  Result<T> exclusively(std::function<Result<T>()> work);
  // recovery.cpp
  void recover();
  void on_gpu_filled(int losses_before, const Result<GpuContents>& contents);
  void on_journal_read(Result<JournalContents> contents);
  void retry_recovery(const Error& why);
  Result<void> let_go_of_layer(std::int64_t id, const std::function<Result<void>()>& in_store);
  // that the store has again; alone, as `exclusively` runs it
  Result<void> take_up_layer(std::int64_t id);
  Result<void> check_not_retired(const EditRequest& request);
  // as gpu_problem.h has it, unless the room is shut
  Error gpu_problem(const Error& why) const;
  void sort_layers_changed();
  // On the strand: computed layers that `reads` tells become stale, and people are told.
  void outdate(const std::function<bool(const LayerFormula&)>& reads);
  // on the strand: what is stored becomes what is here; tells
  Layer replace_layer(const Layer& stored);
  std::uint64_t mirror_bytes() const;  // with `mutex_` held
  void tell_look(Listener::LayerChange change, const Look& look);
  Result<LayerState> state(const std::string& ref) const;
  // queries.cpp
  Result<TileMirror::Snapshot> tiles_at(const LayerState& state, At at) const;
  Result<std::vector<query::LayerView>> layer_views(const std::vector<std::string>& refs,
                                                    At at) const;
  struct LayerGraph {
    query::LayerView view;
    std::shared_ptr<const mesh::SurfaceMap> map;
    std::shared_ptr<const mesh::TexelGraph> graph;
  };
  Result<LayerGraph> layer_graph(const std::string& layer, At at);
  // `request` has all but the camera and the size.
  Result<void> draw_in_bands(render::FrameRequest request, const PicturePart& part,
                             std::size_t number, const SeePicture& see);
  Result<std::optional<query::TexelSelection>> texels_within(const Selection& selection,
                                                             const mesh::SurfaceMap& map);
  Result<std::optional<query::TexelSelection>> select_texels(const Selection& selection,
                                                             const mesh::SurfaceMap& map);
  // `within` is null where the whole surface is meant; `is_now`: the view is the newest, whose sums
  // are kept.
  Result<query::Statistics> count(const query::LayerView& view, const mesh::SurfaceMap& map,
                                  const query::TexelSelection* within, bool is_now,
                                  StatisticsWanted wanted);

  const RoomParts parts_;
  const std::int64_t model_id_;
  const std::shared_ptr<const mesh::Geometry> geometry_;
  // copies of it, for moving cameras
  const std::vector<std::shared_ptr<const mesh::Geometry>> coarser_;
  const Strand strand_;
  const std::shared_ptr<SurfaceMaps> maps_;
  std::shared_ptr<LookShelf> look_shelf_;
  std::shared_ptr<RecordColors> record_colors_;
  std::shared_ptr<RecordMarks> record_marks_;
  const std::shared_ptr<SurfaceLookup> surface_;
  std::shared_ptr<EditPipeline> pipeline_;

  // Changed on the strand, under `mutex_`; so read on the strand without it, and elsewhere under
  // it.
  mutable std::mutex mutex_;
  Model model_;
  std::map<std::int64_t, LayerState> layers_;
  MemoryLedger::Share geometry_share_, mirrors_share_;
  render::ModelHandle model_handle_ = 0;
  std::chrono::steady_clock::time_point last_used_;  // under `mutex_` everywhere
  std::optional<Error> shut_;                        // why, once it is; under `mutex_` everywhere

  std::atomic<std::int64_t> sequence_{0}, durable_{0};
  std::atomic<std::size_t> unanswered_{0};  // edits, and changes of layers that wait for them
  std::atomic<bool> takes_edits_{true};

  struct Recovery {  // on the strand
    static constexpr std::chrono::milliseconds kFirstRetry{250}, kLastRetry{8000};
    explicit Recovery(const Strand& strand) : timer(strand) {}
    bool gpu_lacks_all = false;
    bool journal_differs = false;
    bool working = false;  // one of them is being mended
    bool shut = false;
    int gpu_losses = 0;
    std::chrono::milliseconds retry_in = kFirstRetry;
    boost::asio::steady_timer timer;
  } recovery_;

  // recursive: a listener may ask for presence while it is told
  mutable std::recursive_mutex members_mutex_;
  std::vector<RoomMember*> members_;
  std::size_t departed_ = 0;
  Followers followers_;
};

}  // namespace strata::room
