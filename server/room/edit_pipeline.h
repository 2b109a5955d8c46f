#pragma once

#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "room/layer_state.h"
#include "room/room.h"
#include "room/surface_maps.h"
#include "room/tile_changes.h"
#include "store/journal_writer.h"

namespace strata::room {

using Strand = boost::asio::strand<boost::asio::thread_pool::executor_type>;

// What the pipeline needs of its room. All calls are made on the strand.
class PipelineHost {
 public:
  virtual ~PipelineHost() = default;
  virtual LayerState* find_layer(std::int64_t id) = 0;
  virtual const Model& pipeline_model() const = 0;
  virtual void set_sequence(LayerState& layer, std::int64_t sequence) = 0;  // other threads may be reading it
  virtual void content_changed(const LayerState& layer, const std::optional<render::FrameRequest::Box>& box,
                               std::int64_t sequence) = 0;  // no box: everywhere
  virtual void edit_applied(const Listener::Edit& edit) = 0;
  virtual void edit_saved(const Listener::Edit& edit) = 0;
  virtual void edits_unsaved(const std::vector<Listener::Edit>& edits, const Problem& why) = 0;
  virtual void reload_from_store() = 0;  // the journal holds more than the room knows of
};

// The order of edits of one room. Strokes go to the GPU several at a time, in sequence order; edits that are computed from the
// tile mirror (fill, import, undo, restore) wait until the strokes before them are read back. What was read back
// is compared with the mirror once: that difference becomes the journal's revision, the counts and the change on screen.
// Lives on the room's strand: every method but `edit` is called there.
class EditPipeline : public std::enable_shared_from_this<EditPipeline> {
 public:
  struct Parts {
    store::Store& store;
    store::JournalWriter& writer;
    render::Renderer& renderer;
    boost::asio::thread_pool& workers;
    Strand strand;
    std::shared_ptr<SurfaceMaps> maps;
    std::size_t max_waiting;
  };
  EditPipeline(Parts parts, PipelineHost& host, std::int64_t last_sequence);

  void edit(EditRequest request, Room::Applied applied, Room::Saved saved);
  // Runs `work` when every edit before it is durable; nothing else runs meanwhile. `work` may block: it is on a worker.
  void when_idle(std::function<void()> work);

  std::int64_t sequence() const { return sequence_; }
  std::int64_t durable_sequence() const { return durable_; }
  bool idle() const { return waiting_.empty() && in_flight_ == 0 && pending_.empty() && !busy_; }

  void pause();                            // the GPU was lost: nothing is started
  void resume(std::int64_t last_sequence); // layers are back; continue after this sequence
  void close(const Problem& why);          // the host goes away: waiting edits are refused, later calls do nothing

 private:
  struct Waiting {
    EditRequest request;
    Room::Applied applied;
    Room::Saved saved;
    std::function<void()> work;  // when_idle
  };
  // Applied and on its way to the journal; what is needed to take it back.
  struct Pending {
    Listener::Edit event;
    std::vector<TileChange> changes;
    Room::Saved saved;
    bool answered = false;
  };
  struct Computed {
    std::vector<TileChange> changes;
    std::vector<std::int64_t> disable, enable;
  };

  bool repeat(const EditRequest& request, const Room::Applied& applied, Room::Saved& saved);
  void step();
  bool map_ready(int resolution);
  void start_stroke(Waiting item, const LayerState& layer);
  void stroke_done(Waiting& item, Result<render::StrokeOutcome> outcome);
  void start_computed(Waiting item, const LayerState& layer);
  void computed_done(Waiting& item, Result<Computed> computed);
  Result<Computed> compute(const EditRequest& request, const Layer& layer, const TileMap& tiles) const;
  Result<Computed> compute_undo(const EditRequest& request, const Layer& layer, const TileMap& tiles, bool redo) const;
  void commit(Waiting& item, LayerState& layer, Computed computed, const std::optional<render::FrameRequest::Box>& box);
  void on_saved(std::int64_t sequence, const Result<void>& result);
  void roll_back_when_answered();
  void refuse(Waiting& item, const Problem& why);
  void answer(const Uuid& id, const Room::Saved& saved, const Result<EditAnswer>& result);

  Parts parts_;
  PipelineHost* host_;
  std::int64_t sequence_;            // of the last edit in the mirrors
  std::int64_t durable_;             // of the last edit in the journal
  std::deque<Waiting> waiting_;
  int in_flight_ = 0;                // strokes on the GPU
  bool busy_ = false;                // a computed edit or `when_idle` work is under way
  bool waits_for_map_ = false;
  bool paused_ = false;
  bool closed_ = false;
  bool verify_ = false;              // after failed commits: compare with the journal before the next edit
  std::optional<Problem> failure_;   // commits failed: everything pending is taken back once it is answered
  std::deque<Pending> pending_;      // sequence order
  // By layer: revisions since the last whole tile was stored, in this room.
  std::map<std::int64_t, std::unordered_map<TileAddress, int>> since_key_tile_;
  std::unordered_map<Uuid, std::vector<Room::Saved>> running_;  // waiting and pending edits, with who repeated them
};

}  // namespace strata::room
