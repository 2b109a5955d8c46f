#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "domain/layers/tile_mirror.h"
#include "query/conditions/texel_selection.h"
#include "query/sampling/values.h"
#include "query/statistics/perimeter.h"
#include "query/statistics/quantities.h"
#include "query/statistics/statistics.h"
#include "room/place.h"
#include "room/selection.h"

namespace strata::mesh {
struct SurfaceMap;
}
namespace strata::query {
struct CrossTable;
struct KeyArea;
struct Profile;
struct SurfaceTexels;
}  // namespace strata::query

namespace strata::room {

// A state of a layer, with its measurements.
struct LayerAreas {
  query::LayerView view;
  std::shared_ptr<const mesh::SurfaceMap> map;  // of the layer's resolution
  query::Quantities quantities;
  query::Perimeters perimeters;
};

// An image of the selection: the cells of a grid over the camera's window.
struct SeenGrid {
  Camera camera;
  int columns = 0, rows = 0;
};
struct StatisticsOptions {  // options that take more time
  bool quantiles = false, pieces = false, perimeter = false;
  // for `select`:
  std::optional<SeenGrid> seen{};
  std::optional<std::string> painted{};  // slug of the layer on which the selection is painted
};
struct SelectedArea {
  int resolution = 0;  // resolution of the counted texels
  std::uint64_t texels = 0;
  double area_m2 = 0, share = 0;            // fraction of the whole surface
  glm::dvec3 bounds_min{0}, bounds_max{0};  // in world coordinates; only set if there is a texel
  std::map<std::string, query::Statistics> layers;  // by slug: the values of each layer in the area
  // For StatisticsOptions::seen, row by row from the top left. 1 where the camera sees the area.
  std::vector<std::uint8_t> seen{};
  // For StatisticsOptions::painted: the selection at the resolution of that layer. Not set if the
  // whole surface is selected.
  struct Texels {
    int resolution = 0;
    query::TexelSelection texels;
  };
  std::optional<Texels> painted{};
};

struct LayerDifference {  // between two states of a layer
  std::uint64_t texels = 0;
  double area_m2 = 0, share = 0;  // fraction of the whole surface
};

struct PlacesInSteps {             // uses the nearest surface point for each position
  std::vector<glm::dvec3> places;  // in world coordinates; at least 2
  double step = 0;                 // in model units, above 0
};
struct SeenLine {
  Camera camera;
  std::vector<glm::dvec2> path;  // window pixels, origin top left; at least 2
};
struct UnrolledLine {  // on a sheet (Surface::sheet)
  mesh::FitRequest fit;
  std::optional<double> cut;     // in radians
  std::vector<glm::dvec2> path;  // in model units on the sheet; at least 2
  double step = 0;               // in model units, above 0
};
using ProfileLine = std::variant<PlacesInSteps, SeenLine, UnrolledLine>;

// Questions to an open model. The first questions also build the search tree and the surface maps,
// so call from a worker thread. Answers contain only values of the given layers. Returns an
// `invalid` error at `at` for a sequence that is not durable yet. Thread-safe.
class Queries {
 public:
  virtual ~Queries() = default;
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
                                               StatisticsOptions options = {}) = 0;
  // Counts the texels of the finest layer in `layers`, in the condition, or on which the selection
  // is painted. Without a layer, uses the default resolution of the model.
  virtual Result<SelectedArea> select(const Selection& selection,
                                      const std::vector<std::string>& layers,
                                      StatisticsOptions options = {}) = 0;
  // Returns the selected texels of the resolution whose texels `select` counts, without other
  // layers. The selection must not be the whole surface.
  virtual Result<SelectedArea::Texels> selected_texels(const Selection& selection) = 0;
  // Returns the surface along a line, with the values of `layers`.
  virtual Result<query::Profile> profile(const ProfileLine& line,
                                         const std::vector<std::string>& layers, At at = {}) = 0;
  // Returns how the values of two layers of whole numbers coincide, at the texels of the finer
  // layer.
  virtual Result<query::CrossTable> cross_table(const std::string& rows, const std::string& columns,
                                                const Selection& selection = {}) = 0;
  // Returns the amount of each class of the layer's legend (query::classes_of).
  virtual Result<query::Quantities> quantities(const std::string& layer, At at = {}) = 0;
  // Like `quantities`, with the borders of the classes (query::measure_perimeters, in model units)
  // and the texels. All data is from the same state.
  virtual Result<LayerAreas> layer_areas(const std::string& layer, At at = {}) = 0;
  // Returns a layer with the positions of its texels in the selection. The result stays valid after
  // later edits.
  virtual Result<query::SurfaceTexels> surface_texels(const std::string& layer,
                                                      const Selection& selection = {}) = 0;
  // Returns the area of each key. The layer must be a layer of records.
  virtual Result<std::map<std::int64_t, query::KeyArea>> key_areas(const std::string& layer,
                                                                   At at = {}) = 0;
  // Counts the changes that a restore of one state of a layer would make to another state. With
  // `outline`, counts only the changes inside it.
  virtual Result<LayerDifference> difference(const std::string& layer, At one, At other,
                                             const std::optional<Outline>& outline) = 0;
  virtual Result<TileMirror::Snapshot> tiles(const std::string& layer, At at) = 0;
};

}  // namespace strata::room
