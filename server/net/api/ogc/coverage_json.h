#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/maps/gis_plane.h"
#include "domain/layers/layer.h"
#include "query/maps/plane_raster.h"

// CoverageJSON 1.0 (OGC 21-069r2) of values on a plane. `x` is always the easting, the longitude or
// the first axis of a local plane.
namespace strata::net {

// The coordinate system of `x` and `y`.
struct CoverageSystem {
  std::string uri;
  bool is_geographic = false;
  bool is_north_first = false;  // in the register

  // Returns {x, y} for coordinates in the order of the register.
  glm::dvec2 place_of(const glm::dvec2& coordinates) const {
    return is_north_first ? glm::dvec2(coordinates.y, coordinates.x) : coordinates;
  }
};
// Returns the plane's own system, whose identifier is `uri`.
CoverageSystem system_of_plane(const app::GisPlane& plane, std::string uri);

// A place, with one number or null for each layer.
struct PlacedValues {
  glm::dvec2 place;
  std::vector<nlohmann::json> values;
};

// Returns a coverage with the domain type "Point" for one place, or a collection of such coverages.
nlohmann::json point_coverages_json(const std::vector<PlacedValues>& places,
                                    const std::vector<Layer>& layers, const CoverageSystem& system);
// Returns a coverage with the domain type "Trajectory". `time` is that of the shown state, at all
// places.
nlohmann::json trajectory_coverage_json(const std::vector<PlacedValues>& places,
                                        const std::string& time, const std::vector<Layer>& layers,
                                        const CoverageSystem& system);
// Returns a coverage with the domain type "Grid". `first` and `last` are the centers of the first
// cell of the first row and of the last cell of the last row.
nlohmann::json grid_coverage_json(const glm::dvec2& first, const glm::dvec2& last,
                                  const std::vector<Layer>& layers,
                                  const std::vector<query::PlaneRaster>& rasters,
                                  const CoverageSystem& system);
// Returns a value as JSON, and null if JSON has no such number.
nlohmann::json number_json(ValueType type, double value);

}  // namespace strata::net
