#include "stream/viewer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>

#include "core/log.h"
#include "protocol/frame_header.h"
#include "stream/link_pace.h"
#include "stream/timer_thread.h"

namespace strata::stream {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// The full-quality frame follows within 250 ms of the last input.
constexpr auto kQuietAfter = 200ms;
constexpr auto kActsFor = 2s;
// The refinement waits longer after an edit, because users pause between strokes.
constexpr std::chrono::milliseconds kRestAfterCamera{700}, kRestAfterChange{2000};
constexpr auto kRefinementTime = 2s;  // with a software renderer
constexpr auto kFirstRetry = 50ms;
constexpr auto kLastRetry = 5000ms;

// Full quality includes full color. With 4:2:0, thin colored lines of a layer would be blurred, and
// redrawn parts would be visible as patches.
constexpr JpegSettings kStillPicture{90, true};

bool is_superseded(const Error& problem) { return problem.code == ErrorCode::superseded; }
// Returns whether the request itself is invalid. The same request would then fail again.
bool is_refusal(const Error& problem) { return problem.code == ErrorCode::invalid; }

}  // namespace

struct Viewer::Impl {
  Impl(StreamContext stream, Options o, Send s, Refused r)
      : context(stream),
        options(o),
        send(std::move(s)),
        refused(std::move(r)),
        flow(o.window, o.sequence, stream.samples_at_rest),
        draw_pace(o.longest_draw) {
    adapt_window();
  }

  void rest_after(std::chrono::milliseconds pause) {
    rests_at = std::max(rests_at, Clock::now() + pause);
  }

  void adapt_window() { flow.set_window(options.window > 0 ? options.window : link.window()); }

  // A drawn frame that waits for the encoder.
  struct Picture {
    FlowControl::Draw draw;
    FlowControl::Numbered number;
    JpegSettings jpeg;
    render::SharedFrame frame;
  };

  const StreamContext context;
  const Options options;

  // Held while `send` or `refused` runs, so `close` waits for these calls. Locked before `mutex`.
  std::recursive_mutex send_mutex;
  Send send;
  Refused refused;
  // The Error's detail in the last call of `refused` since the last frame. Guarded by `send_mutex`.
  std::string last_reported;

  mutable std::mutex mutex;
  FlowControl flow;
  LinkPace link;
  DrawPace draw_pace;
  MovingPicture moving;              // settings of the last whole frame of a moving camera
  Clock::time_point requested_at{};  // time of the last request of a draw
  render::ViewStyle style;
  render::ModelHandle model = 0;
  render::ViewHandle view = 0;
  std::uint64_t generation = 0;  // of `view`; replies for older generations are ignored
  // Drawn frames in their order, at most `window`. If `encoding` is true, the first one is being
  // encoded.
  std::deque<Picture> drawn;
  bool encoding = false;
  bool closed = false;
  Clock::time_point last_camera{};  // when the newest camera arrived
  Clock::time_point last_act{};     // when the newest camera or edit arrived
  Clock::time_point rests_at{};     // time of the refinement if nothing changes before
  bool quiet_timer_runs = false, rest_timer_runs = false;
  bool waits_as_onlooker = false;  // the requested draw has the turn of an onlooker
  std::chrono::milliseconds retry_in = kFirstRetry;
  Stats stats;
};

namespace {

// Returns the largest size within the limits that has the window's aspect ratio, multiplied by
// `reduced`.
std::pair<int, int> picture_size(const Camera& camera, const Viewer::Options& options,
                                 double reduced) {
  const double scale = reduced * std::min({1.0, double(options.max_width) / camera.width,
                                           double(options.max_height) / camera.height});
  return {std::max(1, int(std::lround(camera.width * scale))),
          std::max(1, int(std::lround(camera.height * scale)))};
}

std::uint32_t microseconds(double ms) {
  return static_cast<std::uint32_t>(std::clamp(ms * 1000.0, 0.0, 4e9));
}

FrameMessages frame_messages(const FlowControl::Draw& draw, const FlowControl::Numbered& number,
                             const render::Frame& frame, std::uint32_t view_id,
                             const std::vector<std::vector<std::uint8_t>>& jpegs,
                             double encode_ms) {
  protocol::FrameHeader header;
  header.still = number.still;
  header.view_id = view_id;
  header.frame = static_cast<std::uint32_t>(number.frame);
  header.camera_seq = draw.camera_seq;
  header.scene_sequence = static_cast<std::uint64_t>(number.sequence);
  header.full_width = static_cast<std::uint32_t>(frame.width);
  header.full_height = static_cast<std::uint32_t>(frame.height);
  header.render_us = microseconds(frame.render_ms);
  header.encode_us = microseconds(encode_ms);
  FrameMessages messages;
  for (std::size_t i = 0; i < jpegs.size(); ++i) {
    const render::PixelRect& rect = frame.rects[i];
    header.keyframe = rect == render::PixelRect{0, 0, frame.width, frame.height};
    header.last = i + 1 == jpegs.size();
    header.x = static_cast<std::uint32_t>(rect.x);
    header.y = static_cast<std::uint32_t>(rect.y);
    header.width = static_cast<std::uint32_t>(rect.width);
    header.height = static_cast<std::uint32_t>(rect.height);
    header.payload_bytes = static_cast<std::uint32_t>(jpegs[i].size());
    const auto head = protocol::encode_frame_header(header);
    auto message = std::make_shared<std::vector<std::uint8_t>>(head.size() + jpegs[i].size());
    std::copy(jpegs[i].begin(), jpegs[i].end(),
              std::copy(head.begin(), head.end(), message->begin()));
    messages.push_back(std::move(message));
  }
  return messages;
}

}  // namespace

Viewer::Viewer() = default;

std::shared_ptr<Viewer> Viewer::create(StreamContext context, render::ModelHandle model,
                                       Options options, Send send, Refused refused) {
  std::shared_ptr<Viewer> viewer(new Viewer());
  viewer->impl_ = std::make_unique<Impl>(context, options, std::move(send), std::move(refused));
  viewer->impl_->model = model;
  viewer->add_view();
  return viewer;
}

Viewer::~Viewer() { close(); }

void Viewer::close() {
  std::lock_guard sending(impl_->send_mutex);
  std::lock_guard lock(impl_->mutex);
  if (impl_->closed) return;
  impl_->closed = true;
  impl_->drawn.clear();
  if (impl_->view != 0) impl_->context.renderer->remove_view(impl_->view);
}

void Viewer::add_view() {
  render::ModelHandle model;
  std::uint64_t generation;
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->closed) return;
    model = impl_->model;
    generation = ++impl_->generation;
  }
  auto* renderer = impl_->context.renderer;
  renderer->add_view(
      model, [self = weak_from_this(), renderer, generation](Result<render::ViewHandle> view) {
        auto viewer = self.lock();
        const bool is_needed = viewer && viewer->on_view(generation, view);
        if (!is_needed && view) renderer->remove_view(*view);
      });
}

bool Viewer::on_view(std::uint64_t generation, const Result<render::ViewHandle>& view) {
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->closed || generation != impl_->generation) return false;
    if (view) {
      impl_->view = *view;
      impl_->retry_in = kFirstRetry;
      impl_->flow.on_ready();
    }
  }
  if (view) {
    step();
    wait_for_rest();
  } else {
    retry_later([generation](Viewer& viewer) {
      {
        std::lock_guard lock(viewer.impl_->mutex);
        if (generation != viewer.impl_->generation) return;
      }
      viewer.add_view();
    });
  }
  return true;
}

// Calls `action` after a pause. The pause doubles each time until a success resets it.
void Viewer::retry_later(std::function<void(Viewer&)> action) {
  std::chrono::milliseconds pause;
  {
    std::lock_guard lock(impl_->mutex);
    pause = impl_->retry_in;
    impl_->retry_in = std::min<std::chrono::milliseconds>(2 * pause, kLastRetry);
  }
  TimerThread::shared().after(pause, [self = weak_from_this(), action = std::move(action)] {
    if (auto viewer = self.lock()) action(*viewer);
  });
}

void Viewer::set_camera(std::uint64_t camera_seq, const Camera& camera, bool moving) {
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->closed) return;
    impl_->flow.on_camera(camera_seq, camera, moving);
    impl_->last_camera = impl_->last_act = Clock::now();
    impl_->rest_after(kRestAfterCamera);
  }
  leave_onlookers();
  if (moving) wait_for_quiet();
  step();
  wait_for_rest();
}

// Runs one timer per viewer. If cameras arrived after its start, the timer fires too early and is
// set again for the remaining time.
void Viewer::wait_for_quiet() {
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->quiet_timer_runs || impl_->closed || !impl_->flow.wants_quiet_timer()) return;
    if (waits_until(impl_->last_camera + kQuietAfter, &Impl::quiet_timer_runs,
                    &Viewer::wait_for_quiet))
      return;
    impl_->flow.on_quiet();
  }
  step();
}

void Viewer::wait_for_rest() {
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->rest_timer_runs || impl_->closed || !impl_->flow.wants_rest_timer()) return;
    if (waits_until(impl_->rests_at, &Impl::rest_timer_runs, &Viewer::wait_for_rest)) return;
    // Over a slow link, the frame of the next camera would wait for the refined frame.
    if (impl_->link.has_room()) impl_->flow.on_rest();
  }
  step();
}

// Sets a timer that calls `then`, unless `time` has passed. Requires the lock.
bool Viewer::waits_until(std::chrono::steady_clock::time_point time, bool Impl::*timer_runs,
                         void (Viewer::*then)()) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(time - Clock::now());
  if (left <= 0ms) return false;
  impl_.get()->*timer_runs = true;
  TimerThread::shared().after(left, [self = weak_from_this(), timer_runs, then] {
    auto viewer = self.lock();
    if (!viewer) return;
    {
      std::lock_guard lock(viewer->impl_->mutex);
      viewer->impl_.get()->*timer_runs = false;
    }
    (viewer.get()->*then)();
  });
  return true;
}

void Viewer::acts() {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->last_act = Clock::now();
  }
  leave_onlookers();
}

// A view has one request at a time. If it waits among many onlookers, the first picture of the
// user's own stroke or camera would wait for all of them.
void Viewer::leave_onlookers() {
  render::ViewHandle view = 0;
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->closed || !impl_->waits_as_onlooker) return;
    view = impl_->view;
  }
  impl_->context.renderer->view_acts(view);
}

void Viewer::set_style(render::ViewStyle style, std::optional<std::int64_t> past) {
  {
    std::lock_guard lock(impl_->mutex);
    const bool moves = impl_->flow.on_past(past);
    // Nothing changed in this view, only in the styles of other views.
    if (style == impl_->style && !moves) return;
    impl_->style = std::move(style);
    impl_->rest_after(kRestAfterCamera);
    impl_->flow.on_style();
  }
  step();
  wait_for_rest();
}

void Viewer::changed(const render::FrameRequest::Box& box, std::int64_t sequence) {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->rest_after(kRestAfterChange);
    impl_->flow.on_change(box, sequence);
  }
  step();
  wait_for_rest();
}

void Viewer::changed_everywhere(std::int64_t sequence) {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->rest_after(kRestAfterChange);
    impl_->flow.on_change_everywhere(sequence);
  }
  step();
  wait_for_rest();
}

void Viewer::ack(std::uint64_t frame) {
  {
    std::lock_guard lock(impl_->mutex);
    impl_->flow.on_ack(frame);
    impl_->link.on_ack(frame, Clock::now());
    impl_->adapt_window();
  }
  step();
}

void Viewer::reset_model(render::ModelHandle model, render::ViewStyle style,
                         std::optional<std::int64_t> past) {
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->closed) return;
    // After a lost context the old handle is invalid, and its removal fails. After another reload,
    // the removal frees the view.
    if (impl_->view != 0) impl_->context.renderer->remove_view(impl_->view);
    impl_->model = model;
    impl_->view = 0;
    impl_->style = std::move(style);
    impl_->retry_in = kFirstRetry;
    impl_->flow.on_past(past);
    impl_->flow.on_reset();
  }
  add_view();
}

Viewer::Stats Viewer::stats() const {
  std::lock_guard lock(impl_->mutex);
  Stats stats = impl_->stats;
  stats.dropped = impl_->flow.dropped();
  return stats;
}

// Starts the next draw of the flow. Calls the renderer without the lock, because it may call back
// immediately.
void Viewer::step() {
  FlowControl::Draw draw;
  MovingPicture reduced{kStillPicture, 1};
  render::FrameRequest request;
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->closed) return;
    auto next = impl_->flow.next();
    if (!next) return;
    draw = std::move(*next);
    if (draw.samples > 1 && !impl_->link.has_room()) {
      impl_->flow.on_not_refined(draw.ticket, false);
      return;
    }
    request.view = impl_->view;
    request.model = impl_->model;
    request.style = impl_->style;
    request.acting = Clock::now() - impl_->last_act < kActsFor;
    impl_->waits_as_onlooker = !request.acting;
    request.moving = draw.quality == FlowControl::Quality::moving;
    request.samples = draw.samples;
    request.smooth = true;
    request.refinement = draw.samples > 1;
    request.samples_time = kRefinementTime;
    // A rectangle keeps the settings of the existing frame.
    if (request.moving && !draw.changed) {
      impl_->moving = impl_->link.moving();
      impl_->moving.scale = std::min(impl_->moving.scale, impl_->draw_pace.scale());
    }
    if (request.moving) reduced = impl_->moving;
    impl_->requested_at = Clock::now();
  }
  request.camera = draw.camera;
  request.changed = draw.changed;
  std::tie(request.width, request.height) =
      picture_size(draw.camera, impl_->options, reduced.scale);
  impl_->context.renderer->draw(
      std::move(request),
      [self = weak_from_this(), draw,
       jpeg = reduced.jpeg](const Result<render::SharedFrame>& frame) {
        auto viewer = self.lock();
        if (!viewer) return;
        if (frame)
          viewer->on_drawn(draw, jpeg, *frame);
        else if (draw.samples > 1)
          viewer->on_not_refined(draw.ticket, frame.error());
        else
          viewer->on_failed(draw.ticket, frame.error());
      },
      [self = weak_from_this(), ticket = draw.ticket] {
        const auto viewer = self.lock();
        return viewer ? viewer->late_changes(ticket) : std::vector<render::FrameRequest::Box>();
      });
  if (acted_meanwhile()) leave_onlookers();
}

// Returns whether the user acted after the request of an onlooker's draw was made. `acts` may have
// found no waiting request, because the renderer did not have it yet.
bool Viewer::acted_meanwhile() {
  std::lock_guard lock(impl_->mutex);
  return impl_->waits_as_onlooker && Clock::now() - impl_->last_act < kActsFor;
}

std::vector<render::FrameRequest::Box> Viewer::late_changes(std::uint64_t ticket) {
  std::lock_guard lock(impl_->mutex);
  impl_->waits_as_onlooker = false;
  return impl_->flow.on_begun(ticket);
}

void Viewer::on_drawn(const FlowControl::Draw& draw, JpegSettings jpeg, render::SharedFrame frame) {
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->closed) return;
    const bool sent = !frame->rects.empty();
    impl_->retry_in = kFirstRetry;
    impl_->stats.last_render_ms = frame->render_ms;
    if (const auto number = impl_->flow.on_drawn(draw.ticket, sent)) {
      if (draw.quality == FlowControl::Quality::moving && !draw.changed)
        impl_->draw_pace.on_drawn(Clock::now() - impl_->requested_at);
      impl_->drawn.push_back({draw, *number, jpeg, std::move(frame)});
    }
  }
  encode_next();
  step();
}

void Viewer::on_failed(std::uint64_t ticket, const Error& problem) {
  const bool refused = is_refusal(problem);
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->closed ||
        !(refused ? impl_->flow.on_refused(ticket) : impl_->flow.on_failed(ticket)))
      return;
    impl_->waits_as_onlooker = false;
  }
  if (is_superseded(problem)) return step();
  if (refused) {
    tell(problem);
    return step();
  }
  log::debug("the server could not draw a frame and will try again: " + problem.title);
  retry_later([](Viewer& viewer) { viewer.step(); });
}

void Viewer::on_not_refined(std::uint64_t ticket, const Error& problem) {
  {
    std::lock_guard lock(impl_->mutex);
    // After these errors, the same request would fail again.
    const bool again = !is_refusal(problem) && problem.code != ErrorCode::out_of_memory &&
                       problem.code != ErrorCode::too_large;
    if (impl_->closed || !impl_->flow.on_not_refined(ticket, again)) return;
    impl_->rest_after(kRestAfterChange);
  }
  step();
  wait_for_rest();
}

void Viewer::tell(const Error& why) {
  std::lock_guard sending(impl_->send_mutex);
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->closed) return;
  }
  if (std::exchange(impl_->last_reported, why.detail) != why.detail && impl_->refused)
    impl_->refused(why);
}

// Encodes one frame of a viewer at a time. This keeps frames in order and prevents concurrent calls
// of `send`.
void Viewer::encode_next() {
  render::SharedFrame frame;
  JpegSettings settings;
  {
    std::lock_guard lock(impl_->mutex);
    if (impl_->closed || impl_->encoding || impl_->drawn.empty()) return;
    impl_->encoding = true;
    frame = impl_->drawn.front().frame;
    settings = impl_->drawn.front().jpeg;
  }
  impl_->context.encoder->encode(std::move(frame), settings,
                                 [self = weak_from_this()](const Jpegs& jpegs, double encode_ms) {
                                   if (auto viewer = self.lock())
                                     viewer->on_encoded(jpegs, encode_ms);
                                 });
}

void Viewer::on_encoded(const Jpegs& jpegs, double encode_ms) {
  {
    std::lock_guard sending(impl_->send_mutex);
    FrameMessages messages;
    {
      std::lock_guard lock(impl_->mutex);
      impl_->encoding = false;
      if (impl_->closed) return;
      const Impl::Picture picture = std::move(impl_->drawn.front());
      impl_->drawn.pop_front();
      if (!jpegs) {
        // The frame is never sent, so no client will acknowledge it.
        impl_->flow.on_ack(picture.number.frame);
      } else {
        messages = frame_messages(picture.draw, picture.number, *picture.frame,
                                  impl_->options.view_id, *jpegs, encode_ms);
        std::size_t bytes = 0;
        for (const FrameBytes& message : messages) bytes += message->size();
        impl_->link.on_sent(picture.number.frame, bytes,
                            picture.draw.quality == FlowControl::Quality::moving, Clock::now());
        ++impl_->stats.frames;
        impl_->stats.bytes += bytes;
        impl_->stats.last_encode_ms = encode_ms;
      }
    }
    impl_->last_reported.clear();
    if (!messages.empty()) impl_->send(std::move(messages));
  }
  encode_next();
  step();
}

}  // namespace strata::stream
