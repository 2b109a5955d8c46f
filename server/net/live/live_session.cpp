#include "net/live/live_session.h"

#include <algorithm>

#include "app/records/painted_keys.h"
#include "net/auth/auth.h"
#include "net/auth/kiosk_authorization.h"
#include "net/live/close_codes.h"
#include "net/live/live_sockets.h"
#include "net/serialization/edit_serialization.h"
#include "net/serialization/point_serialization.h"
#include "net/serialization/view_settings_serialization.h"
#include "protocol/problem.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/listener.h"
#include "room/participants.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/surface_images.h"
#include "store/journal/journal_reads.h"
#include "stream/viewer.h"

namespace strata::net {
namespace {

constexpr int kHistoryToSearch = 500;  // journal rows searched for the end of a stroke's batch

Error need_hello() {
  return {ErrorCode::conflict, "Missing hello message",
          "The first message of a connection must be `hello`.", "op"};
}

std::string ref_of(const std::optional<std::string>& id) { return id.value_or(std::string()); }

constexpr std::size_t kMaxEditorsSent = 1000;  // entries per message

std::vector<protocol::RecordEditors> editor_messages(
    const std::vector<app::RecordEditLocks::Entry>& entries) {
  std::vector<protocol::RecordEditors> messages;
  for (const auto& [record, editor] : entries) {
    if (messages.empty() || messages.back().records.size() == kMaxEditorsSent)
      messages.emplace_back();
    protocol::RecordEditor& entry = messages.back().records.emplace_back();
    entry.table = record.table.number();
    entry.key = record.key;
    if (!editor) continue;
    entry.session = editor->session;
    entry.user = editor->user;
  }
  return messages;
}

}  // namespace

std::string moved_message(const std::string& url) {
  protocol::Moved message;
  if (!url.empty()) message.url = url;
  return protocol::to_text(protocol::ServerMessage(message));
}

LiveSession::LiveSession(std::shared_ptr<const LiveShared> shared, std::shared_ptr<room::Room> room,
                         std::string project_slug, Principal principal, room::Portrait portrait,
                         std::optional<protocol::PersonalView> personal_view,
                         std::weak_ptr<LiveSocket> socket)
    : shared_(std::move(shared)),
      room_(std::move(room)),
      project_slug_(std::move(project_slug)),
      principal_(std::move(principal)),
      portrait_(std::move(portrait)),
      personal_view_(std::move(personal_view)),
      owner_{room_->model().id, principal_.user},
      socket_(std::move(socket)),
      bucket_(shared_->limits.messages_per_second, shared_->limits.burst) {}

LiveSession::~LiveSession() { on_closed(); }

LiveSession::Work LiveSession::on_text(const std::string& text) {
  ++shared_->metrics->messages_received;
  std::string ref;
  const bool in_time = bucket_.take();
  auto message = protocol::parse_client_message(text, &ref, {shared_->limits.message_bytes, 32});
  if (!in_time) {
    refuse({ErrorCode::too_many_requests,
            "Too many messages",
            "At most " + std::to_string(static_cast<int>(shared_->limits.messages_per_second)) +
                " messages per second are allowed. Send this message again later.",
            {}},
           ref);
    if (++refusals_ > shared_->limits.max_refusals)
      if (auto socket = socket_.lock()) socket->close(kClosePolicy, "too many messages");
    return {};
  }
  refusals_ = std::max(0, refusals_ - 1);
  if (!message) {
    refuse(message.error(), ref);
    return {};
  }
  if (!member() && !std::holds_alternative<protocol::Hello>(*message)) {
    refuse(need_hello(), ref);
    return {};
  }
  if (principal_.kiosk && !may_send_as_kiosk(*message)) {
    refuse({ErrorCode::forbidden, "Not allowed for kiosks",
            "A kiosk can only show a model. It cannot change anything.", "op"},
           ref);
    return {};
  }
  return std::visit(
      [this](const auto& each) -> Work {
        if constexpr (!std::is_void_v<decltype(on(each))>)
          return on(each);
        else
          on(each);
        return {};
      },
      *message);
}

void LiveSession::on_binary() {
  ++shared_->metrics->messages_received;
  refuse({ErrorCode::unsupported,
          "Binary message",
          "The server accepts only text messages. Send one JSON object in each message.",
          {}},
         std::string());
}

void LiveSession::on_closed() {
  std::shared_ptr<room::Participant> leaving;
  {
    std::lock_guard lock(mutex_);
    leaving = std::move(member_);
    pointer_.reset();
  }
  // Releases `mutex_` first. Notifications from other sessions lock it, and leaving the room waits
  // for the room's listeners.
  if (leaving) shared_->editors->leave(leaving->session(), tell_project());
}

void LiveSession::tell(const protocol::ServerMessage& message) {
  if (member()) send(message);
}

// --- messages from the client

void LiveSession::on(const protocol::Hello& message) {
  if (member())
    return refuse({ErrorCode::conflict, "Duplicate hello message",
                   "A connection can send `hello` only once.", "op"},
                  std::string());
  if (message.accept && std::none_of(message.accept->begin(), message.accept->end(),
                                     [](const auto& codec) { return codec == "jpeg"; }))
    return refuse({ErrorCode::not_acceptable, "No common picture format",
                   "The server can send pictures only as jpeg. Add jpeg to the formats.", "accept"},
                  std::string());

  std::shared_ptr<room::Participant> joined = room_->participants().join(
      author(), portrait_, this,
      [socket = socket_, metrics = shared_->metrics](const stream::FrameMessages& frame) {
        ++metrics->frames_sent;
        for (const stream::FrameBytes& part : frame) metrics->frame_bytes_sent += part->size();
        if (auto open = socket.lock())
          for (const stream::FrameBytes& part : frame) open->send_frame(part);
      });
  protocol::Welcome welcome;
  welcome.session = joined->session();
  welcome.user = principal_.user;
  welcome.role = static_cast<protocol::Role>(static_cast<int>(principal_.role));
  const Model model = room_->model();
  welcome.model = to_json(model, project_slug_);
  for (const auto& layer : room_->layers().all()) welcome.layers.push_back(to_json(layer));
  for (const auto& image : room_->surface_images().all()) welcome.looks.push_back(to_json(image));
  welcome.personal_view = personal_view_;
  const LiveLimits& limits = shared_->limits;
  welcome.limits.message_bytes = static_cast<int>(limits.message_bytes);
  welcome.limits.path_points = static_cast<int>(app::StrokeTracker::kMaxPath - 1);
  welcome.limits.view_size = kMaxViewSize;
  welcome.limits.views = limits.views;
  welcome.limits.frames_in_flight = stream::Viewer::Options{}.window;
  welcome.limits.messages_per_second = static_cast<int>(limits.messages_per_second);
  for (const auto& stroke : shared_->strokes->open_strokes(owner_))
    welcome.strokes.push_back({stroke.stroke, stroke.n});
  send(welcome);
  {
    std::lock_guard lock(mutex_);
    member_ = std::move(joined);
  }
  shared_->editors->list(
      project_id(), [this](ProjectId, const std::vector<app::RecordEditLocks::Entry>& entries) {
        for (const auto& each : editor_messages(entries)) send(each);
      });
  presence_changed();
}

void LiveSession::on(const protocol::CameraUpdate& message) {
  if (!has_view(message.view_id, std::string())) return;
  const Camera camera = protocol::camera_of(message);
  cameras_[message.view_id] = camera;
  member()->camera(static_cast<std::uint32_t>(message.view_id),
                   static_cast<std::uint64_t>(message.seq), camera, message.moving);
}

void LiveSession::on(const protocol::LayersUpdate& message) {
  if (!has_view(message.view_id, std::string())) return;
  auto settings = view_settings(*room_, message.layers, message.looks, message.light);
  if (!settings) return refuse(settings.error(), std::string());
  const auto background = background_of(message.background);
  if (!background) return refuse(background.error(), std::string());
  settings->background = *background;
  if (message.at) {
    if (principal_.kiosk)
      return refuse({ErrorCode::forbidden, "Not allowed for kiosks",
                     "A kiosk can only show the newest state of a model.", "at"},
                    std::string());
    if (const auto newest = room_->edits().durable_sequence(); *message.at > newest)
      return refuse(
          {ErrorCode::invalid, "Sequence out of range",
           "The newest durable edit of this model is " + std::to_string(newest) + ".", "at"},
          std::string());
    settings->at = *message.at;
  }
  if (auto done = member()->show(static_cast<std::uint32_t>(message.view_id), std::move(*settings));
      !done)
    return refuse(done.error(), std::string());
  if (message.view_id == 0) shows_past_ = message.at.has_value();
}

LiveSession::Work LiveSession::on(const protocol::StrokeBegin& message) {
  if (!may_paint(message.id)) return {};
  // Runs on a worker because the look-up of a tool or record may block.
  if (names_tool(message) || has_records(message.layer))
    return [self = shared_from_this(), message] { self->begin(message); };
  begin(message);
  return {};
}

void LiveSession::begin(const protocol::StrokeBegin& message) {
  auto layer = layer_of(message.layer);
  if (!layer) return refuse(layer.error(), message.id);
  auto tool = stroke_tool(message, *layer, room_->model(), shared_->find_tool);
  if (!tool) return refuse(tool.error(), message.id);
  if (layer->table && !tool->batch.erase)
    if (auto known = app::check_keys(*shared_->store, *layer, {tool->batch.value_bits}); !known)
      return refuse(known.error(), message.id);
  if (auto begun = shared_->strokes->begin(owner_, message.stroke, std::move(*tool)); !begun)
    refuse(begun.error(), message.id);
}

LiveSession::Work LiveSession::on(const protocol::StrokeExtend& message) {
  if (!may_paint(message.id)) return {};
  // Needed only after a restart of the server. The previous batch is then in the journal, and
  // reading the journal may block.
  if (shared_->strokes->lacks_start(owner_, message.stroke, message.n))
    return [self = shared_from_this(), message] {
      self->find_start(message);
      self->paint(message);
    };
  paint(message);
  return {};
}

void LiveSession::on(const protocol::StrokeEnd& message) {
  if (auto ended = shared_->strokes->end(owner_, message.stroke); !ended)
    refuse(ended.error(), message.id);
}

LiveSession::Work LiveSession::on(const protocol::EditRequest& message) {
  if (!may_paint(message.id)) return {};
  if (names_tool(message.edit) || has_records(message.layer))
    return [self = shared_from_this(), message] { self->edit(message); };
  edit(message);
  return {};
}

void LiveSession::edit(const protocol::EditRequest& message) {
  auto layer = layer_of(message.layer);
  if (!layer) return refuse(layer.error(), message.id);
  auto request =
      edit_request(message.edit, *layer, room_->model(), message.id, author(), shared_->find_tool);
  if (!request) return refuse(request.error(), message.id);
  if (layer->table)
    if (auto known = app::check_keys(*shared_->store, *layer, room::painted_by(*layer, *request));
        !known)
      return refuse(known.error(), message.id);
  request->trace = continued_trace(message.traceparent.value_or("")).trace;
  submit(std::move(*request), std::nullopt);
}

// Returns whether the values of the layer are keys of records.
bool LiveSession::has_records(const protocol::LayerRef& ref) const {
  const auto layer = layer_of(ref);
  return layer && layer->table;
}

template <class Message>
void LiveSession::step_through_history(const Message& message) {
  if (!may_paint(message.id)) return;
  auto layer = layer_of(message.layer);
  if (!layer) return refuse(layer.error(), message.id);
  room::EditRequest request{message.id, author(), layer->id};
  if constexpr (std::is_same_v<Message, protocol::Undo>)
    request.edit = room::UndoEdit{};
  else
    request.edit = room::RedoEdit{};
  request.record = {{"op", std::string(Message::kOp)}};
  request.trace = continued_trace(message.traceparent.value_or("")).trace;
  submit(std::move(request), std::nullopt);
}

void LiveSession::on(const protocol::Undo& message) { step_through_history(message); }
void LiveSession::on(const protocol::Redo& message) { step_through_history(message); }

// If another user already edits the record, the broadcast names that user.
LiveSession::Work LiveSession::on(const protocol::RecordEdit& message) {
  if (!may_edit(ref_of(message.id))) return {};
  // Runs on a worker because the look-up of the record blocks.
  if (message.editing) return [self = shared_from_this(), message] { self->edit_record(message); };
  shared_->editors->end({TableId(message.table), message.key}, member()->session(), tell_project());
  return {};
}

void LiveSession::edit_record(const protocol::RecordEdit& message) {
  const auto here = member();
  if (!here) return;
  const app::RecordEditLocks::Record record{TableId(message.table), message.key};
  auto begun = shared_->check_record(project_id(), record);
  if (begun)
    begun = shared_->editors->begin(project_id(), record, {here->session(), principal_.user},
                                    message.take_over, tell_project());
  if (!begun) refuse(begun.error(), ref_of(message.id));
}

void LiveSession::on(const protocol::Ack& message) {
  member()->ack(static_cast<std::uint32_t>(message.view_id),
                static_cast<std::uint64_t>(message.frame));
}

void LiveSession::on(const protocol::PresenceUpdate& message) {
  if (auto done = member()->look_together(message.leading, message.follow); !done)
    return refuse(done.error(), std::string());
  if (!message.pointer) {
    {
      std::lock_guard lock(mutex_);
      pointer_.reset();
    }
    return member()->pointer(std::nullopt);
  }
  auto camera = cameras_.find(message.view_id);
  if (camera == cameras_.end()) return;  // before the first frame, the pointer has no position
  {
    std::lock_guard lock(mutex_);
    pointer_ =
        Pointer{camera->second, {(*message.pointer)[0], (*message.pointer)[1]}, message.radius};
    if (std::exchange(pointer_busy_, true)) return;
  }
  if (!shared_->queries->post([self = shared_from_this()] { self->resolve_pointer(); })) {
    std::lock_guard lock(mutex_);
    pointer_busy_ = false;
  }
}

void LiveSession::on(const protocol::Pick& message) {
  std::optional<Camera> camera = message.camera;
  if (!camera)
    if (auto found = cameras_.find(message.view_id); found != cameras_.end())
      camera = found->second;
  if (!camera)
    return refuse({ErrorCode::conflict, "No camera",
                   "Send a camera for this view first, or send one with the pick.", "camera"},
                  ref_of(message.id));
  const bool posted =
      shared_->queries->post([self = shared_from_this(), message, camera = *camera] {
        std::vector<std::string> layers;
        for (const auto& layer : self->room_->layers().all()) layers.push_back(layer.slug);
        auto point = self->room_->queries().pick(camera, message.x, message.y, layers);
        if (!point) return self->refuse(point.error(), ref_of(message.id));
        self->send(to_picked(*point, message.id));
      });
  if (!posted)
    refuse({ErrorCode::busy,
            "Server is busy",
            "Too many queries are waiting. Try again in a moment.",
            {}},
           ref_of(message.id));
}

// --- edits

void LiveSession::paint(const protocol::StrokeExtend& message) {
  const std::vector<glm::dvec2> path(message.path.begin(), message.path.end());
  auto batch = shared_->strokes->extend(owner_, message.stroke, message.id, message.n, path,
                                        message.widths.value_or(std::vector<double>{}));
  if (!batch) return refuse(batch.error(), message.id);
  submit(batch_request(std::move(*batch), message.stroke, message.id, message.n, author()),
         BatchName{message.stroke, message.n});
}

void LiveSession::find_start(const protocol::StrokeExtend& message) {
  const auto tool = shared_->strokes->tool(owner_, message.stroke);
  if (!tool) return;
  auto page = shared_->store->journal().history(tool->layer_id, kHistoryToSearch, 0);
  // Without the journal, the stroke continues with a gap. The edit itself then reports that the
  // database is unreachable.
  if (!page) return;
  for (const auto& row : page->rows) {
    if (row.stroke != message.stroke || row.user != principal_.user || !row.record.is_object() ||
        row.record.value("n", -1) != message.n - 1)
      continue;
    // The list has no paths.
    const auto whole = shared_->store->journal().state(room_->model().id, {&row.id, 1});
    if (!whole || whole->known.empty()) return;
    if (auto end = end_of_path(whole->known.front().record))
      shared_->strokes->continue_from(owner_, message.stroke, message.n, *end);
    return;
  }
}

void LiveSession::submit(room::EditRequest request, std::optional<BatchName> batch) {
  const Uuid id = request.id;
  {
    std::lock_guard lock(mutex_);
    own_edits_.emplace(id, false);
  }
  if (const auto here = member()) here->edits();
  // Handles the result even if the connection is already closed, because the StrokeTracker outlives
  // the connection.
  room_->edits().submit(
      std::move(request),
      [weak = weak_from_this(), shared = shared_, id, batch](const room::EditAnswer& answer) {
        if (!answer.repeated) ++shared->metrics->edits.applied;
        if (auto self = weak.lock()) self->on_applied(id, batch, answer);
      },
      [weak = weak_from_this(), shared = shared_, owner = owner_, id,
       batch](Result<room::EditAnswer> answer) {
        if (answer && batch) shared->strokes->saved(owner, batch->stroke, batch->n);
        if (answer && !answer->repeated) ++shared->metrics->edits.saved;
        if (auto self = weak.lock()) self->on_saved(id, batch, answer);
      });
}

namespace {

template <class Message>
Message edit_message(const Uuid& id, bool is_batch, const Uuid& stroke, int n,
                     const room::EditAnswer& answer) {
  Message message;
  if (is_batch) {
    message.stroke = stroke;
    message.n = n;
  } else {
    message.id = id;
  }
  message.sequence = answer.sequence;
  message.texels_changed = static_cast<std::int64_t>(answer.texels_changed);
  message.area_m2 = answer.area_m2;
  if (answer.provisional) message.provisional = true;
  return message;
}

// Returns the protocol's event name for a change.
template <class Name>
Name named(room::Listener::LayerChange change) {
  switch (change) {
    case room::Listener::LayerChange::created: return Name::created;
    case room::Listener::LayerChange::changed: return Name::changed;
    case room::Listener::LayerChange::deleted: break;
  }
  return Name::deleted;
}

}  // namespace

void LiveSession::on_applied(const Uuid& id, const std::optional<BatchName>& batch,
                             const room::EditAnswer& answer) {
  {
    std::lock_guard lock(mutex_);
    if (auto found = own_edits_.find(id); found != own_edits_.end()) found->second = true;
    send_waiting_edits();
  }
  send(edit_message<protocol::Applied>(id, batch.has_value(), batch ? batch->stroke : Uuid{},
                                       batch ? batch->n : 0, answer));
}

void LiveSession::on_saved(const Uuid& id, const std::optional<BatchName>& batch,
                           const Result<room::EditAnswer>& answer) {
  bool applied = false;
  {
    std::lock_guard lock(mutex_);
    if (auto found = own_edits_.find(id); found != own_edits_.end()) {
      applied = found->second;
      own_edits_.erase(found);
    }
  }
  if (answer)
    return send(edit_message<protocol::Saved>(id, batch.has_value(), batch ? batch->stroke : Uuid{},
                                              batch ? batch->n : 0, *answer));
  // An edit is not counted as refused if another node has the model, because the client then sends
  // the edit to that node.
  if (!applied && answer.error().code != ErrorCode::moved) {
    ++shared_->metrics->edits.refused;
    return refuse(answer.error(), id);
  }
  ++shared_->metrics->edits.unsaved;
  protocol::Unsaved unsaved;
  unsaved.ids = {id};
  unsaved.detail = answer.error().detail;
  send(unsaved);
}

// --- room::Listener

void LiveSession::edit_applied(const Edit& edit) {
  {
    std::lock_guard lock(mutex_);
    if (own_edits_.contains(edit.id)) return;  // the author receives `applied` instead
  }
  protocol::LayerEvent event;
  event.event = protocol::LayerEventEvent::edited;
  event.layer_id = edit.layer_id.number();
  event.sequence = edit.sequence;
  event.user = edit.user;
  if (edit.answer.provisional) event.provisional = true;
  if (edit.review) {
    protocol::Reviewed& reviewed = event.review.emplace();
    reviewed.decision = static_cast<protocol::ReviewDecision>(edit.review->decision);
    reviewed.authors = edit.review->authors;
    if (!edit.review->reason.empty()) reviewed.reason = edit.review->reason;
  }
  const auto socket = socket_.lock();
  std::optional<EditEvents::Clock::duration> delay;
  {
    std::lock_guard lock(mutex_);
    if (edit.review || !socket) {  // each decision is a separate message
      send_waiting_edits();
      return send(event);
    }
    const bool are_few = people_sent_ <= shared_->limits.presence_people;
    delay = edit_events_.add(event, are_few ? std::chrono::milliseconds(0) : presence_pause(),
                             EditEvents::Clock::now());
  }
  if (!delay) return;
  if (*delay <= EditEvents::Clock::duration{}) return send_edits();
  socket->run_after(std::chrono::ceil<std::chrono::milliseconds>(*delay),
                    [weak = weak_from_this()] {
                      if (auto self = weak.lock()) self->send_edits();
                    });
}

void LiveSession::send_edits() {
  // Sends under the lock, so that a newer event of the layer cannot be sent first.
  std::lock_guard lock(mutex_);
  for (const auto& event : edit_events_.take(EditEvents::Clock::now())) send(event);
}

// Call with the lock, before a message that contains a newer state of a layer than the waiting
// events. So the sequences of a layer arrive in the order of its edits.
void LiveSession::send_waiting_edits() {
  for (const auto& event : edit_events_.take_before()) send(event);
}

void LiveSession::edits_unsaved(const std::vector<Edit>& edits, const Error&) {
  // Notifies other users of the restored layer. The authors get a response to each edit.
  std::map<LayerId, std::int64_t> sequences;
  for (const auto& edit : edits)
    sequences[edit.layer_id] = std::max(sequences[edit.layer_id], edit.sequence);
  std::lock_guard lock(mutex_);
  send_waiting_edits();
  for (const auto& [layer_id, sequence] : sequences) {
    protocol::LayerEvent event;
    event.event = protocol::LayerEventEvent::edited;
    event.layer_id = layer_id.number();
    event.sequence = sequence;
    send(event);
  }
}

void LiveSession::layer_changed(LayerChange change, const Layer& layer) {
  protocol::LayerEvent event;
  event.layer_id = layer.id.number();
  event.event = named<protocol::LayerEventEvent>(change);
  if (change != LayerChange::deleted) event.layer = to_json(layer);
  std::lock_guard lock(mutex_);
  send_waiting_edits();
  send(event);
}

void LiveSession::surface_image_changed(LayerChange change, const SurfaceImage& image) {
  protocol::LookEvent event;
  event.look_id = image.id.number();
  event.event = named<protocol::LookEventEvent>(change);
  if (change != LayerChange::deleted) event.look = to_json(image);
  send(event);
}

void LiveSession::model_changed(const Model& model) {
  protocol::ModelEvent event;
  event.event = protocol::ModelEventEvent::changed;
  event.model = to_json(model, project_slug_);
  send(event);
}

void LiveSession::model_deleted() {
  protocol::ModelEvent event;
  event.event = protocol::ModelEventEvent::deleted;
  send(event);
  if (auto socket = socket_.lock()) socket->close(kCloseGoingAway, "the model was deleted");
}

void LiveSession::moved(const std::string& url) {
  if (auto socket = socket_.lock()) {
    socket->send_text(moved_message(url));
    socket->close(kCloseMoved, "another node has the model");
  }
}

void LiveSession::database_reachable(bool reachable) {
  protocol::DatabaseState state;
  state.reachable = reachable;
  send(state);
}

void LiveSession::presence_changed() {
  auto socket = socket_.lock();
  if (!socket || principal_.kiosk) return;
  std::chrono::milliseconds delay{0};
  {
    std::lock_guard lock(mutex_);
    if (std::exchange(presence_scheduled_, true)) return;
    if (presence_sent_) {
      const auto due = *presence_sent_ + presence_pause();
      delay = std::max(delay, std::chrono::ceil<std::chrono::milliseconds>(
                                  due - std::chrono::steady_clock::now()));
    }
  }
  socket->run_after(delay, [weak = weak_from_this()] {
    if (auto self = weak.lock()) self->send_presence();
  });
}

// Returns the time between two presence messages. Call with the lock.
std::chrono::milliseconds LiveSession::presence_pause() const {
  const LiveLimits& limits = shared_->limits;
  return limits.presence_every * std::max(people_sent_, limits.presence_people) /
         limits.presence_people;
}

void LiveSession::view_refused(std::uint32_t view_id, const Error& why) {
  Error problem = why;
  problem.detail = "View " + std::to_string(view_id) + " cannot be drawn: " + why.detail;
  refuse(problem, std::string());
}

void LiveSession::send_presence() {
  Uuid own;
  {
    std::lock_guard lock(mutex_);
    presence_scheduled_ = false;
    presence_sent_ = std::chrono::steady_clock::now();
    if (!member_) return;
    own = member_->session();
  }
  protocol::Presence presence;
  for (auto& person : room_->participants().presence(own)) {
    if (is_kiosk_name(person.user)) continue;  // a kiosk is not a user
    protocol::PresenceUser user;
    user.session = person.session;
    user.name = std::move(person.user);
    if (!person.full_name.empty()) user.full_name = std::move(person.full_name);
    user.color = std::move(person.color);
    if (person.pointer) {
      protocol::PresencePointer pointer;
      pointer.position = person.pointer->position;
      pointer.radius = person.pointer->radius;
      user.pointer = pointer;
    }
    user.leading = person.leading;
    user.following = person.following;
    user.camera = std::move(person.camera);
    presence.users.push_back(std::move(user));
  }
  {
    std::lock_guard lock(mutex_);
    people_sent_ = static_cast<int>(presence.users.size());
  }
  send(presence);
}

void LiveSession::resolve_pointer() {
  for (;;) {
    Pointer pointer;
    std::shared_ptr<room::Participant> here;
    {
      std::lock_guard lock(mutex_);
      if (!pointer_ || !member_) {
        pointer_busy_ = false;
        return;
      }
      pointer = *std::exchange(pointer_, std::nullopt);
      here = member_;
    }
    // Finds only the position, without layer values.
    auto point = room_->queries().pick(pointer.camera, pointer.pixel.x, pointer.pixel.y, {});
    here->pointer(point && point->hit
                      ? std::optional(room::Pointing{point->position, pointer.radius})
                      : std::nullopt);
  }
}

// --- helpers

bool LiveSession::may_edit(const std::string& ref) {
  if (principal_.role >= Role::annotator) return true;
  refuse({ErrorCode::forbidden,
          "Not allowed",
          "Your role is viewer, so you cannot paint. Ask an administrator for the role annotator.",
          {}},
         ref);
  return false;
}

bool LiveSession::may_paint(const Uuid& id) {
  if (!may_edit(id)) return false;
  if (!shows_past_) return true;
  refuse({ErrorCode::conflict,
          "Earlier state shown",
          "You are viewing an earlier state, so you cannot paint. Go back to the current state "
          "first.",
          {}},
         id);
  return false;
}

app::RecordEditLocks::Tell LiveSession::tell_project() const {
  return [sockets = shared_->sockets](ProjectId project_id,
                                      const std::vector<app::RecordEditLocks::Entry>& entries) {
    for (const auto& message : editor_messages(entries)) sockets->tell_project(project_id, message);
  };
}

bool LiveSession::has_view(int view_id, const std::string& ref) {
  if (view_id < shared_->limits.views) return true;
  refuse({ErrorCode::invalid, "Too many views",
          "A connection can have the views 0 to " + std::to_string(shared_->limits.views - 1) + ".",
          "view_id"},
         ref);
  return false;
}

Result<Layer> LiveSession::layer_of(const protocol::LayerRef& ref) const {
  auto layer = room_->layers().find(protocol::to_ref(ref));
  if (layer) return layer;
  Error problem = layer.error();
  if (problem.field.empty()) problem.field = "layer";
  return tl::unexpected(std::move(problem));
}

std::shared_ptr<room::Participant> LiveSession::member() const {
  std::lock_guard lock(mutex_);
  return member_;
}

void LiveSession::send(const protocol::ServerMessage& message) {
  if (principal_.kiosk) {
    const auto filtered = filtered_for_kiosk(message);
    if (auto socket = socket_.lock(); socket && filtered)
      socket->send_text(protocol::to_text(*filtered));
    return;
  }
  if (auto socket = socket_.lock()) socket->send_text(protocol::to_text(message));
}

void LiveSession::refuse(const Error& problem, const std::string& ref) {
  shared_->metrics->count_problem(problem.code);
  ++shared_->metrics->messages_refused;
  send(protocol::problem_message(problem, ref));
}

}  // namespace strata::net
