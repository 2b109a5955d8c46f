#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/maps/gis_plane.h"

namespace strata {
struct Column;
struct Layer;
struct Model;
}  // namespace strata

// The descriptions of the collections under /ogc/collections.
namespace strata::net {

// The address of the API, and the direction of view that the client asked for.
struct OgcPlace {
  std::string base;   // "https://host/ogc"
  std::string along;  // "along=%2By", or empty
  // Returns the address of a part of a collection: "", "/items". `query` is a part of its query.
  std::string of(const std::string& collection, const std::string& part = {},
                 std::string_view query = {}) const;
};

// Return the description of a collection (OGC 17-069r4, 7.14; OGC 19-087; OGC 19-086r6, 8). A model
// is a collection for queries of its layers (EDR). A layer is a collection of features and a
// coverage. A column with lines or points is a collection of features.
nlohmann::json model_collection(const OgcPlace& place, const Model& model,
                                const std::vector<Layer>& layers, const app::GisPlane& plane);
nlohmann::json layer_collection(const OgcPlace& place, const Model& model, const Layer& layer,
                                const app::GisPlane& plane);
nlohmann::json column_collection(const OgcPlace& place, const Model& model, const Layer& layer,
                                 const Column& column, const app::GisPlane& plane);

// Returns the bounds of the model in world coordinates of the plane.
app::GisPlane::Box bounds_of(const Model& model, const app::GisPlane& plane);
// Returns the side of a cell of a coverage that has about the size of a texel, in world
// coordinates.
double cell_of(const Model& model, const Layer& layer);
// Returns the number of such cells along both sides of a rectangle of the plane, at least 1 each.
glm::dvec2 cells_of(const app::GisPlane::Box& window, double cell);
// The limits for the cells of a coverage as a file and as JSON.
inline constexpr double kMostFileCells = 16e6, kMostJsonCells = 1e6;
// Returns a size with the same shape and at most this number of cells.
glm::dvec2 limited(const glm::dvec2& size, double most_cells);

}  // namespace strata::net
