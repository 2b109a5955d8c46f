#include "room/open/open_participant.h"

#include "room/limits.h"
#include "room/open/open_participants.h"
#include "room/open/open_room.h"
#include "room/pipeline/provisional.h"

namespace strata::room {

OpenParticipant::OpenParticipant(std::shared_ptr<OpenRoom> room, Author who, Portrait portrait,
                                 Listener* listener, stream::SendFrames send)
    : room_(std::move(room)),
      who_(std::move(who)),
      portrait_(std::move(portrait)),
      listener_(listener),
      send_(std::move(send)) {}

OpenParticipant::~OpenParticipant() {
  room_->people().leave(this);
  for (auto& [id, view] : views_) view.viewer->close();
}

void OpenParticipant::tell_moved(const std::string& url) {
  if (listener_ && !std::exchange(told_moved_, true)) listener_->moved(url);
}

OpenParticipant::View* OpenParticipant::view(std::uint32_t view_id, bool make) {
  auto found = views_.find(view_id);
  if (found != views_.end()) return &found->second;
  if (!make || views_.size() >= static_cast<std::size_t>(kMaxViews)) return nullptr;
  View& made = views_[view_id];
  stream::Viewer::Options options;
  options.view_id = view_id;
  options.sequence = room_->edits().sequence();
  made.viewer = stream::Viewer::create(room_->stream_context(), room_->model_handle(), options,
                                       send_, [listener = listener_, view_id](const Error& why) {
                                         if (listener) listener->view_refused(view_id, why);
                                       });
  restyle(view_id, made);
  return &made;
}

OpenParticipant::Appearance OpenParticipant::appearance(std::uint32_t view_id, View& view) const {
  Appearance appearance;
  render::ViewStyle& style = appearance.style;
  style.images = room_->surface_image_cache().styles(view.images);
  style.light = view.light;
  style.contact_shadow = room_->contact_shadow(view.light);
  style.background = view.background;
  style.unit_mm = room_->model().metres() * 1000;
  std::vector<LayerFeatures> marked;
  const LayerView none;
  const auto mine = [&](LayerId id) -> const LayerView& {
    const auto own = view.overrides.find(id);
    return own == view.overrides.end() ? none : own->second;
  };
  std::vector<LayerState> states = room_->layer_states();
  std::erase_if(states, [&](const LayerState& state) {
    return !sees(role(), state.layer.visibility) ||
           !mine(state.layer.id).visible.value_or(state.layer.visible);
  });
  sort_as_shown(states, [&](LayerId id) { return &mine(id); });
  const auto past = moment(view_id, view, states);
  if (past) appearance.at = past->sequence;
  for (const auto& state : states) {
    render::LayerStyle shown{
        state.handles.content, palette(view_id, view, state),
        static_cast<float>(mine(state.layer.id).opacity.value_or(state.layer.opacity)),
        state.layer.blend};
    if (past) {
      const auto then = past->layers.find(state.layer.id);
      if (then == past->layers.end()) continue;  // its past state is being read
      shown.layer = then->second->handle;
    }
    add_styles(shown, past ? std::nullopt : state.waiting(), style.layers);
    if (!state.layer.table) continue;
    RecordFeatures::SurfaceFeatures features;
    if (!past) {
      features = room_->record_features().find(*state.layer.table, sight_of(role()));
    } else if (const auto then = past->features.find(*state.layer.table);
               then != past->features.end()) {
      features = then->second;
    }
    if (features) marked.push_back({std::move(features), shown.palette, shown.opacity});
  }
  if (marked != view.marked) {
    view.features = room_->record_features().shown(marked);
    view.marked = std::move(marked);
  }
  style.features = view.features;
  return appearance;
}

std::shared_ptr<const PastMoment> OpenParticipant::moment(
    std::uint32_t view_id, View& view, const std::vector<LayerState>& shown) const {
  if (!view.at) return nullptr;
  PastLayers::Request request{*view.at, {}, sight_of(role())};
  for (const LayerState& state : shown) request.layers.push_back(state.layer);
  const auto found = room_->past_layers().find(view.past, request);
  if (found.problem && view.reported.insert(found.problem).second && listener_)
    listener_->view_refused(view_id, *found.problem);
  return found.moment;
}

void OpenParticipant::restyle(std::uint32_t view_id, View& view) const {
  auto [style, at] = appearance(view_id, view);
  view.viewer->set_style(std::move(style), at);
}

std::shared_ptr<const Palette> OpenParticipant::palette(std::uint32_t view_id, View& view,
                                                        const LayerState& state) const {
  static const auto kUncolored = std::make_shared<const Palette>(
      Palette{PaletteMode::categorical, 0, 1, {}, {}, kNoValueColor});
  const LayerId id = state.layer.id;
  const auto own = view.palettes.find(id);
  const auto& palette = own == view.palettes.end() ? state.palette : own->second;
  const auto entry = view.highlights.find(id);
  const auto highlight = entry == view.highlights.end() ? nullptr : entry->second;
  if (!state.layer.table || !RecordColors::needs_records(*palette, highlight)) {
    view.by_record.erase(id);
    return palette;
  }
  const auto found =
      room_->record_colors().find({*state.layer.table, sight_of(role()), palette, highlight});
  if (found.problem && view.reported.insert(found.problem).second && listener_)
    listener_->view_refused(view_id, *found.problem);
  if (found.palette) view.by_record[id] = found.palette;
  if (const auto last = view.by_record.find(id); last != view.by_record.end()) return last->second;
  return palette->column.empty() ? palette : kUncolored;
}

void OpenParticipant::camera(std::uint32_t view_id, std::uint64_t seq, const Camera& camera,
                             bool moving) {
  {
    std::lock_guard lock(mutex_);
    if (View* v = view(view_id, true)) v->viewer->set_camera(seq, camera, moving);
    if (view_id != 0) return;
    camera_ = camera;
    camera_->section.clear();
    camera_->hidden_parts.reset();
  }
  room_->people().camera_moved(session_);
}

Result<void> OpenParticipant::show(std::uint32_t view_id, ViewSettings settings) {
  std::lock_guard lock(mutex_);
  View* v = view(view_id, true);
  if (!v)
    return fail(ErrorCode::invalid, "Too many views",
                "One connection can have at most " + std::to_string(kMaxViews) + " views.",
                "view_id");
  v->overrides.clear();
  v->palettes.clear();
  const auto before = std::exchange(v->highlights, {});
  v->reported.clear();
  v->images = std::move(settings.images);
  v->light = settings.light;
  v->background = settings.background;
  for (auto& own : settings.layers) {
    if (own.palette) v->palettes[own.layer_id] = std::make_shared<const Palette>(*own.palette);
    if (own.highlight) {
      // An unchanged highlight keeps its object, so its records are not searched again.
      const auto known = before.find(own.layer_id);
      v->highlights[own.layer_id] =
          known != before.end() && *known->second == *own.highlight
              ? known->second
              : std::make_shared<const Highlight>(std::move(*own.highlight));
    }
    v->overrides[own.layer_id] = std::move(own);
  }
  const bool returns = v->at && !settings.at;
  v->at = settings.at;
  if (!v->at)
    v->past = nullptr;
  else if (!v->past)
    v->past = room_->past_layers().new_place();
  restyle(view_id, *v);
  // The view did not receive edits while it showed an earlier state.
  if (returns) v->viewer->changed_everywhere(room_->edits().sequence());
  return {};
}

void OpenParticipant::ack(std::uint32_t view_id, std::uint64_t frame) {
  std::lock_guard lock(mutex_);
  if (View* v = view(view_id, false)) v->viewer->ack(frame);
}

void OpenParticipant::edits() {
  last_edit_ = Clock::now();
  std::lock_guard lock(mutex_);
  for (auto& [id, view] : views_) view.viewer->acts();
}

void OpenParticipant::pointer(std::optional<Pointing> at) {
  {
    std::lock_guard lock(mutex_);
    pointer_ = at;
  }
  room_->people().announce_presence();
}

Result<void> OpenParticipant::look_together(bool leading, const std::optional<Uuid>& follow) {
  STRATA_TRY(room_->people().follow(session_, follow));
  {
    std::lock_guard lock(mutex_);
    if (std::exchange(leading_, leading) == leading) return {};
  }
  room_->people().announce_presence();
  return {};
}

Presence OpenParticipant::presence() const {
  std::lock_guard lock(mutex_);
  return {session_, who_.user, portrait_.full_name, portrait_.color,
          pointer_, leading_,  std::nullopt,        camera_};
}

void OpenParticipant::content_changed(const Layer& layer,
                                      const std::optional<render::FrameRequest::Box>& box,
                                      std::int64_t sequence) {
  if (!sees(role(), layer.visibility)) return;
  std::lock_guard lock(mutex_);
  for (auto& [id, view] : views_) {
    if (view.at) continue;
    auto own = view.overrides.find(layer.id);
    const bool shown =
        own != view.overrides.end() && own->second.visible ? *own->second.visible : layer.visible;
    if (!shown) continue;
    box ? view.viewer->changed(*box, sequence) : view.viewer->changed_everywhere(sequence);
  }
}

void OpenParticipant::styles_changed() {
  std::lock_guard lock(mutex_);
  for (auto& [id, view] : views_) restyle(id, view);
}

void OpenParticipant::model_changed(render::ModelHandle model) {
  std::lock_guard lock(mutex_);
  for (auto& [id, view] : views_) {
    auto [style, at] = appearance(id, view);
    view.viewer->reset_model(model, std::move(style), at);
  }
}

}  // namespace strata::room
