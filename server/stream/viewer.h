#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "domain/scene/camera.h"
#include "render/renderer.h"
#include "stream/flow_control.h"
#include "stream/frame_messages.h"
#include "stream/jpeg_pool.h"

namespace strata::stream {

// The objects that all viewers of one server share.
struct StreamContext {
  render::Renderer* renderer = nullptr;
  JpegPool* encoder = nullptr;
  // of each pixel of a picture that nothing changes, 1 to render::kMaxSamples; 1: no refinement
  int samples_at_rest = 1;
};

// One view of one client: converts camera and changes to encoded frames, by the flow rules of
// docs/developer/architecture/streaming.md: the newest camera wins; frames contain the camera's
// number; at most `window` frames are sent but not acknowledged; without credit nothing is drawn,
// and changes are drawn when credit returns; without a change nothing is sent; a frame of a moving
// camera is followed by a full-quality one within 250 ms of the last input; quality never decreases
// during painting; viewers with the same picture share its drawing and its encoding; over a slow
// link, pictures of a moving camera are reduced (stream/link_pace); onlookers do not delay a user
// who just moved the camera or edited (render/thread/frame_queue). Thread-safe; `send` is called on
// encoder threads, in frame order, `refused` on the GPU thread; never concurrently.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  struct Options {
    std::uint32_t view_id = 0;
    int window = 0;  // frames on their way; 0: chosen for the link (stream/link_pace)
    int max_width = 3840, max_height = 2160;
    std::int64_t sequence = 0;  // of the scene at the start
  };
  using Send = SendFrames;
  // Reports why the requested picture cannot be drawn (invalid). Called once; the next camera,
  // layers or edit are tried again.
  using Refused = std::function<void(const Error&)>;

  static std::shared_ptr<Viewer> create(StreamContext context, render::ModelHandle model,
                                        Options options, Send send, Refused refused = {});
  ~Viewer();

  void set_camera(std::uint64_t camera_seq, const Camera& camera, bool moving);
  void acts();  // its user edits: for a while, this view is drawn before those of onlookers, as
                // after a camera
  // `past`: the edit after which the picture shows the model; nothing: always the newest state.
  void set_style(render::ViewStyle style, std::optional<std::int64_t> past = {});
  // Model-space box that an edit changed; frames drawn after this will show `sequence`.
  void changed(const render::FrameRequest::Box& box, std::int64_t sequence);
  void changed_everywhere(std::int64_t sequence);
  void ack(std::uint64_t frame);
  // After a lost context: the model has a new handle; everything is drawn again.
  void reset_model(render::ModelHandle model, render::ViewStyle style,
                   std::optional<std::int64_t> past = {});
  void close();  // neither `send` nor `refused` is called after it returns

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
               const Result<render::ViewHandle>& view);  // false: the view is no longer needed
  void step();
  void on_drawn(const FlowControl::Draw& draw, JpegSettings jpeg, render::SharedFrame frame);
  void on_failed(std::uint64_t ticket, const Error& problem);
  void on_not_refined(std::uint64_t ticket, const Error& problem);
  void tell(const Error& why);
  void encode_next();
  void on_encoded(const Jpegs& jpegs, double encode_ms);
  void wait_for_quiet();
  void wait_for_rest();
  bool waits_until(std::chrono::steady_clock::time_point time, bool Impl::*timer_runs,
                   void (Viewer::*then)());
  void retry_later(std::function<void(Viewer&)> action);

  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::stream
