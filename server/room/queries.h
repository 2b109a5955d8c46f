#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "domain/layers/tile_mirror.h"
#include "query/sampling/profile.h"
#include "query/sampling/texel_samples.h"
#include "query/sampling/values.h"
#include "query/statistics/cross_table.h"
#include "query/statistics/key_areas.h"
#include "query/statistics/perimeter.h"
#include "query/statistics/quantities.h"
#include "query/statistics/statistics.h"
#include "room/selection.h"

namespace strata::room {

// A state of a layer and what was measured of it.
struct LayerAreas {
  query::LayerView view;
  std::shared_ptr<const mesh::SurfaceMap> map;  // of the layer's resolution
  query::Quantities quantities;
  query::Perimeters perimeters;
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

// Questions to an open model; they may take a while the first time (search tree, surface map), so
// call from a worker thread. Values of the given layers only. Refused (invalid, `at`): a sequence
// that is not durable yet. Thread-safe.
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
  virtual Result<std::map<std::int64_t, query::KeyArea>> key_areas(
      const std::string& layer) = 0;  // of a database layer
  virtual Result<TileMirror::Snapshot> tiles(const std::string& layer, At at) = 0;
};

}  // namespace strata::room
