#pragma once

#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
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
#include "room/pipeline/layer_state.h"
#include "room/pipeline/strand.h"
#include "room/pipeline/tile_changes.h"
#include "store/journal/journal_reads.h"
#include "store/journal/journal_writer.h"

namespace strata::room {

// The room's functions that the pipeline uses. All calls are made on the strand.
class PipelineHost {
 public:
  virtual ~PipelineHost() = default;
  virtual LayerState* find_layer(LayerId id) = 0;
  // of all layers, with the present content of their mirrors
  virtual std::vector<query::LayerView> layer_snapshots() = 0;
  virtual const Model& pipeline_model() const = 0;
  virtual render::ModelHandle model_handle() const = 0;
  // called when the first texels of a layer begin to wait for review, or the last ones end to
  virtual void styles_changed() = 0;
  // other threads may read the sequence
  virtual void set_sequence(LayerState& layer, std::int64_t sequence) = 0;
  virtual void content_changed(const LayerState& layer,
                               const std::optional<render::FrameRequest::Box>& box,
                               std::int64_t sequence) = 0;  // no box: everywhere
  virtual void edit_applied(const Listener::Edit& edit) = 0;
  virtual void edit_saved(const Listener::Edit& edit) = 0;
  virtual void edits_unsaved(const std::vector<Listener::Edit>& edits, const Error& why) = 0;
  // called when the journal differs from the room: the room must read it again. The host pauses the
  // pipeline
  virtual void journal_differs() = 0;
  // called after a request to pause, when nothing is in progress
  virtual void paused() = 0;
};

// Orders the edits of one room. An edit is first looked up in the journal, which may contain it
// from an earlier connection. Then strokes go to the GPU, several at a time, in sequence order;
// edits that are computed from the tile mirror (fill, polygon, import, undo, restore) wait until
// the earlier strokes are read back, and are applied when the GPU has them. The read-back is
// compared with the mirror once: the difference becomes the journal's revision, the counts and the
// change on screen.
//
// The mirrors are always right: they contain the edits in the journal and those on the way to it.
// The GPU may be behind them (`stale_`); it is updated before anything else starts.
//
// The lock of a layer is enforced here, and only here: before an edit begins, the lock is checked
// again, regardless of the edit's source and of the time of the lock. An edit in the journal keeps
// its first answer, and an edit that has begun is completed.
//
// Lives on the room's strand: every method is called there, and nothing there waits. `readers` and
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
  };
  EditPipeline(Parts parts, PipelineHost& host, std::int64_t last_sequence);

  void edit(EditRequest request, Applied applied, Saved saved);
  // nothing is being painted or computed
  bool is_still() const { return in_flight_ == 0 && !busy_; }
  // Calls `work` on a worker, where it may block, when every earlier edit is durable; nothing else
  // runs at the same time. If that cannot happen, calls it with the reason, on the strand.
  using Work = std::function<void(const Result<void>&)>;
  void when_idle(Work work);

  std::int64_t sequence() const { return sequence_; }
  // Returns the texels of a layer that wait for review (room/pipeline/provisional.h) after the last
  // edit that is known to be in the journal.
  TileMap durable_provisional(const LayerState& layer) const;

  // Starts nothing more, and notifies the host when nothing is in progress: then the layers'
  // handles and mirrors may be changed. Journal entries may still be on their way, but no rollback
  // happens before `resume`.
  void pause();
  void gpu_filled() {  // while paused: from the mirrors
    stale_.clear();
    stale_marks_.clear();
  }
  // While paused: the mirrors now contain the journal up to `last_sequence`; the GPU does not have
  // `tiles` of a layer yet.
  void journal_read(std::int64_t last_sequence);
  void gpu_lacks(LayerId layer_id, const std::vector<TileAddress>& tiles);
  void resume();

  void refuse_waiting(const Error& why);
  void close(const Error& why);  // the host is being destroyed: refuses waiting and later edits

 private:
  struct Waiting {
    EditRequest request;  // unused if there is `work`
    Applied applied;
    Saved saved;
    // of `when_idle`, instead of an edit
    Work work;
    // is_new: its id is not in the journal
    enum class Lookup { none, requested, is_new } lookup = Lookup::none;
    // of the mirror, while the GPU is ahead of it
    std::shared_ptr<const void> hold = {};
  };
  // An applied edit on its way to the journal, with the data for a rollback.
  struct Pending {
    Listener::Edit event;
    std::vector<TileChange> changes;
    TileMap provisional;  // the tiles of texels that waited for review, before the edit
    std::int64_t layer_sequence_before = 0;
    Saved saved;
    bool answered = false;
  };

  // --- looking up
  void ask_journal();
  void on_journal(bool verifying, const Result<store::JournalState>& state);
  void on_known(const std::vector<store::JournalRow>& known);
  // --- starting
  void step();
  bool start_front();  // false: it has to wait
  void start_work(Work work);
  bool map_ready(int resolution);
  void start_stroke(Waiting item, const LayerState& layer);
  void stroke_done(Waiting& item, Result<render::StrokeOutcome> outcome);
  void start_computed(Waiting item, const LayerState& layer);
  void upload_computed(const std::shared_ptr<Waiting>& item, Result<ComputedEdit> computed);
  void computed_uploaded(Waiting& item, ComputedEdit computed, const Result<void>& uploaded);
  // --- saving and rolling back
  void commit(Waiting& item, LayerState& layer, ComputedEdit computed,
              const std::optional<render::FrameRequest::Box>& box);
  // Null: no texel of the tile waits for review.
  void put_provisional(LayerState& layer, const TileMap& tiles, std::int64_t sequence);
  void on_saved(std::int64_t sequence, const Result<void>& result);
  void roll_back_when_answered();
  bool repair();  // false: the GPU is up to date
  void repaired(const std::optional<Error>& failure);
  void refuse(Waiting& item, const Error& why);
  void answer(const Uuid& id, const Saved& saved, const Result<EditAnswer>& result);

  // Returns a callback that, on the strand, passes its argument to `handler` and then calls `step`.
  template <class Handler>
  auto then(Handler handler);

  Parts parts_;
  PipelineHost* host_;     // null when closed
  std::int64_t sequence_;  // of the last edit in the mirrors
  std::int64_t durable_;   // of the last edit in the journal
  std::deque<Waiting> waiting_;
  bool asking_ = false;  // a question to the journal is in progress
  // the last question had no answer: the next does not wait for the database
  bool journal_away_ = false;
  int in_flight_ = 0;  // strokes on the GPU
  bool busy_ = false;  // a computed edit, `when_idle` work or a repair is in progress
  bool waits_for_map_ = false;
  bool paused_ = false;
  bool tell_paused_ = false;     // the host waits for `paused`
  std::optional<Error> closed_;  // the answer to later edits
  // nothing starts before the room was compared with the journal, which may contain more
  bool verify_ = false;
  // commits failed: all pending edits are rolled back once they are answered
  std::optional<Error> failure_;
  std::deque<Pending> pending_;  // sequence order
  std::map<LayerId, std::set<TileAddress>>
      stale_;  // by layer: tiles where the GPU may differ from the mirror
  // The same for texels that wait for review. The upload is repeated with the layer's next one, and
  // does not delay edits.
  std::map<LayerId, std::set<TileAddress>> stale_marks_;
  boost::asio::steady_timer repair_timer_;
  bool repair_waits_ = false;  // for the timer
  // By layer: revisions since the last key tile was stored, in this room.
  std::map<LayerId, std::unordered_map<TileAddress, int>> since_key_tile_;
  struct Running {
    std::string user;
    std::vector<Saved> followers;  // callers that repeated it
  };
  std::unordered_map<Uuid, Running> running_;  // waiting and pending edits
};

}  // namespace strata::room
