#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "domain/scene/camera.h"
#include "render/renderer.h"
#include "stream/draw_pace.h"
#include "stream/flow_control.h"
#include "stream/frame_messages.h"
#include "stream/jpeg_pool.h"

namespace strata::stream {

// The objects that all viewers of one server share.
struct StreamContext {
  render::Renderer* renderer = nullptr;
  JpegPool* encoder = nullptr;
  // Samples per pixel of a refinement, 1 to render::kMaxSamples. 1: no refinement.
  int samples_at_rest = 1;
};

// One view of one client: converts cameras and changes to encoded frames. Follows the flow rules of
// docs/developer/architecture/streaming.md:
// - The newest camera replaces older ones. Frames contain the camera's number.
// - At most `window` frames are sent but not acknowledged. At this limit, nothing is drawn until an
//   acknowledgment arrives. Changes in the meantime are drawn then.
// - A frame shows all changes that were reported before its turn to be drawn.
// - Without a change nothing is sent.
// - After frames of a moving camera, a full-quality frame follows within 250 ms of the last input.
// - Quality never decreases during painting.
// - Viewers with the same frame share its drawing and its encoding.
// - Over a slow link, frames of a moving camera have lower quality and size (stream/link_pace).
// - If the turns of other views take long, frames of a moving camera are smaller
//   (stream/draw_pace).
// - Users who only watch do not delay a user who moved the camera or edited recently
//   (render/thread/frame_queue).
// Thread-safe. Calls `send` on encoder threads, in frame order, and `refused` on the GPU thread,
// but never both at the same time.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  struct Options {
    std::uint32_t view_id = 0;
    int window = 0;  // unacknowledged frames; 0: depends on the link (stream/link_pace)
    int max_width = 3840, max_height = 2160;
    std::int64_t sequence = 0;  // newest edit in the scene at the start
    // Moving frames become smaller if they take longer (stream/draw_pace).
    std::chrono::milliseconds longest_draw = DrawPace::kLongest;
  };
  using Send = SendFrames;
  // Reports the reason if a requested frame is invalid. Called once for each reason. The next
  // camera, style or edit is drawn again.
  using Refused = std::function<void(const Error&)>;

  static std::shared_ptr<Viewer> create(StreamContext context, render::ModelHandle model,
                                        Options options, Send send, Refused refused = {});
  ~Viewer();

  void set_camera(std::uint64_t camera_seq, const Camera& camera, bool moving);
  // Reports an edit of this view's user. For some time, this view is drawn before the views of
  // users who only watch, as after a movement of the camera.
  void acts();
  // With `past`, frames show the model after this edit. Without a value, they show the newest
  // state.
  void set_style(render::ViewStyle style, std::optional<std::int64_t> past = {});
  // Reports the model-space box that an edit changed. Frames drawn after this call show `sequence`.
  void changed(const render::FrameRequest::Box& box, std::int64_t sequence);
  void changed_everywhere(std::int64_t sequence);
  void ack(std::uint64_t frame);
  // Replaces the model's handle after a lost context. The whole frame is drawn again.
  void reset_model(render::ModelHandle model, render::ViewStyle style,
                   std::optional<std::int64_t> past = {});
  void close();  // after its return, neither `send` nor `refused` is called

  struct Stats {
    std::uint64_t frames = 0, bytes = 0, dropped = 0;
    double last_render_ms = 0, last_encode_ms = 0;
  };
  Stats stats() const;

 private:
  struct Impl;
  Viewer();
  void add_view();
  bool on_view(std::uint64_t generation,
               const Result<render::ViewHandle>& view);  // false: the view is not needed
  void step();
  std::vector<render::FrameRequest::Box> late_changes(std::uint64_t ticket);
  void on_drawn(const FlowControl::Draw& draw, JpegSettings jpeg, render::SharedFrame frame);
  void on_failed(std::uint64_t ticket, const Error& problem);
  void on_not_refined(std::uint64_t ticket, const Error& problem);
  void tell(const Error& why);
  void encode_next();
  void on_encoded(const Jpegs& jpegs, double encode_ms);
  void leave_onlookers();
  bool acted_meanwhile();
  void wait_for_quiet();
  void wait_for_rest();
  bool waits_until(std::chrono::steady_clock::time_point time, bool Impl::*timer_runs,
                   void (Viewer::*then)());
  void retry_later(std::function<void(Viewer&)> action);

  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::stream
