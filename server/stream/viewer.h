#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "domain/scene/camera.h"
#include "render/renderer.h"
#include "stream/flow_control.h"
#include "stream/frame_messages.h"
#include "stream/jpeg_pool.h"

namespace strata::stream {

// The parts of the flow that every viewer of one server shares.
struct StreamContext {
  render::Renderer* renderer = nullptr;
  JpegPool* encoder = nullptr;
};

// One view of one client: from camera and changes to encoded frames, by the flow rules of
// ARCHITECTURE.md: the newest camera wins; frames echo the camera's number; at most `window` frames
// are sent but not acknowledged; when there is no credit nothing is drawn, and what changed
// meanwhile is drawn once credit returns; nothing changed → nothing sent; a frame of a moving
// camera is followed by a full-quality one within 250 ms of the last input; quality never falls
// while painting; viewers with the same picture share its drawing and its encoding; over a slow
// link pictures of a moving camera are reduced (stream/link_pace); who just moved the camera or
// edited is not held up by onlookers (render/thread/frame_queue). Thread-safe; `send` is called on
// encoder threads, in frame order, `refused` on the GPU thread; never concurrently.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  struct Options {
    std::uint32_t view_id = 0;
    int window = 0;  // frames on their way; 0: as the link needs it (stream/link_pace)
    int max_width = 3840, max_height = 2160;
    std::int64_t sequence = 0;  // of the scene at the start
  };
  using Send = SendFrames;
  // Why nothing can be drawn as asked for (invalid). Told once; the next camera, layers or edit are
  // tried again.
  using Refused = std::function<void(const Error&)>;

  static std::shared_ptr<Viewer> create(StreamContext context, render::ModelHandle model,
                                        Options options, Send send, Refused refused = {});
  ~Viewer();

  void set_camera(std::uint64_t camera_seq, const Camera& camera, bool moving);
  void acts();  // who looks edits: for a while they are served before onlookers, as after a camera
  void set_style(render::ViewStyle style);
  // Model-space box that an edit changed; `sequence` is what frames drawn after this will show.
  void changed(const render::FrameRequest::Box& box, std::int64_t sequence);
  void changed_everywhere(std::int64_t sequence);
  void ack(std::uint64_t frame);
  // After a lost context: the model has a new handle; everything is drawn anew.
  void reset_model(render::ModelHandle model, render::ViewStyle style);
  void close();  // neither `send` nor `refused` is called after it returns

  struct Stats {
    std::uint64_t frames = 0, bytes = 0, dropped = 0;
    double last_render_ms = 0, last_encode_ms = 0;
  };
  Stats stats() const;

 private:
  Viewer();
  void add_view();
  bool on_view(std::uint64_t generation,
               const Result<render::ViewHandle>& view);  // false: the view is not wanted any more
  void step();
  void on_drawn(const FlowControl::Draw& draw, JpegSettings jpeg, render::SharedFrame frame);
  void on_failed(std::uint64_t ticket, const Error& problem);
  void tell(const Error& why);
  void encode_next();
  void on_encoded(const Jpegs& jpegs, double encode_ms);
  void wait_for_quiet();
  void retry_later(std::function<void(Viewer&)> action);

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::stream
