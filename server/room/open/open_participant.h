#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include "core/ids.h"
#include "core/uuid.h"
#include "room/caches/past_layers.h"
#include "room/caches/record_features.h"
#include "room/listener.h"
#include "room/participants.h"
#include "stream/viewer.h"

namespace strata::room {

class OpenRoom;
struct LayerState;

// One connection of a user, with its views and the settings of each view.
class OpenParticipant final : public Participant {
 public:
  OpenParticipant(std::shared_ptr<OpenRoom> room, Author who, Portrait portrait, Listener* listener,
                  stream::SendFrames send);
  ~OpenParticipant() override;

  Uuid session() const override { return session_; }
  void camera(std::uint32_t view_id, std::uint64_t seq, const Camera& camera, bool moving) override;
  Result<void> show(std::uint32_t view_id, ViewSettings settings) override;
  void ack(std::uint32_t view_id, std::uint64_t frame) override;
  void edits() override;
  void pointer(std::optional<Pointing> at) override;
  Result<void> look_together(bool leading, const std::optional<Uuid>& follow) override;

  Listener* listener() const { return listener_; }
  const std::string& user() const { return who_.user; }
  bool is_person() const { return portrait_.is_person; }
  Role role() const { return who_.role; }  // determines the visible layers and columns
  using Clock = std::chrono::steady_clock;
  bool has_edited_since(Clock::time_point time) const { return last_edit_.load() >= time; }
  Presence presence() const;  // without `following`, which the room sets
  // Called by the room.
  void content_changed(const Layer& layer, const std::optional<render::FrameRequest::Box>& box,
                       std::int64_t sequence);
  void styles_changed();
  void model_changed(render::ModelHandle model);
  void tell_moved(const std::string& url);  // at most once; on the strand of the room

 private:
  struct View {
    std::shared_ptr<stream::Viewer> viewer;
    std::map<LayerId, LayerView> overrides;
    // The palettes and highlights of the overrides, by layer.
    std::map<LayerId, std::shared_ptr<const Palette>> palettes;
    std::map<LayerId, std::shared_ptr<const Highlight>> highlights;
    // The palettes that were last made from records. Each is drawn until the next one is ready.
    std::map<LayerId, std::shared_ptr<const Palette>> by_record;
    std::vector<LayerFeatures> marked;  // the source of `features`
    render::FeaturesShown features;
    std::set<std::shared_ptr<const Error>> reported;  // reasons why a palette cannot be made
    std::optional<std::vector<SurfaceImageView>> images;
    Light light;
    Background background;
    At at;
    std::shared_ptr<PastLayers::Place> past;  // not null if `at` is set
  };
  View* view(std::uint32_t view_id, bool make);
  void restyle(std::uint32_t view_id, View& view) const;
  // The style of a frame, and the edit whose state the frame shows. nullopt: the newest
  // state.
  struct Appearance {
    render::ViewStyle style;
    At at;
  };
  Appearance appearance(std::uint32_t view_id, View& view) const;
  // Returns the moment that the view shows. Null: the newest state.
  std::shared_ptr<const PastMoment> moment(std::uint32_t view_id, View& view,
                                           const std::vector<LayerState>& shown) const;
  std::shared_ptr<const Palette> palette(std::uint32_t view_id, View& view,
                                         const LayerState& state) const;

  const std::shared_ptr<OpenRoom> room_;
  const Uuid session_ = random_uuid();
  const Author who_;
  const Portrait portrait_;
  Listener* const listener_;
  const stream::SendFrames send_;
  mutable std::mutex mutex_;
  std::map<std::uint32_t, View> views_;
  std::optional<Pointing> pointer_;
  std::optional<Camera> camera_;  // camera of view 0 without its section
  bool leading_ = false;
  bool told_moved_ = false;
  std::atomic<Clock::time_point> last_edit_ = Clock::time_point::min();
};

}  // namespace strata::room
