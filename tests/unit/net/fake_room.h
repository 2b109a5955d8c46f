#pragma once

#include <gtest/gtest.h>

#include <map>

#include "query/sampling/profile.h"
#include "query/sampling/texel_samples.h"
#include "query/statistics/cross_table.h"
#include "query/statistics/key_areas.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/listener.h"
#include "room/participants.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/selection.h"
#include "room/surface_images.h"
#include "room/view_settings.h"
#include "store/content/trash.h"

// A room for tests of live sessions, without a database and a renderer.
namespace strata::net {

class FakeParticipant final : public room::Participant {
 public:
  explicit FakeParticipant(Uuid session) : session_(session) {}
  Uuid session() const override { return session_; }
  void camera(std::uint32_t view_id, std::uint64_t seq, const Camera&, bool) override {
    cameras.emplace_back(view_id, seq);
  }
  Result<void> show(std::uint32_t view_id, room::ViewSettings settings) override {
    shown[view_id] = std::move(settings);
    return {};
  }
  void ack(std::uint32_t, std::uint64_t) override {}
  void edits() override {}
  void pointer(std::optional<room::Pointing> at) override { pointers.push_back(at); }
  Result<void> look_together(bool leading, const std::optional<Uuid>& follow) override {
    if (follow == kGone)
      return fail(ErrorCode::not_found, "Not here", "Who is to be followed has left.", "follow");
    together.emplace_back(leading, follow);
    return {};
  }
  static constexpr Uuid kGone{{1}};
  std::map<std::uint32_t, room::ViewSettings> shown;
  std::vector<std::pair<std::uint32_t, std::uint64_t>> cameras;
  std::vector<std::optional<room::Pointing>> pointers;
  std::vector<std::pair<bool, std::optional<Uuid>>> together;

 private:
  Uuid session_;
};

// Fakes of the parts of a room. They hold every edit until the test completes it, and have one
// layer and one surface image.
class FakeLayers final : public room::Layers {
 public:
  FakeLayers() {
    layer_.id = 7;
    layer_.model_id = 1;
    layer_.name = layer_.slug = "cracks";
    layer_.palette = default_palette(ValueType::u8, false);
  }
  std::vector<Layer> all() const override { return {layer_}; }
  Result<Layer> find(const std::string& ref) const override {
    if (ref == "cracks" || ref == "7") return layer_;
    return fail(ErrorCode::not_found, "No such layer", "There is no layer '" + ref + "'.");
  }
  Result<Layer> create(Layer layer, const store::IdempotentResponse<Layer>&,
                       std::vector<Column>) override {
    return layer;
  }
  Result<Layer> update(Layer layer, const store::IdempotentResponse<Layer>&) override {
    return layer;
  }
  Result<Layer> widen(const Layer& layer, ValueType,
                      const store::IdempotentResponse<Layer>&) override {
    return layer;
  }
  Result<void> erase(LayerId, const store::IdempotentResponse<>&) override { return {}; }
  Result<void> put_in_trash(LayerId, const store::IdempotentResponse<>&) override { return {}; }
  Result<store::TrashRestored> restore(
      const store::TrashEntry& entry,
      const store::IdempotentResponse<store::TrashRestored>&) override {
    return store::TrashRestored{entry, {}, {}};
  }
  Result<Layer> mark_computed(LayerId, const std::string&, std::int64_t,
                              const std::map<TableId, std::int64_t>&) override {
    return fail(ErrorCode::internal, "Not here", "");
  }
  void records_changed(TableId) override {}
  Result<void> check_expression(const Expression&, const std::string&, Visibility,
                                const std::vector<Layer>&) const override {
    return {};
  }

 private:
  Layer layer_;
};

class FakeEdits final : public room::Edits {
 public:
  void submit(room::EditRequest request, room::Applied applied, room::Saved saved) override {
    held.push_back({std::move(request), std::move(applied), std::move(saved)});
  }
  std::int64_t sequence() const override { return 0; }
  std::int64_t durable_sequence() const override { return 0; }
  room::DurableState durable_state() const override { return {}; }
  Result<void> keep_sums(LayerId) override { return {}; }

  struct Held {
    room::EditRequest request;
    room::Applied applied;
    room::Saved saved;
  };
  std::vector<Held> held;
};

class FakeQueries final : public room::Queries {
 public:
  Result<query::SurfacePoint> position(const glm::dvec3&, const std::vector<std::string>&,
                                       room::At) override {
    return query::SurfacePoint{};
  }
  Result<std::vector<query::SurfacePoint>> positions(const std::vector<glm::dvec3>&,
                                                     const std::vector<std::string>&,
                                                     room::At) override {
    return std::vector<query::SurfacePoint>{};
  }
  Result<query::SurfacePoint> pick(const Camera&, double, double, const std::vector<std::string>&,
                                   room::At) override {
    return found;
  }
  Result<query::Statistics> statistics(const std::string&, const room::Selection&,
                                       room::StatisticsOptions) override {
    return query::Statistics{};
  }
  Result<room::SelectedArea> select(const room::Selection&, const std::vector<std::string>&,
                                    room::StatisticsOptions) override {
    return room::SelectedArea{};
  }
  Result<room::SelectedArea::Texels> selected_texels(const room::Selection&) override {
    return room::SelectedArea::Texels{};
  }
  Result<query::Profile> profile(const room::ProfileLine&, const std::vector<std::string>&,
                                 room::At) override {
    return query::Profile{};
  }
  Result<query::CrossTable> cross_table(const std::string&, const std::string&,
                                        const room::Selection&) override {
    return query::CrossTable{};
  }
  Result<query::Quantities> quantities(const std::string&, room::At) override {
    return query::Quantities{};
  }
  Result<room::LayerAreas> layer_areas(const std::string&, room::At) override {
    return room::LayerAreas{};
  }
  Result<query::SurfaceTexels> surface_texels(const std::string&, const room::Selection&) override {
    return query::SurfaceTexels{};
  }
  Result<std::map<std::int64_t, query::KeyArea>> key_areas(const std::string&, room::At) override {
    return std::map<std::int64_t, query::KeyArea>();
  }
  Result<room::LayerDifference> difference(const std::string&, room::At, room::At,
                                           const std::optional<room::Outline>&) override {
    return room::LayerDifference{};
  }
  Result<TileMirror::Snapshot> tiles(const std::string&, room::At) override {
    return TileMirror::Snapshot{};
  }
  query::SurfacePoint found;
};

class FakeSurfaceImages final : public room::SurfaceImages {
 public:
  std::vector<SurfaceImage> all() const override { return {image_}; }
  Result<SurfaceImage> find(const std::string& ref) const override {
    if (ref == "uv-light" || ref == "9") return image_;
    return fail(ErrorCode::not_found, "No such look", "There is no look '" + ref + "'.");
  }
  Result<SurfaceImage> create(SurfaceImage image, std::span<const std::uint8_t>,
                              const store::IdempotentResponse<SurfaceImage>&) override {
    return image;
  }
  Result<SurfaceImage> update(const SurfaceImage& image,
                              const store::IdempotentResponse<SurfaceImage>&) override {
    return image;
  }
  Result<void> erase(SurfaceImageId, const store::IdempotentResponse<>&) override { return {}; }

 private:
  const SurfaceImage image_{9, 1,   "UV light",           "uv-light", "",    "image/png", 16,
                            8, 100, std::string(64, 'a'), 1,          false, 0,           1};
};

class FakeParticipants final : public room::Participants {
 public:
  std::unique_ptr<room::Participant> join(Author, room::Portrait portrait, room::Listener* listener,
                                          stream::SendFrames send) override {
    listeners.push_back(listener);
    sends.push_back(std::move(send));
    portraits.push_back(std::move(portrait));
    auto joined = std::make_unique<FakeParticipant>(random_uuid());
    newest = joined.get();
    return joined;
  }
  std::vector<room::Presence> presence(const Uuid& receiver) const override {
    EXPECT_EQ(receiver, newest->session());
    return people;
  }
  std::vector<room::Listener*> listeners;
  std::vector<stream::SendFrames> sends;
  std::vector<room::Portrait> portraits;
  FakeParticipant* newest = nullptr;
  std::vector<room::Presence> people{
      {random_uuid(), "anna", "", "#112233", room::Pointing{{1, 2, 3}, {}}}};
};

// The parts of a room that a live session uses.
class FakeRoom final : public room::Room {
 public:
  FakeRoom() {
    parts_.layers = &layers_;
    parts_.edits = &edits_;
    parts_.queries = &queries_;
    parts_.images = &images_;
    parts_.participants = &participants_;
  }
  Model model() const override {
    Model model;
    model.id = 1;
    model.project_id = 1;
    model.name = model.slug = "pot";
    return model;
  }
  Result<Model> update_model(Model model, const store::IdempotentResponse<Model>&) override {
    return model;
  }

  FakeLayers layers_;
  FakeEdits edits_;
  FakeQueries queries_;
  FakeSurfaceImages images_;
  FakeParticipants participants_;
};

}  // namespace strata::net
