// Values of the layers at places of a plane (OGC API Environmental Data Retrieval).
#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/polygon_area.h"
#include "core/text/timestamp.h"
#include "domain/people/question.h"
#include "domain/scene/model.h"
#include "mesh/surface/geometry.h"
#include "net/api/addressed.h"
#include "net/api/ogc/coverage_json.h"
#include "net/api/ogc/ogc_collections.h"
#include "net/api/ogc/ogc_request.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/entity_tags.h"
#include "net/serialization/as_of.h"
#include "query/maps/wkt.h"
#include "room/layers.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/surface.h"

namespace strata::net {
namespace {

constexpr std::size_t kMostPoints = 1000;     // of `position`; more do not fit into an address
constexpr double kMostPlaces = 10'000;        // of `trajectory`
constexpr std::uint64_t kBytesOfValue = 256;  // as JSON of a point
constexpr std::uint64_t kBytesOfCell = 48;    // of a grid as JSON

// A request for values: the requested layers in one state, and the plane.
struct Sampling {
  std::shared_ptr<room::Room> room;
  Model model;
  app::GisPlane plane;
  app::GisSystem system;  // of the coordinates in the request and in the response
  query::WktGeometry geometry;
  std::vector<Layer> layers;
  std::vector<query::LayerView> views;
  room::At at;
  std::string time;  // of the state
  CoverageSystem coverage;

  std::shared_ptr<const mesh::SearchTree> tree;
  query::PlaneView view() const {
    return {*tree,
            room->surface().geometry()->origin,
            plane.outline(),
            plane.looks_up(),
            model.bounds_min,
            model.bounds_max};
  }
  // Returns a place of the plane for coordinates in the request.
  Result<glm::dvec2> read(const glm::dvec2& coordinates) const {
    const auto place = plane.read(coordinates, system);
    if (place) return *place;
    return fail(ErrorCode::malformed, "Coordinates out of range",
                "`coords` contains a place outside the coordinate system of the model.", "coords");
  }
};

Result<Sampling> sampling_of(const RouteContext& context, const Request& request,
                             query::WktGeometry::Kind kind, const char* geometries) {
  STRATA_TRY(check_format(request, {"CoverageJSON", "covjson", "json"}));
  auto geometry = STRATA_TRY(query::parse_wkt(request.query_or("coords", {}), "coords"));
  if (geometry.kind != kind)
    return fail(ErrorCode::malformed, "Wrong geometry",
                std::string("`coords` must be a ") + geometries + ".", "coords");
  const auto datetime = STRATA_TRY(datetime_of(request));
  auto room = STRATA_TRY(open_room(context, request));
  const Model model = room->model();
  auto plane = STRATA_TRY(plane_of(request, model));
  const std::string base = ogc_base(context, request);
  const auto system = STRATA_TRY(system_of(request, "crs", plane, model, base));
  std::vector<Layer> layers = room->layers().all();
  if (const auto names = request.query.find("parameter-name"); names != request.query.end()) {
    auto found = find_layers(*room, split_list(names->second), "parameter-name");
    if (!found) {
      Error problem = found.error();
      problem.code = ErrorCode::malformed;
      return tl::unexpected(std::move(problem));
    }
    layers = std::move(*found);
  }
  const auto at = STRATA_TRY(find_sequence(context, *room, datetime));
  std::vector<query::LayerView> views;
  for (const Layer& layer : layers) {
    auto tiles = STRATA_TRY(room->queries().tiles(layer.slug, at));
    views.push_back({layer, std::move(tiles)});
  }
  CoverageSystem coverage = system_of_plane(plane, uri_of(plane, model, base));
  if (system == app::GisSystem::degrees) coverage = {std::string(kCrs84), true, false};
  std::string time =
      datetime ? std::get<std::string>(*datetime) : utc_text(std::chrono::system_clock::now());
  auto tree = room->surface().search_tree();
  return Sampling{std::move(room),     model,
                  std::move(plane),    system,
                  std::move(geometry), std::move(layers),
                  std::move(views),    at,
                  std::move(time),     std::move(coverage),
                  std::move(tree)};
}

// Returns a number or null for each layer at a place of the surface.
std::vector<nlohmann::json> values_at(const Sampling& sampling,
                                      const std::optional<mesh::SearchTree::Hit>& hit) {
  std::vector<nlohmann::json> values;
  for (const query::LayerView& view : sampling.views) {
    const auto value = hit ? query::value_at(view, hit->uv) : query::LayerValue();
    values.push_back(value.valid ? number_json(view.layer.type, value.value) : nlohmann::json());
  }
  return values;
}

// Returns the surface at a point of the request. With a height, it is the nearest place of the
// surface, otherwise the first one in the direction of view.
Result<std::optional<mesh::SearchTree::Hit>> surface_at(const Sampling& sampling,
                                                        const glm::dvec3& point) {
  const auto place = STRATA_TRY(sampling.read(glm::dvec2(point)));
  if (!sampling.geometry.has_heights) return sampling.view().first_hit(place);
  glm::dvec3 world;
  world[sampling.plane.axis().u] = place.x;
  world[sampling.plane.axis().v] = place.y;
  world[sampling.plane.depth()] = point.z / sampling.plane.metres();
  return sampling.tree->nearest(glm::vec3(world - sampling.room->surface().geometry()->origin),
                                std::numeric_limits<float>::max());
}

Response coverage_response(nlohmann::json coverage, const CoverageSystem& system) {
  Response response = json_response(coverage);
  response.headers = {{"Content-Type", kCoverageJsonType}};
  response.with("Content-Crs", "<" + system.uri + ">");
  return response;
}

Result<Response> position(const RouteContext& context, const Request& request) {
  const auto sampling = STRATA_TRY(sampling_of(context, request, query::WktGeometry::Kind::points,
                                               "POINT or MULTIPOINT, with or without a height"));
  const auto& parts = sampling.geometry.parts;
  if (parts.size() > kMostPoints)
    return fail(ErrorCode::malformed, "Too many points",
                "`coords` can have at most " + std::to_string(kMostPoints) + " points.", "coords");
  const std::size_t values = parts.size() * (1 + sampling.layers.size());
  const QuestionMemory held(kBytesOfValue * values);
  if (Question* question = Question::current()) question->spend(values);
  std::vector<PlacedValues> places;
  for (const query::FlatPolygon& part : parts) {
    check_question();
    const glm::dvec3 point = part.rings.front().front();
    const auto hit = STRATA_TRY(surface_at(sampling, point));
    places.push_back({sampling.coverage.place_of(glm::dvec2(point)), values_at(sampling, hit)});
  }
  return coverage_response(point_coverages_json(places, sampling.layers, sampling.coverage),
                           sampling.coverage);
}

// Returns the size of a cell for all layers: that of the finest layer.
double finest_cell(const Sampling& sampling) {
  double finest = std::numeric_limits<double>::infinity();
  for (const Layer& layer : sampling.layers)
    finest = std::min(finest, cell_of(sampling.model, layer));
  return std::isfinite(finest) ? finest : 1;
}

Result<Response> trajectory(const RouteContext& context, const Request& request) {
  const auto sampling =
      STRATA_TRY(sampling_of(context, request, query::WktGeometry::Kind::line, "LINESTRING"));
  const query::FlatRing& path = sampling.geometry.parts.front().rings.front();
  std::vector<glm::dvec2> corners;
  double length = 0;
  for (const glm::dvec3& point : path) {
    corners.push_back(STRATA_TRY(sampling.read(glm::dvec2(point))));
    if (corners.size() > 1) length += glm::distance(corners[corners.size() - 2], corners.back());
  }
  // The places between the corners are as close as texels, unless they would be too many.
  const double step = std::max(finest_cell(sampling), length / kMostPlaces);
  const double most = std::min(kMostPlaces, length / step) + double(corners.size());
  const auto values = static_cast<std::uint64_t>(most * double(1 + sampling.layers.size()));
  const QuestionMemory held(kBytesOfValue * values);
  if (Question* question = Question::current()) question->spend(values);
  std::vector<PlacedValues> places;
  const query::PlaneView view = sampling.view();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    check_question();
    const glm::dvec2 from = corners[i], to = corners[std::min(i + 1, corners.size() - 1)];
    const int count =
        i + 1 == corners.size()
            ? 1
            : static_cast<int>(std::max(1.0, std::ceil(glm::distance(from, to) / step)));
    for (int k = 0; k < count; ++k) {
      const glm::dvec2 place = glm::mix(from, to, static_cast<double>(k) / count);
      if (const auto written = sampling.plane.write(place, sampling.system))
        places.push_back(
            {sampling.coverage.place_of(*written), values_at(sampling, view.first_hit(place))});
    }
  }
  return coverage_response(
      trajectory_coverage_json(places, sampling.time, sampling.layers, sampling.coverage),
      sampling.coverage);
}

Result<Response> area(const RouteContext& context, const Request& request) {
  auto sampling = STRATA_TRY(
      sampling_of(context, request, query::WktGeometry::Kind::areas, "POLYGON or MULTIPOLYGON"));
  // Cells are square only on the plane, so a client that asks for degrees must not get a grid.
  if (request.query.contains("crs") && sampling.system == app::GisSystem::degrees)
    return fail(ErrorCode::malformed, "No grid in degrees",
                "The response is a grid in " +
                    uri_of(sampling.plane, sampling.model, ogc_base(context, request)) +
                    ". Omit `crs`, or send this system.",
                "crs");
  if (sampling.layers.empty())
    return fail(ErrorCode::malformed, "No layers", "The model has no layers that you can see.",
                "parameter-name");
  std::vector<std::vector<glm::dvec2>> rings;
  for (const query::FlatPolygon& polygon : sampling.geometry.parts)
    for (const query::FlatRing& ring : polygon.rings) {
      rings.emplace_back();
      for (const glm::dvec3& corner : ring)
        rings.back().push_back(STRATA_TRY(sampling.read(glm::dvec2(corner))));
    }
  const PolygonArea inside(rings);
  const app::GisPlane::Box bounds = bounds_of(sampling.model, sampling.plane);
  const app::GisPlane::Box window{glm::max(inside.low(), bounds.low),
                                  glm::min(inside.high(), bounds.high)};
  if (!(window.low.x <= window.high.x && window.low.y <= window.high.y))
    return fail(ErrorCode::malformed, "Outside the model",
                "`coords` does not touch the model. See the extent of the collection.", "coords");
  const double cell = finest_cell(sampling);
  const glm::dvec2 size =
      limited(cells_of(window, cell), kMostJsonCells / static_cast<double>(sampling.layers.size()));
  const query::PlaneGrid grid{window.low,
                              window.low + glm::max(window.high - window.low, glm::dvec2(cell)),
                              static_cast<int>(size.x), static_cast<int>(size.y)};
  const QuestionMemory held(kBytesOfCell * static_cast<std::uint64_t>(size.x * size.y) *
                            sampling.layers.size());
  const auto rasters =
      query::resample(sampling.view(), sampling.views, grid,
                      [&](const glm::dvec2& place) { return inside.contains(place); });
  sampling.coverage = system_of_plane(
      sampling.plane, uri_of(sampling.plane, sampling.model, ogc_base(context, request)));
  const double metres = sampling.plane.metres();
  return coverage_response(
      grid_coverage_json(metres * grid.center_of(0, 0),
                         metres * grid.center_of(grid.width - 1, grid.height - 1), sampling.layers,
                         rasters, sampling.coverage),
      sampling.coverage);
}

}  // namespace

void add_ogc_query_routes(Router& router, const RouteContext& context) {
  using Answer = Result<Response> (*)(const RouteContext&, const Request&);
  const auto add = [&](const char* query, Answer answer) {
    router.add({.method = Method::get,
                .pattern = std::string("/ogc/collections/{model}/") + query,
                .handler = answering([&context, answer](const Request& request) {
                  return answer(context, request);
                }),
                .query = {"coords", "crs", "parameter-name", "datetime", "f", "along"},
                .is_question = true,
                .state = state_of_model(context)});
  };
  add("position", position);
  add("trajectory", trajectory);
  add("area", area);
}

}  // namespace strata::net
