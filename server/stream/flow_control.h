#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "domain/scene/camera.h"
#include "render/renderer.h"

namespace strata::stream {

// The decisions of one viewer's flow, without threads, clocks or GPU: the viewer reports events,
// and `next` returns the draw to start now.
//
// 1. The newest camera wins; `dropped` counts cameras that were replaced before they were drawn.
// 2. At most one draw is in progress, and at most `window` frames are drawn but not acknowledged.
//    Without credit, nothing is drawn; changes are kept and drawn when credit returns.
// 3. Every change is eventually drawn: a failed draw returns its changes.
// 4. Without a change, nothing is drawn. A camera equal to the one on screen only renumbers later
//    frames.
// 5. Frames of a moving camera are of lower quality; once the camera is still (by a message, or by
//    `on_quiet`), the picture is drawn once more at full quality. Edits are drawn at full quality,
//    except those inside a picture of a moving camera.
// 6. A refused draw is not repeated before something changes: it would be refused again.
// 7. Once nothing changed for a while (`on_rest`), the picture is refined once: drawn with several
//    samples for each pixel. A change makes a refinement in progress void at once.
//
// Not thread-safe: the viewer calls it under its lock.
class FlowControl {
 public:
  using Box = render::FrameRequest::Box;
  static constexpr std::size_t kMaxBoxes = 64;  // further boxes enlarge existing ones

  // `samples_at_rest`: of each pixel, once nothing changes; 1: there is no refinement.
  explicit FlowControl(int window, std::int64_t sequence = 0, int samples_at_rest = 1)
      : window_(window < 1 ? 1 : window), sequence_(sequence), samples_at_rest_(samples_at_rest) {}

  enum class Quality { moving, still };

  struct Draw {
    std::uint64_t ticket = 0;  // identifies this draw in `on_drawn` and `on_failed`
    std::uint64_t camera_seq = 0;
    std::int64_t sequence = 0;  // of the scene: the newest edit in the picture
    Camera camera;
    std::optional<std::vector<Box>> changed;  // empty: everything
    Quality quality = Quality::still;
    int samples = 1;  // of each pixel; more than one: a refinement of the picture on the screen
  };
  struct Numbered {
    std::uint64_t frame = 0;  // from 1, without gaps
    bool still = false;       // after this frame the whole picture is of full quality
  };

  void on_ready();  // the view exists; nothing is drawn before
  // The view is lost (lost context): waits for `on_ready`, then draws everything. Earlier tickets
  // are void.
  void on_reset();
  void on_camera(std::uint64_t camera_seq, const Camera& camera, bool moving);
  void on_change(const Box& box, std::int64_t sequence);
  void on_change_everywhere(std::int64_t sequence);
  void on_style();
  // From now on, pictures show the scene after this earlier edit; nothing: always the newest.
  // False: as before.
  bool on_past(std::optional<std::int64_t> sequence);
  // frames up to this one are on the client's screen; unknown numbers are clamped
  void on_ack(std::uint64_t frame);
  void set_window(int window) { window_ = window < 1 ? 1 : window; }
  void on_quiet();  // no camera came for a while: the moving camera is now still

  // Returns the draw to start now; at most one is in progress until its ticket is reported.
  std::optional<Draw> next();
  // The draw is done. Returns the number of the frame to send; nothing if the frame is empty
  // (`sent` false) or its ticket is void.
  std::optional<Numbered> on_drawn(std::uint64_t ticket, bool sent);
  // The draw failed; its changes wait again. Returns false if the ticket is void.
  bool on_failed(std::uint64_t ticket);
  // The same for a refused draw: its request is invalid.
  bool on_refused(std::uint64_t ticket);

  // Nothing changed for a while: the picture may be refined.
  void on_rest() { rests_ = true; }
  // The refinement was not drawn. It is not tried again before `on_rest`, or, unless `again`,
  // before something changes. False when the ticket is void.
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
  // the newest camera message was of a moving camera that is not yet still
  bool moving_ = false;
  bool camera_waits_ = false;  // the newest camera has not been given to a draw
  bool everything_waits_ = false;
  bool refine_waits_ = false;  // the screen shows a picture of lower quality
  std::vector<Box> boxes_;     // changes that are in no draw yet
  std::int64_t sequence_;
  std::optional<std::int64_t> past_;  // instead of `sequence_`
  std::optional<Draw> out_;           // the draw in progress
  const int samples_at_rest_;
  bool rests_ = false;    // nothing changed for a while
  bool refined_ = false;  // the screen shows the refined picture, or there will be none
  bool news_ = false;     // something changed since `out_` was returned
  bool refused_ = false;  // the last draw was refused, and nothing changed since
  std::uint64_t tickets_ = 0;
  std::uint64_t last_frame_ = 0;
  std::uint64_t acked_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace strata::stream
