#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>

#include "core/error.h"

namespace strata::query {

// A projected coordinate system of the EPSG register, and its conversion to longitude and latitude.
// Implemented with PROJ and its database, whose headers are not exposed.
class Crs {
 public:
  // Returns the system for use in this thread only, because PROJ's objects are not thread-safe. A
  // thread keeps the systems that it used last. Returns a `not_found` error for a code that PROJ
  // does not know, and an `invalid` error for a system whose coordinates are not easting and
  // northing in meters. Of a compound system, returns the plane part.
  static Result<std::shared_ptr<const Crs>> of_epsg(int code);
  ~Crs();
  Crs(const Crs&) = delete;
  Crs& operator=(const Crs&) = delete;

  int code() const { return code_; }                 // of the plane part
  const std::string& wkt() const { return wkt_; }    // WKT 2 (ISO 19162)
  const std::string& name() const { return name_; }  // "ETRS89 / UTM zone 33N"
  // Returns whether the register writes northing before easting.
  bool is_north_first() const { return is_north_first_; }

  // Convert (easting, northing) in meters to (longitude, latitude) in degrees on WGS 84, and back.
  // Return nothing for a place outside the system.
  std::optional<glm::dvec2> to_degrees(const glm::dvec2& place) const;
  std::optional<glm::dvec2> from_degrees(const glm::dvec2& degrees) const;

 private:
  struct Held;
  Crs();
  static Result<std::shared_ptr<const Crs>> make(int code);
  std::unique_ptr<Held> held_;
  int code_ = 0;
  std::string name_, wkt_;
  bool is_north_first_ = false;
};

}  // namespace strata::query
