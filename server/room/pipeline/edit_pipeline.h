#pragma once

#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <unordered_map>
#include <vector>

#include "core/ids.h"
#include "room/caches/surface_maps.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/listener.h"
#include "room/pipeline/computed_edit.h"
#include "room/pipeline/edit_trace.h"
#include "room/pipeline/layer_state.h"
#include "room/pipeline/strand.h"
#include "room/pipeline/tile_changes.h"
#include "store/journal/journal_reads.h"
#include "store/journal/journal_writer.h"

namespace strata::room {

// The functions of the room that the pipeline uses. All calls are on the strand.
class PipelineHost {
 public:
  virtual ~PipelineHost() = default;
  virtual LayerState* find_layer(LayerId id) = 0;
  // Returns all layers, with the present content of their mirrors.
  virtual std::vector<query::LayerView> layer_snapshots() = 0;
  virtual const Model& pipeline_model() const = 0;
  virtual render::ModelHandle model_handle() const = 0;
  // Called when the first texels of a layer begin to wait for review, and when no texels wait any
  // longer.
  virtual void styles_changed() = 0;
  // Other threads may read the sequence.
  virtual void set_sequence(LayerState& layer, std::int64_t sequence) = 0;
  virtual void content_changed(const LayerState& layer,
                               const std::optional<render::FrameRequest::Box>& box,
                               std::int64_t sequence) = 0;  // without a box: the whole surface
  virtual void edit_applied(const Listener::Edit& edit) = 0;
  virtual void edit_saved(const Listener::Edit& edit) = 0;
  virtual void edits_unsaved(const std::vector<Listener::Edit>& edits, const Error& why) = 0;
  // Called when the journal differs from the room, so the room must read the journal again. The
  // host pauses the pipeline.
  virtual void journal_differs() = 0;
  // Called when another server has claimed the model (`moved`), or when it was deleted or moved to
  // the Trash without this room (`not_found`). The host closes the pipeline.
  virtual void deposed(const Error& why) = 0;
  // Called after a request to pause, when nothing is in progress.
  virtual void paused() = 0;
  // Called after `continue_saving`, when the room has the content of the journal.
  virtual void saving_continued() = 0;
};

// Orders the edits of one room. First, the pipeline looks up an edit in the journal, which may
// contain it from an earlier connection. Then it sends strokes to the GPU in the order of their
// sequences, several at a time. Other edits are computed from the tile mirror (fill, polygon,
// import, undo, restore). They wait until the earlier strokes are read back, and are applied after
// their upload to the GPU. The pipeline compares the read-back with the mirror once. The difference
// determines the revision in the journal, the counts, and the change on screen.
//
// The mirrors are always correct: they contain the edits in the journal and the pending edits. The
// GPU may still contain older values (`stale_`). The pipeline updates it before any other work.
//
// Only the pipeline enforces the lock of a layer. It checks the lock again before each edit begins,
// regardless of the source of the edit and the time of the lock. An edit in the journal keeps its
// first result, and an edit that has begun is completed.
//
// Runs on the strand of the room: every method is called there, and no method waits. `readers` and
// `workers` do the work that blocks (journal, history), and post their results to the strand.
class EditPipeline : public std::enable_shared_from_this<EditPipeline> {
 public:
  struct Parts {
    store::Store& store;
    store::JournalWriter& writer;
    render::Renderer& renderer;
    boost::asio::thread_pool& workers;
    boost::asio::thread_pool& readers;
    Strand strand;
    std::shared_ptr<SurfaceMaps> maps;
    std::shared_ptr<SurfaceLookup> surface;
    const MemoryLedger& memory;
    std::int64_t epoch;  // epoch of the claim of the model (store/nodes/nodes.h)
    ModelId model_id;
    EditTimings& timings;
    std::chrono::milliseconds slow_after;  // see report_edit
  };
  EditPipeline(Parts parts, PipelineHost& host, std::int64_t last_sequence);

  void edit(EditRequest request, Applied applied, Saved saved);
  // Returns whether nothing is being painted or computed.
  bool is_still() const { return in_flight_ == 0 && !busy_; }
  // Calls `work` on a worker, where it may block, when every earlier edit is durable. No other work
  // runs at the same time. If this is not possible, calls `work` with the reason, on the strand.
  using Work = std::function<void(const Result<void>&)>;
  void when_idle(Work work);

  std::int64_t sequence() const { return sequence_; }
  // Returns the texels of a layer that wait for review (room/pipeline/provisional.h) after the last
  // edit that is known to be in the journal.
  TileMap durable_provisional(const LayerState& layer) const;

  // Starts no more work, and notifies the host when no work is in progress. Then the handles and
  // mirrors of the layers may be changed. Commits may still be in progress, but no rollback happens
  // before `resume`.
  void pause();
  // Call while paused, after all data was uploaded from the mirrors.
  void gpu_filled() {
    stale_.clear();
    stale_marks_.clear();
  }
  // Call while paused, when the mirrors contain the journal up to `last_sequence`. `gpu_lacks`
  // lists tiles of a layer that the GPU does not have yet.
  void journal_read(std::int64_t last_sequence);
  void gpu_lacks(LayerId layer_id, const std::vector<TileAddress>& tiles);
  void resume();

  // For a room that follows another node (room/open/following.h), instead of all calls that edit.
  // Puts content that is in the journal into the mirrors, and uploads it. A null tile is empty.
  // Returns false, and changes nothing, while earlier content is uploaded or the room is paused.
  struct LayerNews {
    LayerId layer_id = 0;
    std::int64_t sequence = 0;  // of the last edit of the layer
    TileMap tiles, provisional;
  };
  bool take_news(std::int64_t last_sequence, const std::vector<LayerNews>& news);

  // Refuses waiting, pending and later edits with `why`, until `continue_saving`. A pending edit
  // may be in the journal nevertheless. Its author sends it again and then gets its first answer.
  void stop_saving(const Error& why);
  // Accepts edits again. They start after the room was compared with the journal, because another
  // server may have claimed the model in the meantime. Then PipelineHost::saving_continued is
  // called.
  void continue_saving();

  void refuse_waiting(const Error& why);
  // Call before the host is destroyed. Refuses waiting and later edits. If the model moved, also
  // immediately refuses the edits that wait for their commit, because this server must not
  // acknowledge them. The client sends them again to the next owner, which looks for them in the
  // journal.
  void close(const Error& why);

 private:
  struct Waiting {
    EditRequest request;  // unused if `work` is set
    Applied applied;
    Saved saved;
    // The work of `when_idle`, instead of an edit.
    Work work;
    // is_new means that the journal does not contain the id.
    enum class Lookup { none, requested, is_new } lookup = Lookup::none;
    // Prevents eviction of the layer while the GPU has edits that the mirror lacks.
    std::shared_ptr<const void> hold = {};
    EditTrace trace = {};
  };
  // An applied edit that is not yet in the journal, with the data for a rollback.
  struct Pending {
    Listener::Edit event;
    std::vector<TileChange> changes;
    TileMap provisional;  // tiles of the texels that waited for review before the edit
    std::int64_t layer_sequence_before = 0;
    Saved saved;
    EditTrace trace;
    bool answered = false;
  };

  // --- look-up in the journal
  void ask_journal();
  void on_journal(bool verifying, const Result<store::JournalState>& state);
  void on_known(const std::vector<store::JournalRow>& known);
  void compare_later();
  void report_compared();
  // --- start of edits
  void step();
  bool start_front();  // returns false if the edit has to wait
  void start_work(Work work);
  bool map_ready(int resolution);
  void start_stroke(Waiting item, const LayerState& layer);
  void stroke_done(Waiting& item, Result<render::StrokeOutcome> outcome);
  void start_computed(Waiting item, const LayerState& layer);
  void upload_computed(const std::shared_ptr<Waiting>& item, Result<ComputedEdit> computed);
  void computed_uploaded(Waiting& item, ComputedEdit computed, const Result<void>& uploaded);
  // --- saving and rollback
  void refuse_pending(const Error& why);
  void commit(Waiting& item, LayerState& layer, ComputedEdit computed,
              const std::optional<render::FrameRequest::Box>& box);
  void submit(store::JournalEntry entry, Pending& pending);
  // A null tile means that no texel of the tile waits for review. The box contains the tiles'
  // changes, if it is known.
  void put_provisional(LayerState& layer, const TileMap& tiles, std::int64_t sequence,
                       const std::optional<render::FrameRequest::Box>& box);
  void on_saved(std::int64_t sequence, const Result<void>& result);
  void roll_back_when_answered();
  bool repair();  // returns false if the GPU is up to date
  // Returns whether the layer still has this copy on the GPU. A room that follows another node can
  // unload or replace a layer at any time.
  bool has(LayerId id, render::LayerHandle handle) const;
  void repaired(const std::optional<Error>& failure);
  void announce_tiles(const LayerState& layer, const std::set<TileAddress>& tiles,
                      std::int64_t sequence);
  void refuse(Waiting& item, const Error& why);
  void report(const Pending& pending, const Error* why);
  void answer(const Uuid& id, const Saved& saved, const Result<EditAnswer>& result);

  // Returns a callback. It passes its argument to `handler` and then calls `step`, both on the
  // strand.
  template <class Handler>
  auto then(Handler handler);

  Parts parts_;
  PipelineHost* host_;     // null when the pipeline is closed
  std::int64_t sequence_;  // sequence of the last edit in the mirrors
  std::int64_t durable_;   // sequence of the last edit in the journal
  std::deque<Waiting> waiting_;
  bool asking_ = false;  // a look-up in the journal is in progress
  // The last look-up failed, so the next one does not wait for the database.
  bool journal_away_ = false;
  int in_flight_ = 0;  // strokes on the GPU
  bool busy_ = false;  // a computed edit, `when_idle` work or a repair is in progress
  bool waits_for_map_ = false;
  bool paused_ = false;
  bool tell_paused_ = false;         // the host waits for a call of `paused`
  std::optional<Error> closed_;      // the error for later edits
  std::optional<Error> not_saving_;  // the error for edits until `continue_saving`
  // No work starts before the room was compared with the journal, which may contain more edits.
  bool verify_ = false;
  // The look-up or the reading in progress began before `stop_saving`, so its result is not used.
  bool lookup_outdated_ = false, reading_outdated_ = false;
  // From `continue_saving` until the room was compared with the journal. A failed comparison is
  // repeated even if no edit waits for it, because viewers must notice that the model moved.
  bool compares_ = false;
  // The reason why commits failed. All pending edits are rolled back when every commit has ended.
  std::optional<Error> failure_;
  std::deque<Pending> pending_;  // in the order of sequences
  // By layer: the tiles where the GPU may differ from the mirror.
  std::map<LayerId, std::set<TileAddress>> stale_;
  // Like `stale_`, for texels that wait for review. The upload is repeated together with the
  // layer's next upload, and does not delay edits.
  std::map<LayerId, std::set<TileAddress>> stale_marks_;
  boost::asio::steady_timer repair_timer_, compare_timer_;
  bool repair_waits_ = false;  // waiting for the timer
  // By layer: the number of revisions since the last key tile was stored, in this room.
  std::map<LayerId, std::unordered_map<TileAddress, int>> since_key_tile_;
  struct Running {
    std::string user;
    std::vector<Saved> followers;  // callers that repeated the request
  };
  std::unordered_map<Uuid, Running> running_;  // waiting and pending edits by id
};

}  // namespace strata::room
