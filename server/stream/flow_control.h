#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "domain/scene/camera.h"
#include "render/renderer.h"

namespace strata::stream {

// The flow control of one viewer, without threads, clocks or GPU. The viewer reports events, and
// `next` returns the draw to start now.
//
// 1. The newest camera replaces older ones. `dropped` counts the cameras that were replaced before
//    they were drawn.
// 2. At most one draw is requested, and at most `window` frames are drawn but not acknowledged.
//    Until an acknowledgment arrives, changes are only kept, and are drawn later. A draw may wait
//    long for its turn. Just before its pixels are shaded, it takes in the changes that arrived
//    since the request (`on_begun`), so the wait for a turn is not followed by a second one.
// 3. All changes are eventually drawn, because a failed draw returns its changes.
// 4. Without a change, nothing is drawn. A camera that equals the current one only changes the
//    camera number of later frames.
// 5. Frames of a moving camera have lower quality. When the camera is at rest (by a message, or by
//    `on_quiet`), the frame is drawn again at full quality. Edits are drawn at full quality, except
//    within frames of a moving camera.
// 6. A rejected draw is not repeated before a change, because it would be rejected again.
// 7. After some time without changes (`on_rest`), the frame is refined once: it is drawn with
//    several samples per pixel. A change immediately invalidates a refinement in progress.
//
// Not thread-safe. The viewer calls it under its lock.
class FlowControl {
 public:
  using Box = render::FrameRequest::Box;
  static constexpr std::size_t kMaxBoxes = 64;  // more boxes enlarge existing ones

  // `samples_at_rest` is the number of samples per pixel of a refinement. 1: no refinement.
  explicit FlowControl(int window, std::int64_t sequence = 0, int samples_at_rest = 1)
      : window_(window < 1 ? 1 : window), sequence_(sequence), samples_at_rest_(samples_at_rest) {}

  enum class Quality { moving, still };

  struct Draw {
    std::uint64_t ticket = 0;  // identifies this draw in `on_drawn` and `on_failed`
    std::uint64_t camera_seq = 0;
    std::int64_t sequence = 0;  // the newest edit in the frame
    Camera camera;
    std::optional<std::vector<Box>> changed;  // no value: the whole frame
    Quality quality = Quality::still;
    int samples = 1;  // per pixel; more than one: a refinement
  };
  struct Numbered {
    std::uint64_t frame = 0;    // starts at 1, without gaps
    bool still = false;         // after this frame, the whole screen has full quality
    std::int64_t sequence = 0;  // the newest edit in the frame
  };

  void on_ready();  // the view exists; before this call nothing is drawn
  // The view was lost with its context. Waits for `on_ready` and then draws the whole frame.
  // Earlier tickets become invalid.
  void on_reset();
  void on_camera(std::uint64_t camera_seq, const Camera& camera, bool moving);
  void on_change(const Box& box, std::int64_t sequence);
  void on_change_everywhere(std::int64_t sequence);
  void on_style();
  // From now on, frames show the scene after this earlier edit, or the newest state if there is no
  // value. Returns whether this is a change.
  bool on_past(std::optional<std::int64_t> sequence);
  // The client shows all frames up to this one. Unknown numbers are clamped.
  void on_ack(std::uint64_t frame);
  void set_window(int window) { window_ = window < 1 ? 1 : window; }
  void on_quiet();  // no camera arrived for some time: the camera is considered at rest

  // Returns the draw to start now. Returns nothing while a draw is in progress.
  std::optional<Draw> next();
  // The pixels of the draw are shaded next. Returns the boxes that changed since `next`, which the
  // frame must show too. Returns nothing if the ticket is invalid.
  std::vector<Box> on_begun(std::uint64_t ticket);
  // The draw is complete. Returns the number of the frame to send, or nothing if the frame is empty
  // (`sent` is false) or the ticket is invalid.
  std::optional<Numbered> on_drawn(std::uint64_t ticket, bool sent);
  // The draw failed, and its changes wait again. Returns false if the ticket is invalid.
  bool on_failed(std::uint64_t ticket);
  // Like `on_failed`, for a draw that was rejected because its request is invalid.
  bool on_refused(std::uint64_t ticket);

  // Nothing has changed for some time, so the frame may be refined.
  void on_rest() { rests_ = true; }
  // The refinement was not drawn. If `again` is true, it is tried again after `on_rest`, otherwise
  // only after a change. Returns false if the ticket is invalid.
  bool on_not_refined(std::uint64_t ticket, bool again);

  bool wants_quiet_timer() const { return moving_; }
  bool wants_rest_timer() const { return samples_at_rest_ > 1 && !refined_ && !rests_; }
  std::uint64_t dropped() const { return dropped_; }
  std::uint64_t last_frame() const { return last_frame_; }

 private:
  void add_box(const Box& box);
  void on_news();

  int window_;
  bool ready_ = false;
  std::optional<Camera> camera_;
  std::uint64_t camera_seq_ = 0;
  // The newest camera message is from a moving camera that is not at rest yet.
  bool moving_ = false;
  bool camera_waits_ = false;  // no draw contains the newest camera yet
  bool everything_waits_ = false;
  bool surface_waits_ = false;  // the whole surface changed, and no draw contains this yet
  bool refine_waits_ = false;   // the screen shows a frame of lower quality
  std::vector<Box> boxes_;      // changes that no draw contains yet
  std::int64_t sequence_;
  std::optional<std::int64_t> past_;  // if set, used instead of `sequence_`
  std::optional<Draw> out_;           // the requested draw
  bool out_is_past_ = false;          // `out_` shows an earlier state
  const int samples_at_rest_;
  bool rests_ = false;    // nothing has changed for some time
  bool refined_ = false;  // the frame is refined, or will not be refined
  bool news_ = false;     // there were changes since `next` returned `out_`
  bool refused_ = false;  // the last draw was rejected, and nothing has changed since then
  std::uint64_t tickets_ = 0;
  std::uint64_t last_frame_ = 0;
  std::uint64_t acked_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace strata::stream
