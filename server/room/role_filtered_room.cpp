#include "room/role_filtered_room.h"

#include <algorithm>
#include <utility>

#include "core/no_such.h"
#include "domain/people/visibility.h"
#include "query/sampling/profile.h"
#include "query/sampling/texel_samples.h"
#include "query/statistics/cross_table.h"
#include "query/statistics/key_areas.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/participants.h"
#include "room/pictures.h"
#include "room/queries.h"
#include "store/content/trash.h"

namespace strata::room {
namespace {

// Checks every call that names layers. EditPipeline also checks edits when they start.
// OpenParticipant and OpenRoom::ParticipantsPart check frames and events when they are made. This
// is necessary because a visibility may change after the call.
class FilteredLayers final : public Layers {
 public:
  FilteredLayers(Layers& layers, Role role) : layers_(layers), role_(role) {}

  std::vector<Layer> all() const override {
    std::vector<Layer> layers = layers_.all();
    std::erase_if(layers, [this](const Layer& layer) { return !sees(role_, layer.visibility); });
    return layers;
  }
  Result<Layer> find(const std::string& ref) const override {
    auto layer = layers_.find(ref);
    if (layer && !sees(role_, layer->visibility)) return no_such_layer(ref);
    return layer;
  }
  Result<void> check(const std::vector<std::string>& refs) const {
    for (const std::string& ref : refs) STRATA_TRY(find(ref));
    return {};
  }

  // These calls need no check, because the caller has found the layers through this class.
  Result<Layer> create(Layer layer, const store::IdempotentResponse<Layer>& answer,
                       std::vector<Column> columns) override {
    return layers_.create(std::move(layer), answer, std::move(columns));
  }
  Result<Layer> update(Layer layer, const store::IdempotentResponse<Layer>& answer) override {
    return layers_.update(std::move(layer), answer);
  }
  Result<Layer> widen(const Layer& layer, ValueType type,
                      const store::IdempotentResponse<Layer>& answer) override {
    return layers_.widen(layer, type, answer);
  }
  Result<void> erase(LayerId id, const store::IdempotentResponse<>& answer) override {
    return layers_.erase(id, answer);
  }
  Result<void> put_in_trash(LayerId id, const store::IdempotentResponse<>& answer) override {
    return layers_.put_in_trash(id, answer);
  }
  Result<store::TrashRestored> restore(
      const store::TrashEntry& entry,
      const store::IdempotentResponse<store::TrashRestored>& answer) override {
    return layers_.restore(entry, answer);
  }
  Result<Layer> mark_computed(LayerId id, const std::string& expression, std::int64_t sequence,
                              const std::map<TableId, std::int64_t>& tables) override {
    return layers_.mark_computed(id, expression, sequence, tables);
  }
  void records_changed(TableId table_id) override { layers_.records_changed(table_id); }
  Result<void> check_expression(const Expression& expression, const std::string& field,
                                Visibility layer,
                                const std::vector<Layer>& planned) const override {
    return layers_.check_expression(expression, field, layer, planned);
  }

 private:
  Layers& layers_;
  const Role role_;
};

class FilteredQueries final : public Queries {
 public:
  FilteredQueries(Queries& queries, const FilteredLayers& layers, Role role)
      : queries_(queries), layers_(layers), role_(role) {}

  Result<query::SurfacePoint> position(const glm::dvec3& world,
                                       const std::vector<std::string>& layers, At at) override {
    STRATA_TRY(layers_.check(layers));
    return queries_.position(world, layers, at);
  }
  Result<std::vector<query::SurfacePoint>> positions(const std::vector<glm::dvec3>& world,
                                                     const std::vector<std::string>& layers,
                                                     At at) override {
    STRATA_TRY(layers_.check(layers));
    return queries_.positions(world, layers, at);
  }
  Result<query::SurfacePoint> pick(const Camera& camera, double x, double y,
                                   const std::vector<std::string>& layers, At at) override {
    STRATA_TRY(layers_.check(layers));
    return queries_.pick(camera, x, y, layers, at);
  }
  Result<query::Statistics> statistics(const std::string& layer, const Selection& selection,
                                       StatisticsOptions options) override {
    STRATA_TRY(layers_.check({layer}));
    const Selection seen = STRATA_TRY(seen_by(selection));
    return queries_.statistics(layer, seen, options);
  }
  Result<SelectedArea> select(const Selection& selection, const std::vector<std::string>& layers,
                              StatisticsOptions options) override {
    STRATA_TRY(layers_.check(layers));
    if (selection.changed) STRATA_TRY(layers_.check(selection.changed->layers));
    if (options.painted) STRATA_TRY(layers_.check({*options.painted}));
    const Selection seen = STRATA_TRY(seen_by(selection));
    return queries_.select(seen, layers, options);
  }
  Result<SelectedArea::Texels> selected_texels(const Selection& selection) override {
    if (selection.changed) STRATA_TRY(layers_.check(selection.changed->layers));
    const Selection seen = STRATA_TRY(seen_by(selection));
    return queries_.selected_texels(seen);
  }
  Result<query::Profile> profile(const ProfileLine& line, const std::vector<std::string>& layers,
                                 At at) override {
    STRATA_TRY(layers_.check(layers));
    return queries_.profile(line, layers, at);
  }
  Result<query::CrossTable> cross_table(const std::string& rows, const std::string& columns,
                                        const Selection& selection) override {
    STRATA_TRY(layers_.check({rows, columns}));
    const Selection seen = STRATA_TRY(seen_by(selection));
    return queries_.cross_table(rows, columns, seen);
  }
  Result<query::Quantities> quantities(const std::string& layer, At at) override {
    STRATA_TRY(layers_.check({layer}));
    return queries_.quantities(layer, at);
  }
  Result<LayerAreas> layer_areas(const std::string& layer, At at) override {
    STRATA_TRY(layers_.check({layer}));
    return queries_.layer_areas(layer, at);
  }
  Result<query::SurfaceTexels> surface_texels(const std::string& layer,
                                              const Selection& selection) override {
    STRATA_TRY(layers_.check({layer}));
    const Selection seen = STRATA_TRY(seen_by(selection));
    return queries_.surface_texels(layer, seen);
  }
  Result<std::map<std::int64_t, query::KeyArea>> key_areas(const std::string& layer,
                                                           At at) override {
    STRATA_TRY(layers_.check({layer}));
    return queries_.key_areas(layer, at);
  }
  Result<LayerDifference> difference(const std::string& layer, At one, At other,
                                     const std::optional<Outline>& outline) override {
    STRATA_TRY(layers_.check({layer}));
    return queries_.difference(layer, one, other, outline);
  }
  Result<TileMirror::Snapshot> tiles(const std::string& layer, At at) override {
    STRATA_TRY(layers_.check({layer}));
    return queries_.tiles(layer, at);
  }

 private:
  Result<Selection> seen_by(Selection selection) const {
    for (const LayerRead& layer : layers_compared(selection))
      STRATA_TRY(layers_.check({layer.slug}));
    selection.seen_by = std::min(selection.seen_by, role_);
    return selection;
  }

  Queries& queries_;
  const FilteredLayers& layers_;
  const Role role_;
};

class FilteredPictures final : public Pictures {
 public:
  FilteredPictures(Pictures& pictures, const FilteredLayers& layers, Role role)
      : pictures_(pictures), layers_(layers), role_(role) {}

  Result<void> draw(const PictureRequest& request, std::span<const PicturePart> parts,
                    const SeePicture& see) override {
    PictureRequest seen = request;
    seen.seen_by = std::min(request.seen_by, role_);
    if (request.layers) {
      STRATA_TRY(layers_.check(*request.layers));
    } else {
      seen.layers.emplace();
      std::vector<Layer> in_order = layers_.all();
      sort_as_shown(in_order, request.shown);
      for (const Layer& layer : in_order)
        if (request.shown.of(layer.id).visible.value_or(layer.visible))
          seen.layers->push_back(to_string(layer.id));
    }
    return pictures_.draw(seen, parts, see);
  }
  Result<std::vector<std::optional<std::uint32_t>>> seen_keys(const std::string& layer,
                                                              const Camera& camera, int columns,
                                                              int rows, At at) override {
    STRATA_TRY(layers_.check({layer}));
    return pictures_.seen_keys(layer, camera, columns, rows, at);
  }
  Result<std::vector<query::SeenLayer>> seen_layers(const std::vector<std::string>& layers,
                                                    const std::vector<query::LayerCover>& covers,
                                                    const Camera& camera, int columns, int rows,
                                                    At at) override {
    STRATA_TRY(layers_.check(layers));
    return pictures_.seen_layers(layers, covers, camera, columns, rows, at);
  }

 private:
  Pictures& pictures_;
  const FilteredLayers& layers_;
  const Role role_;
};

class FilteredEdits final : public Edits {
 public:
  FilteredEdits(Edits& edits, const FilteredLayers& layers) : edits_(edits), layers_(layers) {}

  // Needs no check, because the caller has found the layer through FilteredLayers.
  void submit(EditRequest request, Applied applied, Saved saved) override {
    edits_.submit(std::move(request), std::move(applied), std::move(saved));
  }
  std::int64_t sequence() const override { return edits_.sequence(); }
  std::int64_t durable_sequence() const override { return edits_.durable_sequence(); }
  DurableState durable_state() const override {
    DurableState state = edits_.durable_state();
    std::erase_if(state.provisional,
                  [&](const auto& entry) { return !layers_.find(to_string(entry.first)); });
    return state;
  }
  Result<void> keep_sums(LayerId layer_id) override { return edits_.keep_sums(layer_id); }

 private:
  Edits& edits_;
  const FilteredLayers& layers_;
};

class FilteredParticipants final : public Participants {
 public:
  FilteredParticipants(Participants& participants, Role role)
      : participants_(participants), role_(role) {}

  std::unique_ptr<Participant> join(Author who, Portrait portrait, Listener* listener,
                                    stream::SendFrames send) override {
    return participants_.join({std::move(who.user), std::min(who.role, role_)}, std::move(portrait),
                              listener, std::move(send));
  }
  std::vector<Presence> presence(const Uuid& receiver) const override {
    return participants_.presence(receiver);
  }

 private:
  Participants& participants_;
  const Role role_;
};

// The surface and the surface images contain no layer data, so the room's objects are used.
class RoleFilteredRoom final : public Room {
 public:
  RoleFilteredRoom(std::shared_ptr<Room> room, Role role)
      : room_(std::move(room)),
        layers_(room_->layers(), role),
        edits_(room_->edits(), layers_),
        queries_(room_->queries(), layers_, role),
        pictures_(room_->pictures(), layers_, role),
        participants_(room_->participants(), role) {
    parts_ = {&layers_,          &edits_,    &queries_,
              &room_->surface(), &pictures_, &room_->surface_images(),
              &participants_};
  }

  Model model() const override { return room_->model(); }
  Result<Model> update_model(Model model, const store::IdempotentResponse<Model>& answer) override {
    return room_->update_model(std::move(model), answer);
  }

 private:
  const std::shared_ptr<Room> room_;
  FilteredLayers layers_;
  FilteredEdits edits_;
  FilteredQueries queries_;
  FilteredPictures pictures_;
  FilteredParticipants participants_;
};

}  // namespace

std::shared_ptr<Room> seen_as(std::shared_ptr<Room> room, Role role) {
  if (sees(role, Visibility::curators)) return room;
  return std::make_shared<RoleFilteredRoom>(std::move(room), role);
}

tl::unexpected<Error> no_such_layer(const std::string& ref) {
  return no_such("layer", ref, "layer");
}

}  // namespace strata::room
