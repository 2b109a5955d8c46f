// Layers as coverages on a plane (OGC API Coverages).
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "domain/layers/layer.h"
#include "domain/people/question.h"
#include "domain/scene/model.h"
#include "mesh/surface/geometry.h"
#include "net/api/addressed.h"
#include "net/api/ogc/coverage_json.h"
#include "net/api/ogc/ogc_collections.h"
#include "net/api/ogc/ogc_request.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/accept.h"
#include "net/http/entity_tags.h"
#include "net/serialization/as_of.h"
#include "query/maps/geotiff.h"
#include "query/maps/plane_raster.h"
#include "room/layers.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/surface.h"

namespace strata::net {
namespace {

// The memory for each cell of a file (the raster, the numbers to find a free one, and the file) and
// of JSON.
constexpr std::uint64_t kBytesOfFileCell = 24, kBytesOfJsonCell = 48;

enum class CoverageFormat { geotiff, json };
Result<CoverageFormat> coverage_format(const Request& request) {
  STRATA_TRY(check_format(request, {"tiff", "geotiff", "covjson"}));
  const std::string_view accept = request.header("accept");
  const bool is_json = request.query.contains("f")
                           ? request.query.at("f") == "covjson"
                           : !accepts_type(accept, kGeoTiffType) ||
                                 accept.find(kCoverageJsonType) != std::string_view::npos;
  return is_json ? CoverageFormat::json : CoverageFormat::geotiff;
}

// A value for each axis: "x(1:2),y(3:4)".
using AxisTexts = std::map<int, std::string>;

// Returns the index of an axis of the plane: its letter or, with a coordinate system, E or N.
std::optional<int> axis_named(const std::string& name, const app::GisPlane& plane) {
  const std::string lower = to_lower(name);
  for (int axis = 0; axis < 2; ++axis) {
    const std::string letter(1, plane.name()[static_cast<std::size_t>(axis)]);
    if (lower == letter || (plane.crs() && lower == (axis == 0 ? "e" : "n"))) return axis;
  }
  return std::nullopt;
}

Result<AxisTexts> axis_texts(const Request& request, const std::string& parameter,
                             const app::GisPlane& plane) {
  AxisTexts texts;
  std::string_view rest;
  if (const auto found = request.query.find(parameter); found != request.query.end())
    rest = found->second;
  while (!rest.empty()) {
    const auto open = rest.find('('), close = rest.find(')');
    const auto axis =
        open < close ? axis_named(std::string(rest.substr(0, open)), plane) : std::optional<int>();
    if (!axis || close == std::string_view::npos || texts.contains(*axis) ||
        (close + 1 < rest.size() && rest[close + 1] != ','))
      return fail(ErrorCode::malformed, "Invalid axes",
                  "`" + parameter + "` must name the axes " + plane.name().substr(0, 1) + " and " +
                      plane.name().substr(1) + " with their values, such as " +
                      plane.name().substr(0, 1) + "(…).",
                  parameter);
    texts[*axis] = std::string(rest.substr(open + 1, close - open - 1));
    rest.remove_prefix(std::min(close + 2, rest.size()));
  }
  return texts;
}

Result<double> number_in(std::string_view text, const std::string& parameter) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error == std::errc() && end == text.data() + text.size() && std::isfinite(number))
    return number;
  return fail(ErrorCode::malformed, "Invalid number",
              "`" + parameter + "` contains a text that is not a number.", parameter);
}

Result<void> cut(app::GisPlane::Box& window, const app::GisPlane::Box& with,
                 const std::string& parameter) {
  window.low = glm::max(window.low, with.low);
  window.high = glm::min(window.high, with.high);
  if (window.low.x <= window.high.x && window.low.y <= window.high.y) return {};
  return fail(ErrorCode::malformed, "Outside the coverage",
              "`" + parameter + "` does not touch the coverage. See the extent of the collection.",
              parameter);
}

Result<void> cut_with_bbox(app::GisPlane::Box& window, const Request& request,
                           const app::GisPlane& plane, const Model& model,
                           const std::string& base) {
  const auto box = STRATA_TRY(bbox_of(request));
  if (!box) return {};
  const auto system = STRATA_TRY(system_of(request, "bbox-crs", plane, model, base));
  constexpr double kNowhere = std::numeric_limits<double>::infinity();
  const auto on_plane = plane.read_box({box->low, box->high}, system);
  return cut(window,
             on_plane.value_or(app::GisPlane::Box{glm::dvec2(kNowhere), glm::dvec2(-kNowhere)}),
             "bbox");
}

Result<void> cut_with_subset(app::GisPlane::Box& window, const Request& request,
                             const app::GisPlane& plane) {
  const auto texts = STRATA_TRY(axis_texts(request, "subset", plane));
  for (const auto& [axis, text] : texts) {
    const auto colon = text.find(':');
    if (colon == std::string::npos)
      return fail(ErrorCode::malformed, "Invalid subset",
                  "`subset` must contain a low and a high coordinate for an axis, such as x(1:2).",
                  "subset");
    glm::dvec2 low = window.low, high = window.high;
    const std::string from = text.substr(0, colon), to = text.substr(colon + 1);
    if (from != "*") low[axis] = STRATA_TRY(number_in(from, "subset")) / plane.metres();
    if (to != "*") high[axis] = STRATA_TRY(number_in(to, "subset")) / plane.metres();
    STRATA_TRY(cut(window, {low, high}, "subset"));
  }
  return {};
}

// A number of cells along both axes that the request asks for, and the parameter that does.
struct AskedSize {
  glm::dvec2 cells;
  std::string parameter;
};

Result<double> count_in(const std::string& text, const std::string& parameter) {
  const auto count = parse_integer(text, 1, static_cast<std::int64_t>(kMostFileCells), parameter);
  if (!count) return tl::unexpected(as_malformed(count.error()));
  return static_cast<double>(*count);
}

Result<std::optional<AskedSize>> asked_size(const Request& request, const app::GisPlane& plane,
                                            const glm::dvec2& natural) {
  std::optional<AskedSize> asked;
  if (const auto factor = request.query.find("scale-factor"); factor != request.query.end())
    asked = {natural / STRATA_TRY(number_in(factor->second, "scale-factor")), "scale-factor"};
  const auto factors = STRATA_TRY(axis_texts(request, "scale-axes", plane));
  for (const auto& [axis, text] : factors) {
    if (!asked) asked = {natural, "scale-axes"};
    asked->cells[axis] = natural[axis] / STRATA_TRY(number_in(text, "scale-axes"));
  }
  std::map<int, std::pair<std::string, std::string>> counts;  // text and parameter by axis
  const auto sizes = STRATA_TRY(axis_texts(request, "scale-size", plane));
  for (const auto& [axis, text] : sizes) counts[axis] = {text, "scale-size"};
  for (const auto& [axis, name] : {std::pair(0, "width"), std::pair(1, "height")})
    if (const auto found = request.query.find(name); found != request.query.end())
      counts[axis] = {found->second, name};
  for (const auto& [axis, given] : counts) {
    const auto& [text, parameter] = given;
    const double count = STRATA_TRY(count_in(text, parameter));
    // With only one count, cells stay square.
    if (!asked || counts.size() == 1) asked = {natural * (count / natural[axis]), parameter};
    asked->cells[axis] = count;
  }
  return asked;
}

Result<query::PlaneGrid> grid_of(const Request& request, const app::GisPlane& plane,
                                 const Model& model, const Layer& layer, const std::string& base,
                                 double most_cells) {
  app::GisPlane::Box window = bounds_of(model, plane);
  STRATA_TRY(cut_with_bbox(window, request, plane, model, base));
  STRATA_TRY(cut_with_subset(window, request, plane));
  const double cell = cell_of(model, layer);
  const glm::dvec2 natural = cells_of(window, cell);
  const auto asked = STRATA_TRY(asked_size(request, plane, natural));
  glm::dvec2 size = limited(natural, most_cells);
  if (asked) {
    size = glm::max(glm::round(asked->cells), 1.0);
    if (!(asked->cells.x > 0 && asked->cells.y > 0 && size.x * size.y <= most_cells))
      return fail(ErrorCode::malformed, "Size out of range",
                  "A coverage can have 1 to " +
                      std::to_string(static_cast<std::int64_t>(most_cells)) +
                      " cells. Ask for a smaller part or a coarser scale.",
                  asked->parameter);
  }
  // Cells must have an area, even if the window is a line or a point.
  return query::PlaneGrid{window.low,
                          window.low + glm::max(window.high - window.low, glm::dvec2(cell)),
                          static_cast<int>(size.x), static_cast<int>(size.y)};
}

Result<Response> coverage(const RouteContext& context, const Request& request) {
  const bool is_file = STRATA_TRY(coverage_format(request)) == CoverageFormat::geotiff;
  const auto room = STRATA_TRY(open_room(context, request));
  const auto layer = STRATA_TRY(room->layers().find(request.param("layer")));
  const auto at = STRATA_TRY(find_sequence(context, *room, STRATA_TRY(datetime_of(request))));
  const Model model = room->model();
  const auto plane = STRATA_TRY(plane_of(request, model));
  const std::string base = ogc_base(context, request);
  const auto grid = STRATA_TRY(
      grid_of(request, plane, model, layer, base, is_file ? kMostFileCells : kMostJsonCells));
  const QuestionMemory held((is_file ? kBytesOfFileCell : kBytesOfJsonCell) *
                            static_cast<std::uint64_t>(grid.width) *
                            static_cast<std::uint64_t>(grid.height));
  const auto tiles = STRATA_TRY(room->queries().tiles(layer.slug, at));
  const auto tree = room->surface().search_tree();
  const query::PlaneView view(*tree, room->surface().geometry()->origin, plane.outline(),
                              plane.looks_up(), model.bounds_min, model.bounds_max);
  const query::LayerView layers[] = {{layer, tiles}};
  const auto rasters = query::resample(view, layers, grid);
  const double metres = plane.metres();
  const std::string system = uri_of(plane, model, base);
  Response response;
  if (is_file) {
    const query::GeoReference reference{metres * glm::dvec2(grid.low.x, grid.high.y),
                                        metres * grid.cell(),
                                        plane.crs() ? plane.crs()->code() : 0,
                                        model.name + ": " + plane.axes(),
                                        layer.name,
                                        layer.unit};
    auto file = STRATA_TRY(query::encode_geotiff(rasters.front(), reference));
    response = bytes_response(std::move(file), kGeoTiffType);
    name_download(response, model.slug + "-" + layer.slug + ".tif");
  } else {
    response = json_response(grid_coverage_json(
        metres * grid.center_of(0, 0), metres * grid.center_of(grid.width - 1, grid.height - 1),
        {layer}, rasters, system_of_plane(plane, system)));
    response.headers = {{"Content-Type", kCoverageJsonType}};
  }
  response.with("Content-Crs", "<" + system + ">").with("Vary", "Accept");
  return response;
}

}  // namespace

void add_ogc_coverage_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/ogc/collections/{model}.{layer}/coverage",
              .handler = answering(
                  [&context](const Request& request) { return coverage(context, request); }),
              .query = {"f", "bbox", "bbox-crs", "subset", "scale-factor", "scale-axes",
                        "scale-size", "width", "height", "datetime", "along"},
              .is_question = true,
              .state = state_of_model(context)});
}

}  // namespace strata::net
