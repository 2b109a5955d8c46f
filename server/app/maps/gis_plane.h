#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>

#include "app/maps/map_place.h"
#include "query/maps/crs.h"
#include "query/maps/plane_outlines.h"

namespace strata::app {

// The systems in which programs can ask for the coordinates of a plane.
enum class GisSystem {
  plane,    // the system of the plane, with its axes in the order of the register
  degrees,  // longitude and latitude on WGS 84; only of a plane with a Crs
};

// The plane on which GIS programs see a model. Coordinates on the plane are in meters. If the model
// has a projected coordinate system and is seen along z, they are easting and northing. Otherwise
// they are two world coordinates of the model, in a local system. Use an object in one thread at a
// time.
class GisPlane {
 public:
  // Without `axis`, uses the direction -z for a model with a coordinate system. For other models,
  // uses the plane on which the bounds of the model are largest. It is seen so that its first
  // coordinate increases to the right.
  GisPlane(const Model& model, const std::optional<MapAxis>& axis);

  const MapAxis& axis() const { return axis_; }
  query::OutlinePlane outline() const { return {axis_.u, axis_.v, depth()}; }
  int depth() const { return 3 - axis_.u - axis_.v; }
  bool looks_up() const { return axis_.direction[depth()] > 0; }
  std::string along() const;  // "-z"
  std::string name() const;   // "xy": the world axes of the coordinates
  // Null for a local plane.
  const query::Crs* crs() const { return crs_.get(); }
  // The system of features and positions if the client asks for no other: degrees if possible.
  GisSystem usual_system() const { return crs_ ? GisSystem::degrees : GisSystem::plane; }
  std::string axes() const;  // "x and y"
  // A rectangle. The functions return the bounds of a rectangle in world coordinates of the plane
  // in a system, and of one in a system in world coordinates. They return nothing if no place of it
  // can be converted.
  struct Box {
    glm::dvec2 low{0}, high{0};
  };
  std::optional<Box> write_box(const Box& box, GisSystem system) const;
  std::optional<Box> read_box(const Box& box, GisSystem system) const;
  // Returns the plane's own system in WKT 2 (ISO 19162). `model` is the name of the model.
  std::string wkt(const std::string& model) const;

  // Convert between world coordinates in the plane (right, up) and coordinates of a system. Return
  // nothing for a place that the system cannot express.
  std::optional<glm::dvec2> write(const glm::dvec2& place, GisSystem system) const;
  std::optional<glm::dvec2> read(const glm::dvec2& coordinates, GisSystem system) const;
  double metres() const { return metres_; }  // per unit of the world coordinates

 private:
  MapAxis axis_;
  double metres_;
  std::shared_ptr<const query::Crs> crs_;
};

}  // namespace strata::app
