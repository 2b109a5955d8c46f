#pragma once

#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

#include "app/strokes/brush_shape_cache.h"
#include "app/strokes/record_edit_locks.h"
#include "app/strokes/stroke_tracker.h"
#include "core/ids.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "domain/scene/surface_image.h"
#include "domain/tables/table.h"
#include "net/api/metrics.h"
#include "net/http/http_types.h"
#include "net/http/token_bucket.h"
#include "net/http/worker_pool.h"
#include "net/live/edit_events.h"
#include "net/live/live_limits.h"
#include "protocol/messages.h"
#include "protocol/parse.h"
#include "room/edit.h"
#include "room/listener.h"
#include "room/participants.h"
#include "room/room.h"
#include "store/store.h"

namespace strata::net {

// The interface of a connection for a session. Thread-safe and never blocks. Closes the connection
// if messages are queued faster than the client reads them.
class LiveSocket {
 public:
  virtual ~LiveSocket() = default;
  virtual void send_text(std::string text) = 0;
  virtual void send_frame(stream::FrameBytes frame) = 0;
  virtual void close(int code, std::string reason) = 0;
  // Runs `work` on the strand of the socket.
  virtual void run_after(std::chrono::milliseconds delay, std::function<void()> work) = 0;
};

class LiveSockets;

// Returns 404 (field `table` or `key`) if the project does not have the record. May block.
using CheckRecord =
    std::function<Result<void>(ProjectId project_id, const app::RecordEditLocks::Record& record)>;

// Objects that all sessions share. The callbacks passed to rooms keep them alive.
struct LiveShared {
  std::shared_ptr<Metrics> metrics;
  std::shared_ptr<app::StrokeTracker> strokes;
  std::shared_ptr<WorkerPool> queries;  // for picks, because the first pick may be slow
  std::shared_ptr<LiveSockets> sockets;
  std::shared_ptr<app::RecordEditLocks> editors;
  store::Store* store = nullptr;
  app::FindTool find_tool;
  CheckRecord check_record;
  LiveLimits limits;
};

// Returns the text of the message `moved`. `url` is the address of the node that has the model, or
// empty if it is not known.
std::string moved_message(const std::string& url);

// The session of one user in one model. Implements the subprotocol strata.v1 (see
// protocol/messages). Call `on_text` and `on_closed` on the strand of the socket. The room calls
// the Listener functions on its own strand.
class LiveSession final : public room::Listener, public std::enable_shared_from_this<LiveSession> {
 public:
  // `personal_view` contains the user's stored layer settings (net/api/models/personal_view.h).
  LiveSession(std::shared_ptr<const LiveShared> shared, std::shared_ptr<room::Room> room,
              std::string project_slug, Principal principal, room::Portrait portrait,
              std::optional<protocol::PersonalView> personal_view,
              std::weak_ptr<LiveSocket> socket);
  ~LiveSession() override;

  // Run the returned work on a worker, and finish it before you pass the next message.
  using Work = std::function<void()>;
  Work on_text(const std::string& text);
  void on_binary();
  void on_closed();
  ModelId model_id() const { return owner_.model_id; }
  // Returns the project of the model. Any thread.
  ProjectId project_id() const { return room_->model().project_id; }
  const std::string& user() const { return principal_.user; }
  Role role() const { return principal_.role; }  // the user's role in the project
  // Sends a message about the site or the project, if the client has sent `hello`. Any thread.
  void tell(const protocol::ServerMessage& message);

  // --- room::Listener
  void edit_applied(const Edit& edit) override;
  void edits_unsaved(const std::vector<Edit>& edits, const Error& why) override;
  void layer_changed(LayerChange change, const Layer& layer) override;
  void model_changed(const Model& model) override;
  void surface_image_changed(LayerChange change, const SurfaceImage& image) override;
  void model_deleted() override;
  void moved(const std::string& url) override;
  void database_reachable(bool reachable) override;
  void presence_changed() override;
  void view_refused(std::uint32_t view_id, const Error& why) override;

 private:
  struct BatchName {
    Uuid stroke;
    int n = 0;
  };
  void on(const protocol::Hello& message);
  void on(const protocol::CameraUpdate& message);
  void on(const protocol::LayersUpdate& message);
  Work on(const protocol::StrokeBegin& message);
  Work on(const protocol::StrokeExtend& message);
  void on(const protocol::StrokeEnd& message);
  Work on(const protocol::EditRequest& message);
  void on(const protocol::Undo& message);
  void on(const protocol::Redo& message);
  Work on(const protocol::RecordEdit& message);
  void on(const protocol::Ack& message);
  void on(const protocol::PresenceUpdate& message);
  void on(const protocol::Pick& message);

  void begin(const protocol::StrokeBegin& message);
  void edit(const protocol::EditRequest& message);
  void edit_record(const protocol::RecordEdit& message);
  void paint(const protocol::StrokeExtend& message);
  void find_start(const protocol::StrokeExtend& message);
  template <class Message>
  void step_through_history(const Message& message);
  void submit(room::EditRequest request, std::optional<BatchName> batch);
  void on_applied(const Uuid& id, const std::optional<BatchName>& batch,
                  const room::EditAnswer& answer);
  void on_saved(const Uuid& id, const std::optional<BatchName>& batch,
                const Result<room::EditAnswer>& answer);
  Author author() const { return {principal_.user, principal_.role}; }
  app::RecordEditLocks::Tell tell_project() const;
  bool may_edit(const std::string& ref);
  bool may_edit(const Uuid& id) { return may_edit(to_string(id)); }
  bool may_paint(const Uuid& id);
  bool has_view(int view_id, const std::string& ref);
  Result<Layer> layer_of(const protocol::LayerRef& ref) const;
  bool has_records(const protocol::LayerRef& ref) const;
  std::shared_ptr<room::Participant> member() const;
  void resolve_pointer();
  std::chrono::milliseconds presence_pause() const;
  void send_presence();
  void send_edits();
  void send_waiting_edits();
  void send(const protocol::ServerMessage& message);
  void refuse(const Error& problem, const std::string& ref);
  void refuse(const Error& problem, const Uuid& id) { refuse(problem, to_string(id)); }

  const std::shared_ptr<const LiveShared> shared_;
  const std::shared_ptr<room::Room> room_;
  const std::string project_slug_;
  const Principal principal_;
  const room::Portrait portrait_;
  const std::optional<protocol::PersonalView> personal_view_;
  const app::StrokeTracker::Owner owner_;
  const std::weak_ptr<LiveSocket> socket_;

  // Used only on the strand of the socket.
  TokenBucket bucket_;
  int refusals_ = 0;
  std::map<int, Camera> cameras_;
  bool shows_past_ = false;  // whether view 0 shows a past state

  mutable std::mutex mutex_;
  std::shared_ptr<room::Participant> member_;
  std::unordered_map<Uuid, bool> own_edits_;  // edits that are not yet durable; true: applied
  bool presence_scheduled_ = false;
  std::optional<std::chrono::steady_clock::time_point> presence_sent_;
  int people_sent_ = 0;  // number of users in the last presence message
  EditEvents edit_events_;
  struct Pointer {
    Camera camera;
    glm::dvec2 pixel;
    std::optional<double> radius;
  };
  std::optional<Pointer> pointer_;
  bool pointer_busy_ = false;
};

}  // namespace strata::net
