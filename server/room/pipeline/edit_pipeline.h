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

// What the pipeline needs of its room. All calls are made on the strand.
class PipelineHost {
 public:
  virtual ~PipelineHost() = default;
  virtual LayerState* find_layer(LayerId id) = 0;
  // of all layers, as their mirrors are now
  virtual std::vector<query::LayerView> layer_snapshots() = 0;
  virtual const Model& pipeline_model() const = 0;
  virtual render::ModelHandle model_handle() const = 0;
  // a layer has begun to wait for review, or nothing of it does any more
  virtual void styles_changed() = 0;
  // other threads may be reading it
  virtual void set_sequence(LayerState& layer, std::int64_t sequence) = 0;
  virtual void content_changed(const LayerState& layer,
                               const std::optional<render::FrameRequest::Box>& box,
                               std::int64_t sequence) = 0;  // no box: everywhere
  virtual void edit_applied(const Listener::Edit& edit) = 0;
  virtual void edit_saved(const Listener::Edit& edit) = 0;
  virtual void edits_unsaved(const std::vector<Listener::Edit>& edits, const Error& why) = 0;
  // from what the room holds: read it anew. The host pauses the pipeline
  virtual void journal_differs() = 0;
  // the pipeline was asked to pause, and nothing is under way any more
  virtual void paused() = 0;
};

// The order of edits of one room. An edit is first looked up in the journal, which may hold it from
// an earlier connection. Then strokes go to the GPU several at a time, in sequence order; edits
// that are computed from the tile mirror (fill, polygon, import, undo, restore) wait until the
// strokes before them are read back, and are applied once the GPU has them. What was read back is
// compared with the mirror once: that difference becomes the journal's revision, the counts and the
// change on screen.
//
// The mirrors are right at every moment: they hold what the journal has and what is on its way
// there. The GPU may fall behind them (`stale_`); it is brought up to date before anything else
// starts.
//
// A locked layer is left alone here, and only here: whatever way an edit came, and whenever the
// lock fell, the layer is looked at once more when the edit would begin. What the journal knows
// keeps its first answer, and what has begun is brought to its end.
//
// Lives on the room's strand: every method is called there, and nothing there waits. What blocks
// (journal, history) is done by `readers` and `workers`, whose answers are posted to the strand.
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
  // Calls `work` on a worker, where it may block, when every edit before it is durable; nothing
  // else runs meanwhile. Where that will never be, calls it with the reason, on the strand.
  using Work = std::function<void(const Result<void>&)>;
  void when_idle(Work work);

  std::int64_t sequence() const { return sequence_; }
  // What waits for review on a layer (room/pipeline/provisional.h) after the last edit that is
  // known to be in the journal.
  TileMap durable_provisional(const LayerState& layer) const;

  // Starts nothing more, and tells the host as soon as nothing is under way: then the layers'
  // handles and mirrors may be changed. Journal entries may still be on their way, but none is
  // taken back before `resume`.
  void pause();
  void gpu_filled() {  // while paused: from the mirrors
    stale_.clear();
    stale_marks_.clear();
  }
  // While paused: the mirrors now hold what the journal has, up to `last_sequence`; the GPU has not
  // got `tiles` of a layer yet.
  void journal_read(std::int64_t last_sequence);
  void gpu_lacks(LayerId layer_id, const std::vector<TileAddress>& tiles);
  void resume();

  void refuse_waiting(const Error& why);
  void close(const Error& why);  // the host goes away: waiting edits are refused, and later ones

 private:
  struct Waiting {
    EditRequest request;  // nobody's where there is `work`
    Applied applied;
    Saved saved;
    // of `when_idle`, instead of an edit
    Work work;
    // is_new: the journal does not know its id
    enum class Lookup { none, asked, is_new } lookup = Lookup::none;
    // of the mirror, while the GPU is ahead of it
    std::shared_ptr<const void> hold = {};
  };
  // Applied and on its way to the journal; what is needed to take it back.
  struct Pending {
    Listener::Edit event;
    std::vector<TileChange> changes;
    TileMap provisional;  // the tiles of what waited for review, as they were before
    std::int64_t layer_sequence_before = 0;
    Saved saved;
    bool answered = false;
  };

  // Looking up
  void ask_journal();
  void on_journal(bool verifying, const Result<store::JournalState>& state);
  void on_known(const std::vector<store::JournalRow>& known);
  // Starting
  void step();
  bool start_front();  // false: it has to wait
  void start_work(Work work);
  bool map_ready(int resolution);
  void start_stroke(Waiting item, const LayerState& layer);
  void stroke_done(Waiting& item, Result<render::StrokeOutcome> outcome);
  void start_computed(Waiting item, const LayerState& layer);
  void upload_computed(const std::shared_ptr<Waiting>& item, Result<ComputedEdit> computed);
  void computed_uploaded(Waiting& item, ComputedEdit computed, const Result<void>& uploaded);
  // Making durable, or taking back
  void commit(Waiting& item, LayerState& layer, ComputedEdit computed,
              const std::optional<render::FrameRequest::Box>& box);
  // Null: nothing of the tile waits for review.
  void put_provisional(LayerState& layer, const TileMap& tiles, std::int64_t sequence);
  void on_saved(std::int64_t sequence, const Result<void>& result);
  void roll_back_when_answered();
  bool repair();  // false: the GPU has all
  void repaired(const std::optional<Error>& failure);
  void refuse(Waiting& item, const Error& why);
  void answer(const Uuid& id, const Saved& saved, const Result<EditAnswer>& result);

  // A callback that, on the strand, gives its argument to `handler` and then steps.
  template <class Handler>
  auto then(Handler handler);

  Parts parts_;
  PipelineHost* host_;     // null when closed
  std::int64_t sequence_;  // of the last edit in the mirrors
  std::int64_t durable_;   // of the last edit in the journal
  std::deque<Waiting> waiting_;
  bool asking_ = false;  // a question to the journal is under way
  // the last one had no answer: the next does not wait for the database to come back
  bool journal_away_ = false;
  int in_flight_ = 0;  // strokes on the GPU
  bool busy_ = false;  // a computed edit, `when_idle` work or a repair is under way
  bool waits_for_map_ = false;
  bool paused_ = false;
  bool tell_paused_ = false;     // the host waits for `paused`
  std::optional<Error> closed_;  // the answer to later edits
  // nothing starts before the room was compared with the journal, which may hold more
  bool verify_ = false;
  // commits failed: everything pending is taken back once it is answered
  std::optional<Error> failure_;
  std::deque<Pending> pending_;  // sequence order
  std::map<LayerId, std::set<TileAddress>>
      stale_;  // by layer: where the GPU may hold something else than the mirror
  // The same of what waits for review. It is tried again with the next of the layer, and holds back
  // no edit.
  std::map<LayerId, std::set<TileAddress>> stale_marks_;
  boost::asio::steady_timer repair_timer_;
  bool repair_waits_ = false;  // for the timer
  // By layer: revisions since the last whole tile was stored, in this room.
  std::map<LayerId, std::unordered_map<TileAddress, int>> since_key_tile_;
  struct Running {
    std::string user;
    std::vector<Saved> followers;  // who repeated it
  };
  std::unordered_map<Uuid, Running> running_;  // waiting and pending edits
};

}  // namespace strata::room
