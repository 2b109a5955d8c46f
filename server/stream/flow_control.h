#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "domain/scene/camera.h"
#include "render/renderer.h"

namespace strata::stream {

// The decisions of one viewer's flow, without threads, clocks or GPU: events go in, `next` says
// what to draw now.
//
// 1. The newest camera wins; a camera that was replaced before it was drawn is counted in
// `dropped`.
// 2. At most one draw is under way, and at most `window` frames are drawn but not acknowledged.
// Without credit nothing
//    is drawn; what changes meanwhile is kept and drawn once credit returns.
// 3. Every change is drawn in the end: a draw that fails gives its changes back.
// 4. Nothing changed → nothing is drawn. A camera equal to the one on screen only renumbers later
// frames.
// 5. Frames of a moving camera are of lower quality; once the camera is still (a message says so,
// or `on_quiet`) the
//    picture is drawn once more at full quality. Edits are of full quality, but where they fall
//    into a picture of a moving camera.
// 6. What was refused is not drawn again before something changes: it would be refused again.
//
// Not thread-safe: the viewer calls it under its lock.
class FlowControl {
 public:
  using Box = render::FrameRequest::Box;
  static constexpr std::size_t kMaxBoxes = 64;  // they grow around what more there is

  explicit FlowControl(int window, std::int64_t sequence = 0)
      : window_(window < 1 ? 1 : window), sequence_(sequence) {}

  enum class Quality { moving, still };

  struct Draw {
    std::uint64_t ticket = 0;  // names this draw in `on_drawn` and `on_failed`
    std::uint64_t camera_seq = 0;
    std::int64_t sequence = 0;  // of the scene: the newest edit that the picture shows
    Camera camera;
    std::optional<std::vector<Box>> changed;  // empty: everything
    Quality quality = Quality::still;
  };
  struct Numbered {
    std::uint64_t frame = 0;  // from 1, without gaps
    bool still = false;       // after this frame the whole picture is of full quality
  };

  void on_ready();  // the view exists; nothing is drawn before
  // The view is gone (lost context): waits for `on_ready`, then draws everything. Tickets given
  // before are void.
  void on_reset();
  void on_camera(std::uint64_t camera_seq, const Camera& camera, bool moving);
  void on_change(const Box& box, std::int64_t sequence);
  void on_change_everywhere(std::int64_t sequence);
  void on_style();
  // frames up to this one are on the client's screen; unknown numbers are cut
  void on_ack(std::uint64_t frame);
  void set_window(int window) { window_ = window < 1 ? 1 : window; }
  void on_quiet();  // no camera came for a while: what moved stands still

  // The draw to start now; at most one is out until its ticket comes back.
  std::optional<Draw> next();
  // The draw is done. Gives the number of the frame to send; none when it is empty (`sent` false)
  // or its ticket is void.
  std::optional<Numbered> on_drawn(std::uint64_t ticket, bool sent);
  // The draw failed; its changes wait again. False when the ticket is void.
  bool on_failed(std::uint64_t ticket);
  // The same, for what was asked for.
  bool on_refused(std::uint64_t ticket);

  bool wants_quiet_timer() const { return moving_; }
  std::uint64_t dropped() const { return dropped_; }
  std::uint64_t last_frame() const { return last_frame_; }

 private:
  void add_box(const Box& box);
  void on_news();

  int window_;
  bool ready_ = false;
  std::optional<Camera> camera_;
  std::uint64_t camera_seq_ = 0;
  // the newest camera message was of a moving camera and is not yet quiet
  bool moving_ = false;
  bool camera_waits_ = false;  // the newest camera has not been given to a draw
  bool everything_waits_ = false;
  bool refine_waits_ = false;  // the screen shows a picture of lower quality
  std::vector<Box> boxes_;     // changes that no draw has taken
  std::int64_t sequence_;
  std::optional<Draw> out_;  // the draw under way
  bool news_ = false;        // something changed since `out_` was given out
  bool refused_ = false;     // and nothing changed since
  std::uint64_t tickets_ = 0;
  std::uint64_t last_frame_ = 0;
  std::uint64_t acked_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace strata::stream
