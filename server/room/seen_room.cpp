#include "room/seen_room.h"

#include <algorithm>

#include "core/no_such.h"

namespace strata::room {
namespace {

// Every call that is told of layers looks at them here first. Edits are looked at when their turn
// comes (EditPipeline), frames and events as they are made (RoomMember, OpenRoom::tell_layer),
// since what is seen may change meanwhile.
class SeenRoom final : public Room {
 public:
  SeenRoom(std::shared_ptr<Room> room, Role role) : room_(std::move(room)), role_(role) {}

  std::vector<Layer> layers() const override {
    std::vector<Layer> layers = room_->layers();
    std::erase_if(layers, [this](const Layer& layer) { return !sees(role_, layer.visibility); });
    return layers;
  }
  Result<Layer> layer(const std::string& ref) const override {
    auto layer = room_->layer(ref);
    if (layer && !sees(role_, layer->visibility)) return no_such_layer(ref);
    return layer;
  }
  std::unique_ptr<Member> join(Author who, Portrait portrait, Listener* listener,
                               stream::Viewer::Send send) override {
    return room_->join({std::move(who.user), std::min(who.role, role_)}, std::move(portrait),
                       listener, std::move(send));
  }

  Result<query::SurfacePoint> position(const glm::dvec3& world,
                                       const std::vector<std::string>& layers, At at) override {
    STRATA_TRY(check(layers));
    return room_->position(world, layers, at);
  }
  Result<std::vector<query::SurfacePoint>> positions(const std::vector<glm::dvec3>& world,
                                                     const std::vector<std::string>& layers,
                                                     At at) override {
    STRATA_TRY(check(layers));
    return room_->positions(world, layers, at);
  }
  Result<query::SurfacePoint> pick(const Camera& camera, double x, double y,
                                   const std::vector<std::string>& layers, At at) override {
    STRATA_TRY(check(layers));
    return room_->pick(camera, x, y, layers, at);
  }
  Result<query::Statistics> statistics(const std::string& layer, const Selection& selection,
                                       StatisticsWanted wanted) override {
    STRATA_TRY(check({layer}));
    return room_->statistics(layer, seen_by(selection), wanted);
  }
  Result<SelectedArea> select(const Selection& selection, const std::vector<std::string>& layers,
                              StatisticsWanted wanted) override {
    STRATA_TRY(check(layers));
    return room_->select(seen_by(selection), layers, wanted);
  }
  Result<query::Profile> profile(const ProfileLine& line, const std::vector<std::string>& layers,
                                 At at) override {
    STRATA_TRY(check(layers));
    return room_->profile(line, layers, at);
  }
  Result<query::CrossTable> cross_table(const std::string& rows, const std::string& columns,
                                        const Selection& selection) override {
    STRATA_TRY(check({rows, columns}));
    return room_->cross_table(rows, columns, seen_by(selection));
  }
  Result<query::Quantities> quantities(const std::string& layer, At at) override {
    STRATA_TRY(check({layer}));
    return room_->quantities(layer, at);
  }
  Result<LayerAreas> layer_areas(const std::string& layer, At at) override {
    STRATA_TRY(check({layer}));
    return room_->layer_areas(layer, at);
  }
  Result<query::SurfaceTexels> surface_texels(const std::string& layer,
                                              const Selection& selection) override {
    STRATA_TRY(check({layer}));
    return room_->surface_texels(layer, seen_by(selection));
  }
  Result<std::map<std::int64_t, query::KeyArea>> key_areas(const std::string& layer) override {
    STRATA_TRY(check({layer}));
    return room_->key_areas(layer);
  }
  Result<TileMirror::Snapshot> tiles(const std::string& layer, At at) override {
    STRATA_TRY(check({layer}));
    return room_->tiles(layer, at);
  }
  Result<void> pictures(const PictureRequest& asked, std::span<const PicturePart> parts,
                        const SeePicture& see) override {
    PictureRequest seen = asked;
    seen.seen_by = std::min(asked.seen_by, role_);
    if (asked.layers) {
      STRATA_TRY(check(*asked.layers));
    } else {
      seen.layers.emplace();
      std::vector<Layer> in_order = layers();
      sort_as_shown(in_order, asked.shown);
      for (const Layer& layer : in_order)
        if (asked.shown.of(layer.id).visible.value_or(layer.visible))
          seen.layers->push_back(std::to_string(layer.id));
    }
    return room_->pictures(seen, parts, see);
  }
  Result<std::vector<std::optional<std::uint32_t>>> seen_keys(const std::string& layer,
                                                              const Camera& camera, int columns,
                                                              int rows, At at) override {
    STRATA_TRY(check({layer}));
    return room_->seen_keys(layer, camera, columns, rows, at);
  }
  Result<std::vector<query::SeenLayer>> seen_layers(const std::vector<std::string>& layers,
                                                    const std::vector<query::LayerCover>& covers,
                                                    const Camera& camera, int columns, int rows,
                                                    At at) override {
    STRATA_TRY(check(layers));
    return room_->seen_layers(layers, covers, camera, columns, rows, at);
  }
  DurableState durable_state() const override {
    DurableState state = room_->durable_state();
    std::erase_if(state.provisional,
                  [&](const auto& entry) { return !layer(std::to_string(entry.first)); });
    return state;
  }

  // Nothing of layers is asked or told.
  Model model() const override { return room_->model(); }
  std::int64_t sequence() const override { return room_->sequence(); }
  std::int64_t durable_sequence() const override { return room_->durable_sequence(); }
  std::vector<Presence> presence(const Uuid& receiver) const override {
    return room_->presence(receiver);
  }
  std::shared_ptr<const mesh::Geometry> geometry() const override { return room_->geometry(); }
  std::shared_ptr<const mesh::SearchTree> search_tree() override { return room_->search_tree(); }
  Result<std::shared_ptr<const mesh::SurfaceMap>> surface_map(int resolution) override {
    return room_->surface_map(resolution);
  }
  std::vector<Look> looks() const override { return room_->looks(); }
  Result<Look> look(const std::string& ref) const override { return room_->look(ref); }
  Result<Look> create_look(Look look, std::span<const std::uint8_t> picture,
                           const store::FirstAnswer<Look>& answer) override {
    return room_->create_look(std::move(look), picture, answer);
  }
  Result<Look> update_look(const Look& look, const store::FirstAnswer<Look>& answer) override {
    return room_->update_look(look, answer);
  }
  Result<void> delete_look(std::int64_t id, const store::FirstAnswer<>& answer) override {
    return room_->delete_look(id, answer);
  }
  Result<Model> update_model(Model model, const store::FirstAnswer<Model>& answer) override {
    return room_->update_model(std::move(model), answer);
  }

  // Of a layer that was found here.
  void edit(EditRequest request, Applied applied, Saved saved) override {
    room_->edit(std::move(request), std::move(applied), std::move(saved));
  }
  Result<TileMap> dabs(const Layer& layer, const std::vector<PlacedValue>& values, double radius,
                       double tolerance) override {
    return room_->dabs(layer, values, radius, tolerance);
  }
  Result<TileMap> project(const Layer& layer, const glm::dvec3& direction,
                          const ValueAt& value_at) override {
    return room_->project(layer, direction, value_at);
  }
  Result<Layer> create_layer(Layer layer, const store::FirstAnswer<Layer>& answer,
                             std::vector<Column> columns) override {
    return room_->create_layer(std::move(layer), answer, std::move(columns));
  }
  Result<Layer> update_layer(Layer layer, const store::FirstAnswer<Layer>& answer) override {
    return room_->update_layer(std::move(layer), answer);
  }
  Result<Layer> widen_layer(const Layer& layer, ValueType type,
                            const store::FirstAnswer<Layer>& answer) override {
    return room_->widen_layer(layer, type, answer);
  }
  Result<void> delete_layer(std::int64_t id, const store::FirstAnswer<>& answer) override {
    return room_->delete_layer(id, answer);
  }
  Result<void> bin_layer(std::int64_t id, const store::FirstAnswer<>& answer) override {
    return room_->bin_layer(id, answer);
  }
  Result<store::BinRestored> restore_layer(
      const store::BinEntry& entry, const store::FirstAnswer<store::BinRestored>& answer) override {
    return room_->restore_layer(entry, answer);
  }
  Result<Layer> layer_computed(std::int64_t id, const std::string& expression,
                               std::int64_t sequence,
                               const std::map<std::int64_t, std::int64_t>& tables) override {
    return room_->layer_computed(id, expression, sequence, tables);
  }
  Result<void> check_expression(const Expression& expression, const std::string& field,
                                Visibility layer) const override {
    return room_->check_expression(expression, field, layer);
  }

  // Of the server's own work.
  void records_changed(std::int64_t table_id) override { room_->records_changed(table_id); }
  Result<void> sum_layer(std::int64_t layer_id) override { return room_->sum_layer(layer_id); }

 private:
  Result<void> check(const std::vector<std::string>& refs) const {
    for (const std::string& ref : refs) STRATA_TRY(layer(ref));
    return {};
  }
  Selection seen_by(Selection selection) const {
    selection.seen_by = std::min(selection.seen_by, role_);
    return selection;
  }

  const std::shared_ptr<Room> room_;
  const Role role_;
};

}  // namespace

std::shared_ptr<Room> seen_as(std::shared_ptr<Room> room, Role role) {
  if (sees(role, Visibility::curators)) return room;
  return std::make_shared<SeenRoom>(std::move(room), role);
}

tl::unexpected<Error> no_such_layer(const std::string& ref) {
  return no_such("layer", ref, "layer");
}

}  // namespace strata::room
