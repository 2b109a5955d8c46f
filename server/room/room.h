#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/memory_ledger.h"
#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "domain/people/person_color.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "domain/scene/look.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "expression/expression.h"
#include "media/picture.h"
#include "query/sampling/profile.h"
#include "query/sampling/seen_layers.h"
#include "query/sampling/texel_samples.h"
#include "query/sampling/values.h"
#include "query/statistics/cross_table.h"
#include "query/statistics/key_areas.h"
#include "query/statistics/perimeter.h"
#include "query/statistics/quantities.h"
#include "query/statistics/statistics.h"
#include "room/edit.h"
#include "store/content/bin.h"
#include "store/content/first_answer.h"
#include "store/store.h"
#include "stream/viewer.h"

namespace strata::room {

// What the people in a room hear. Called on the room's strand, in one order for all; must return
// quickly (post to a socket).
class Listener {
 public:
  virtual ~Listener() = default;
  struct Edit {
    std::int64_t layer_id = 0;
    std::string layer;  // slug
    std::int64_t sequence = 0;
    Uuid id, stroke;
    int n = 0;
    bool is_stroke = false;
    std::string user, op;
    EditAnswer answer;
    struct Review {
      Decision decision = Decision::accept;
      std::string reason;
      std::vector<std::string> authors;  // of what was reviewed
    };
    std::optional<Review> review{};
  };
  // visible, not yet durable
  virtual void edit_applied(const Edit& edit) = 0;
  // rolled back
  virtual void edits_unsaved(const std::vector<Edit>& edits, const Error& why) = 0;
  enum class LayerChange { created, changed, deleted };
  virtual void layer_changed(LayerChange change, const Layer& layer) = 0;
  virtual void look_changed(LayerChange change, const Look& look) = 0;
  virtual void model_changed(const Model& model) = 0;
  virtual void model_deleted() = 0;  // nothing else follows
  virtual void presence_changed() = 0;
  // Of this person's own view, and on the GPU thread: it cannot be drawn as asked for, until
  // something changes.
  virtual void view_refused(std::uint32_t view_id, const Error& why) = 0;
};

// Records of a database layer that are to be seen before all others.
struct Highlight {
  // keys, ascending; or a condition over columns
  std::variant<std::vector<std::uint32_t>, Expression> records;
  bool isolate = false;  // the others are not drawn at all
  bool operator==(const Highlight&) const = default;
};

// Layers as one person sees them; what is not set follows the layer's default.
struct LayerView {
  std::int64_t layer_id = 0;
  std::optional<bool> visible;
  std::optional<double> opacity;
  std::optional<Palette> palette;
  std::optional<Highlight> highlight;  // database layers
  std::optional<int> order{};          // drawn ascending, as Layer::order
};

struct LookView {
  std::int64_t look_id = 0;
  double opacity = 1;
};

// What one person's view shows.
struct ViewSettings {
  std::vector<LayerView> layers;
  std::optional<std::vector<LookView>> looks;  // bottom to top; nothing: those visible by default
  Light light;
  Background background{};

  // What it says of a layer; of one that it does not name, nothing.
  const LayerView& of(std::int64_t layer_id) const {
    static const LayerView kNothing;
    const auto last = std::find_if(layers.rbegin(), layers.rend(),
                                   [&](const auto& own) { return own.layer_id == layer_id; });
    return last == layers.rend() ? kNothing : *last;
  }
};

inline const Layer& layer_in(const Layer& layer) { return layer; }
template <class State>
const Layer& layer_in(const State& state) {
  return state.layer;
}

// Layers, or what has one as `layer`, from bottom to top as somebody sees them; `of`: what they set
// of a layer, by id.
template <class Layers, class Of>
void sort_as_shown(Layers& layers, const Of& of) {
  const auto place = [&](const auto& each) {
    const Layer& layer = layer_in(each);
    const LayerView* own = of(layer.id);
    return own && own->order ? *own->order : layer.order;
  };
  std::stable_sort(layers.begin(), layers.end(),
                   [&](const auto& a, const auto& b) { return place(a) < place(b); });
}
template <class Layers>
void sort_as_shown(Layers& layers, const ViewSettings& shown) {
  sort_as_shown(layers, [&](std::int64_t id) { return &shown.of(id); });
}

// Where somebody points on the surface.
struct Pointing {
  glm::dvec3 position{0};        // world
  std::optional<double> radius;  // world, of the brush in hand
};

// How others see a person.
struct Portrait {
  std::string full_name{};  // empty: none was given
  std::string color{kNobodysColor};
};

// What is known of one connection to the others; never stored.
struct Presence {
  Uuid session;
  std::string user;
  std::string full_name;  // empty: none was given
  std::string color;      // #rrggbb
  std::optional<Pointing> pointer{};
  bool leading = false;             // asks the others to look with them
  std::optional<Uuid> following{};  // session of whom they look with
  std::optional<Camera> camera{};   // newest of view 0 without its section, for who follows them
};

// A state of a layer and what was measured of it.
struct LayerAreas {
  query::LayerView view;
  std::shared_ptr<const mesh::SurfaceMap> map;  // of the layer's resolution
  query::Quantities quantities;
  query::Perimeters perimeters;
};

class Room;

// One connection in a room. Methods are thread-safe and return at once. Destroying it leaves the
// room.
class Member {
 public:
  static constexpr int kMaxViews = 4;
  virtual ~Member() = default;
  virtual Uuid session() const = 0;
  virtual void camera(std::uint32_t view_id, std::uint64_t seq, const Camera& camera,
                      bool moving) = 0;
  // Replaces everything that was set before for this view.
  virtual Result<void> show(std::uint32_t view_id, ViewSettings settings) = 0;
  virtual void ack(std::uint32_t view_id, std::uint64_t frame) = 0;
  virtual void edits() = 0;  // its person does: onlookers do not hold up what they see of it
  virtual void pointer(std::optional<Pointing> at) = 0;
  // Replaces what was said before. Refused as a whole, in `follow`: a session that is not here
  // (not_found), one that follows this one (conflict).
  virtual Result<void> look_together(bool leading, const std::optional<Uuid>& follow) = 0;
};

// A part of the surface, by what the layers held and where it lies.
struct Selection {
  std::optional<Expression> where{};  // a condition
  struct Around {
    // connected with a place within a distance from it (query::select_near)
    Place at;
    double radius = 0;  // model units
  };
  std::optional<std::variant<Around, Outline>> within{};
  std::optional<std::int64_t> at{};  // layers as they were after that sequence; absent: as they are
  Role seen_by = Role::owner;        // what this role does not see `where` cannot name
  bool whole() const { return !where && !within; }
};
struct StatisticsWanted {  // that takes longer
  bool quantiles = false, pieces = false, perimeter = false;
};
struct SelectedArea {
  int resolution = 0;  // of the texels that are counted
  std::uint64_t texels = 0;
  double area_m2 = 0, share = 0;                    // of the whole surface
  glm::dvec3 bounds_min{0}, bounds_max{0};          // world, where there is a texel
  std::map<std::string, query::Statistics> layers;  // by slug: what they hold there
};

struct PlacesInSteps {             // of which each the nearest surface point is taken
  std::vector<glm::dvec3> places;  // world; 2 at least
  double step = 0;                 // model units, above 0
};
struct SeenLine {
  Camera camera;
  std::vector<glm::dvec2> path;  // window pixels, origin top left; 2 at least
};
using ProfileLine = std::variant<PlacesInSteps, SeenLine>;

struct PictureRequest {
  // exactly these, by slug; nothing: those that are visible
  std::optional<std::vector<std::string>> layers{};
  ViewSettings shown{};
  std::optional<std::int64_t> at{};  // layers as they were after that sequence
  // With `at`, by layer: what waited for review then, and is hatched. Without, what waits now is.
  std::map<std::int64_t, TileMap> provisional{};
  Role seen_by = Role::owner;  // columns that it does not see neither draw nor colour
};

// A camera with a picture of its own, which has so many pixels to one of its window's.
struct PicturePart {
  Camera camera;
  double pixels = 1;
};

// One open model, as somebody sees it: layers that they do not see are not there. The only place
// that joins store, renderer, streams and queries: keeps the order of edits, the tile mirrors,
// undo, the journal and who is there. All methods are thread-safe; callbacks run on the room's
// strand.
class Room {
 public:
  virtual ~Room() = default;

  virtual Model model() const = 0;
  virtual std::vector<Layer> layers() const = 0;
  virtual Result<Layer> layer(const std::string& ref) const = 0;  // id or slug
  virtual std::int64_t sequence() const = 0;
  virtual std::int64_t durable_sequence() const = 0;
  // The newest state that a picture can show `at`, and by layer what of it waits for review, where
  // anything does (room/provisional.h).
  struct DurableState {
    std::int64_t sequence = 0;
    std::map<std::int64_t, TileMap> provisional;
  };
  virtual DurableState durable_state() const = 0;

  // `applied` when it is visible (may be empty), `saved` when it is durable or has failed: exactly
  // one call of `saved`. What is refused for the number of edits is so at once, on the calling
  // thread.
  using Applied = std::function<void(const EditAnswer&)>;
  using Saved = std::function<void(Result<EditAnswer>)>;
  virtual void edit(EditRequest request, Applied applied, Saved saved) = 0;

  // Frames and what the listener hears are of layers and columns that they see, from one moment to
  // the next.
  virtual std::unique_ptr<Member> join(Author who, Portrait portrait, Listener* listener,
                                       stream::Viewer::Send send) = 0;
  // Everyone, as told to one of the sessions: of all cameras only that of whom it follows.
  virtual std::vector<Presence> presence(const Uuid& receiver) const = 0;

  // Metadata; blocking (database), announced to the listeners.
  // A database layer that names no table gets one of its own name with `columns`.
  virtual Result<Layer> create_layer(Layer layer, const store::FirstAnswer<Layer>& answer = {},
                                     std::vector<Column> columns = {}) = 0;
  // Of a layer that it locks every edit that had begun is durable, or refused, when it returns.
  virtual Result<Layer> update_layer(Layer layer, const store::FirstAnswer<Layer>& answer = {}) = 0;
  // The layer with room for larger keys or values, its history too; `layer` as it was read. Refused
  // (invalid, `type`): a type that it does not widen to, and a computed layer.
  virtual Result<Layer> widen_layer(const Layer& layer, ValueType type,
                                    const store::FirstAnswer<Layer>& answer = {}) = 0;
  // for ever
  virtual Result<void> delete_layer(std::int64_t id, const store::FirstAnswer<>& answer = {}) = 0;
  // Into the Bin, and out of it: who restored layers hear of is one that is made.
  virtual Result<void> bin_layer(std::int64_t id, const store::FirstAnswer<>& answer) = 0;
  virtual Result<store::BinRestored> restore_layer(
      const store::BinEntry& entry, const store::FirstAnswer<store::BinRestored>& answer) = 0;
  // A ComputeEdit of the layer was durable with this sequence, and the tables that its expression
  // reads stood there before it.
  virtual Result<Layer> layer_computed(std::int64_t id, const std::string& expression,
                                       std::int64_t sequence,
                                       const std::map<std::int64_t, std::int64_t>& tables) = 0;
  // Records of a table have changed: layers that are computed from them are stale, those that take
  // their colours from its terms others.
  virtual void records_changed(std::int64_t table_id) = 0;
  // Whether a formula for a computed layer can be evaluated here. Refused (invalid at `field`) as
  // by bind_for_layer.
  virtual Result<void> check_expression(const Expression& expression, const std::string& field,
                                        Visibility layer) const = 0;
  virtual Result<Model> update_model(Model model, const store::FirstAnswer<Model>& answer = {}) = 0;

  // Queries; may take a while the first time (search tree, surface map), so call from a worker
  // thread. Values of the given layers only, as they were after a sequence or as they are. Refused
  // (invalid, `at`): a sequence that is not durable yet.
  using At = std::optional<std::int64_t>;
  virtual Result<query::SurfacePoint> position(const glm::dvec3& world,
                                               const std::vector<std::string>& layers,
                                               At at = {}) = 0;
  virtual Result<std::vector<query::SurfacePoint>> positions(const std::vector<glm::dvec3>& world,
                                                             const std::vector<std::string>& layers,
                                                             At at = {}) = 0;
  virtual Result<query::SurfacePoint> pick(const Camera& camera, double x, double y,
                                           const std::vector<std::string>& layers, At at = {}) = 0;
  virtual Result<query::Statistics> statistics(const std::string& layer,
                                               const Selection& selection = {},
                                               StatisticsWanted wanted = {}) = 0;
  // Counts texels of the finest layer that is named or asked of; of the model's default where none
  // is.
  virtual Result<SelectedArea> select(const Selection& selection,
                                      const std::vector<std::string>& layers,
                                      StatisticsWanted wanted = {}) = 0;
  // The surface along a line; `layers` as for `position`.
  virtual Result<query::Profile> profile(const ProfileLine& line,
                                         const std::vector<std::string>& layers, At at = {}) = 0;
  // What two layers of whole numbers hold together, at the finer one's texels.
  virtual Result<query::CrossTable> cross_table(const std::string& rows, const std::string& columns,
                                                const Selection& selection = {}) = 0;
  // How much there is of each class of the layer's legend (query::classes_of).
  virtual Result<query::Quantities> quantities(const std::string& layer, At at = {}) = 0;
  // The same with the borders of those classes (query::measure_perimeters; model units) and the
  // texels, all of one state.
  virtual Result<LayerAreas> layer_areas(const std::string& layer, At at = {}) = 0;
  // A layer with the places of its texels where the selection holds, to be read at leisure.
  virtual Result<query::SurfaceTexels> surface_texels(const std::string& layer,
                                                      const Selection& selection = {}) = 0;
  // What maps and measurements paint (query/maps/flat_map, query/maps/dabs), for an ImportEdit
  // `over` the layer. Values are bits of its type.
  struct PlacedValue {
    glm::dvec3 world{0};
    std::uint32_t bits = 0;
    int line = 0;  // of the text that they came from
  };
  // Around the surface point nearest to each place, which may lie `tolerance` from it (model
  // units): refused otherwise (invalid).
  virtual Result<TileMap> dabs(const Layer& layer, const std::vector<PlacedValue>& values,
                               double radius, double tolerance) = 0;
  // The surface that is seen first along a direction, without perspective, by a function of its
  // place in the world.
  using ValueAt = std::function<std::optional<std::uint32_t>(const glm::dvec3& world)>;
  virtual Result<TileMap> project(const Layer& layer, const glm::dvec3& direction,
                                  const ValueAt& value_at) = 0;
  virtual Result<std::map<std::int64_t, query::KeyArea>> key_areas(
      const std::string& layer) = 0;  // of a database layer
  // Counts all tiles of a layer for the journal's sums (store::Layers::keep_sums). Edits wait
  // meanwhile.
  virtual Result<void> sum_layer(std::int64_t layer_id) = 0;
  virtual Result<TileMirror::Snapshot> tiles(const std::string& layer,
                                             std::optional<std::int64_t> at) = 0;
  // What the model is, for work that computes on the whole surface. The tree is built and the map
  // baked when first asked for.
  virtual std::shared_ptr<const mesh::Geometry> geometry() const = 0;
  virtual std::shared_ptr<const mesh::SearchTree> search_tree() = 0;
  virtual Result<std::shared_ptr<const mesh::SurfaceMap>> surface_map(int resolution) = 0;
  // Pictures, RGBA8, top row first; waits for them and for the looks they show. `see` gets each in
  // turn, in bands of its whole width from the top, and may end it with an Error: a large picture
  // is nowhere as a whole, and between its bands others have theirs. With `at` all show one state,
  // also while others paint.
  struct PictureBand {
    int width = 0, height = 0;  // of the whole picture
    int top = 0, rows = 0;      // of the band
    std::span<const std::uint8_t> rgba;
  };
  using SeePicture = std::function<Result<void>(std::size_t part, const PictureBand& band)>;
  virtual Result<void> pictures(const PictureRequest& request, std::span<const PicturePart> parts,
                                const SeePicture& see) = 0;
  // One, as a whole; as a file.
  Result<render::Frame> picture(const PictureRequest& request, const Camera& camera);
  Result<std::vector<std::uint8_t>> picture_file(const PictureRequest& request,
                                                 const Camera& camera, PictureFormat format,
                                                 JpegSettings jpeg);
  // What a layer of whole numbers has where it is seen: in the middle of each cell of a grid over
  // the camera's window, row by row from the top left. Nothing: no surface, or nothing painted
  // there.
  virtual Result<std::vector<std::optional<std::uint32_t>>> seen_keys(const std::string& layer,
                                                                      const Camera& camera,
                                                                      int columns, int rows,
                                                                      At at = {}) = 0;
  // What is seen of layers (bottom to top) over a camera's window; `covers`: one for each. See
  // query::seen_layers.
  virtual Result<std::vector<query::SeenLayer>> seen_layers(
      const std::vector<std::string>& layers, const std::vector<query::LayerCover>& covers,
      const Camera& camera, int columns, int rows, At at = {}) = 0;

  // Pictures of the surface. Changes block (database) and are announced to the listeners.
  virtual std::vector<Look> looks() const = 0;  // by order
  virtual Result<Look> look(const std::string& ref) const = 0;
  virtual Result<Look> create_look(Look look, std::span<const std::uint8_t> picture,
                                   const store::FirstAnswer<Look>& answer = {}) = 0;
  virtual Result<Look> update_look(const Look& look,
                                   const store::FirstAnswer<Look>& answer = {}) = 0;
  virtual Result<void> delete_look(std::int64_t id, const store::FirstAnswer<>& answer = {}) = 0;
};

struct RoomOptions {
  std::chrono::seconds close_after{60};  // after the last user left
  // of a room, not yet answered; more are refused (too_many_requests)
  std::size_t max_waiting_edits = 512;
  std::chrono::milliseconds retry_for{30'000};  // commits that fail
  std::chrono::milliseconds drain_for{40'000};  // longer than commits are retried
  // Budget of what open models hold in main memory: geometry, surface maps, layers. 0: 60 % of the
  // machine's or the container's.
  std::uint64_t memory_bytes = 0;
};

// Opens rooms on first use and closes them after the last user left.
class Rooms {
 public:
  Rooms(store::Store& store, render::Renderer& renderer, stream::StreamContext stream,
        RoomOptions options);
  ~Rooms();
  // Blocking: loads the model (geometry and layers) when it is not open. Where memory is used up,
  // rooms that nobody is in are closed for it. `seen_by`: what they may do in the project; the
  // server itself sees all, as its owner.
  Result<std::shared_ptr<Room>> open(const std::string& model_ref, Role seen_by);
  // in the models that are open (Room::records_changed)
  void records_changed(std::int64_t table_id);
  // From now on edits that would paint the key of the table are refused (conflict). Those that were
  // let in are durable when it returns; of an Error this is not known, and the key is retired all
  // the same. Blocks.
  Result<void> retire_key(std::int64_t table_id, std::int64_t key);
  // Returns when every edit that was let in is durable. Of an Error this is not known, and to ask
  // again is right. Blocks.
  Result<void> settle();
  // they have records again
  void admit_keys(std::int64_t table_id, std::span<const std::int64_t> keys);
  void forget(std::int64_t model_id);  // the model was deleted: members are told, the room closes
  std::size_t open_rooms() const;
  std::uint64_t memory_bytes_used() const;
  // of what open models, and pictures on their way to one, hold; thread-safe
  MemoryLedger& memory();
  // Refuses new edits, and returns when every other is durable or refused, after `drain_for` at the
  // latest: then what still waits is refused.
  void drain();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::room
