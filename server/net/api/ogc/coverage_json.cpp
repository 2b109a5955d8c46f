#include "net/api/ogc/coverage_json.h"

#include <cmath>

#include "net/serialization/point_serialization.h"

namespace strata::net {
namespace {

nlohmann::json referencing(const CoverageSystem& system) {
  nlohmann::json systems = nlohmann::json::array();
  const bool swaps = system.is_north_first;
  systems.push_back(
      {{"coordinates", nlohmann::json::array({swaps ? "y" : "x", swaps ? "x" : "y"})},
       {"system",
        {{"type", system.is_geographic ? "GeographicCRS" : "ProjectedCRS"}, {"id", system.uri}}}});
  return systems;
}

nlohmann::json range_of(const Layer& layer, nlohmann::json values) {
  return {{"type", "NdArray"},
          {"dataType", is_float(layer.type) ? "float" : "integer"},
          {"values", std::move(values)}};
}

nlohmann::json point_coverage_json(const PlacedValues& placed, const std::vector<Layer>& layers) {
  nlohmann::json ranges = nlohmann::json::object();
  for (std::size_t i = 0; i < layers.size(); ++i)
    ranges[layers[i].slug] = range_of(layers[i], nlohmann::json::array({placed.values[i]}));
  const auto axis = [](double at) {
    return nlohmann::json{{"values", nlohmann::json::array({at})}};
  };
  return {{"type", "Coverage"},
          {"domain",
           {{"type", "Domain"},
            {"domainType", "Point"},
            {"axes", {{"x", axis(placed.place.x)}, {"y", axis(placed.place.y)}}}}},
          {"ranges", std::move(ranges)}};
}

}  // namespace

CoverageSystem system_of_plane(const app::GisPlane& plane, std::string uri) {
  return {std::move(uri), false, plane.crs() && plane.crs()->is_north_first()};
}

nlohmann::json number_json(ValueType type, double value) {
  if (!std::isfinite(value)) return {};
  return is_float(type) ? nlohmann::json(value) : nlohmann::json(static_cast<std::int64_t>(value));
}

nlohmann::json point_coverages_json(const std::vector<PlacedValues>& places,
                                    const std::vector<Layer>& layers,
                                    const CoverageSystem& system) {
  if (places.size() == 1) {
    nlohmann::json coverage = point_coverage_json(places.front(), layers);
    coverage["domain"]["referencing"] = referencing(system);
    coverage["parameters"] = coverage_parameters(layers);
    return coverage;
  }
  nlohmann::json coverages = nlohmann::json::array();
  for (const PlacedValues& placed : places)
    coverages.push_back(point_coverage_json(placed, layers));
  return {{"type", "CoverageCollection"},
          {"domainType", "Point"},
          {"parameters", coverage_parameters(layers)},
          {"referencing", referencing(system)},
          {"coverages", std::move(coverages)}};
}

nlohmann::json trajectory_coverage_json(const std::vector<PlacedValues>& places,
                                        const std::string& time, const std::vector<Layer>& layers,
                                        const CoverageSystem& system) {
  nlohmann::json path = nlohmann::json::array(), ranges = nlohmann::json::object();
  for (const PlacedValues& placed : places)
    path.push_back(nlohmann::json::array({time, placed.place.x, placed.place.y}));
  for (std::size_t i = 0; i < layers.size(); ++i) {
    nlohmann::json values = nlohmann::json::array();
    for (const PlacedValues& placed : places) values.push_back(placed.values[i]);
    nlohmann::json range = range_of(layers[i], std::move(values));
    range["axisNames"] = nlohmann::json::array({"composite"});
    range["shape"] = nlohmann::json::array({places.size()});
    ranges[layers[i].slug] = std::move(range);
  }
  nlohmann::json systems = referencing(system);
  systems.push_back({{"coordinates", nlohmann::json::array({"t"})},
                     {"system", {{"type", "TemporalRS"}, {"calendar", "Gregorian"}}}});
  return {{"type", "Coverage"},
          {"domain",
           {{"type", "Domain"},
            {"domainType", "Trajectory"},
            {"axes",
             {{"composite",
               {{"dataType", "tuple"},
                {"coordinates", nlohmann::json::array({"t", "x", "y"})},
                {"values", std::move(path)}}}}},
            {"referencing", std::move(systems)}}},
          {"parameters", coverage_parameters(layers)},
          {"ranges", std::move(ranges)}};
}

nlohmann::json grid_coverage_json(const glm::dvec2& first, const glm::dvec2& last,
                                  const std::vector<Layer>& layers,
                                  const std::vector<query::PlaneRaster>& rasters,
                                  const CoverageSystem& system) {
  nlohmann::json ranges = nlohmann::json::object();
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const query::PlaneRaster& raster = rasters[i];
    nlohmann::json values = nlohmann::json::array();
    for (std::size_t cell = 0; cell < raster.bits.size(); ++cell)
      values.push_back(raster.valid[cell]
                           ? number_json(raster.type, decode_value(raster.type, raster.bits[cell]))
                           : nlohmann::json());
    nlohmann::json range = range_of(layers[i], std::move(values));
    range["axisNames"] = nlohmann::json::array({"y", "x"});
    range["shape"] = nlohmann::json::array({raster.height, raster.width});
    ranges[layers[i].slug] = std::move(range);
  }
  const auto axis = [](double begin, double end, int count) {
    return nlohmann::json{{"start", begin}, {"stop", end}, {"num", count}};
  };
  const int width = rasters.front().width, height = rasters.front().height;
  return {{"type", "Coverage"},
          {"domain",
           {{"type", "Domain"},
            {"domainType", "Grid"},
            {"axes", {{"x", axis(first.x, last.x, width)}, {"y", axis(first.y, last.y, height)}}},
            {"referencing", referencing(system)}}},
          {"parameters", coverage_parameters(layers)},
          {"ranges", std::move(ranges)}};
}

}  // namespace strata::net
