#include "query/maps/wkt.h"

#include <geos_c.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string_view>

namespace strata::query {
namespace {

// A context of GEOS for one text.
class Wkt {
 public:
  ~Wkt() {
    if (geometry_) GEOSGeom_destroy_r(context_, geometry_);
    if (reader_) GEOSWKTReader_destroy_r(context_, reader_);
    GEOS_finish_r(context_);
  }
  Wkt() = default;
  Wkt(const Wkt&) = delete;
  Wkt& operator=(const Wkt&) = delete;

  std::optional<WktGeometry> read(const std::string& text) {
    geometry_ = GEOSWKTReader_read_r(context_, reader_, text.c_str());
    if (!geometry_ || GEOSisEmpty_r(context_, geometry_) != 0) return std::nullopt;
    WktGeometry read;
    read.has_heights = GEOSHasZ_r(context_, geometry_) == 1;
    switch (GEOSGeomTypeId_r(context_, geometry_)) {
      case GEOS_POINT:
      case GEOS_MULTIPOINT: read.kind = WktGeometry::Kind::points; break;
      case GEOS_LINESTRING: read.kind = WktGeometry::Kind::line; break;
      case GEOS_POLYGON:
      case GEOS_MULTIPOLYGON: read.kind = WktGeometry::Kind::areas; break;
      default: return std::nullopt;
    }
    const int count = GEOSGetNumGeometries_r(context_, geometry_);
    for (int i = 0; i < count; ++i) {
      const GEOSGeometry* part = GEOSGetGeometryN_r(context_, geometry_, i);
      FlatPolygon& polygon = read.parts.emplace_back();
      const bool is_area = read.kind == WktGeometry::Kind::areas;
      if (!add(is_area ? GEOSGetExteriorRing_r(context_, part) : part, is_area, polygon))
        return std::nullopt;
      const int holes = is_area ? GEOSGetNumInteriorRings_r(context_, part) : 0;
      for (int hole = 0; hole < holes; ++hole)
        if (!add(GEOSGetInteriorRingN_r(context_, part, hole), true, polygon)) return std::nullopt;
    }
    return read;
  }

 private:
  bool add(const GEOSGeometry* line, bool is_ring, FlatPolygon& polygon) {
    const GEOSCoordSequence* corners = line ? GEOSGeom_getCoordSeq_r(context_, line) : nullptr;
    unsigned count = 0;
    if (!corners || !GEOSCoordSeq_getSize_r(context_, corners, &count) || count == 0) return false;
    std::vector<double> numbers(std::size_t{3} * count);
    if (!GEOSCoordSeq_copyToBuffer_r(context_, corners, numbers.data(), 1, 0)) return false;
    FlatRing& ring = polygon.rings.emplace_back();
    for (unsigned i = 0; i + (is_ring ? 1 : 0) < count; ++i) {
      const double z = numbers[3 * i + 2];
      if (!std::isfinite(numbers[3 * i]) || !std::isfinite(numbers[3 * i + 1])) return false;
      ring.emplace_back(numbers[3 * i], numbers[3 * i + 1], std::isfinite(z) ? z : 0);
    }
    return true;
  }

  GEOSContextHandle_t context_ = GEOS_init_r();
  GEOSWKTReader* reader_ = GEOSWKTReader_create_r(context_);
  GEOSGeometry* geometry_ = nullptr;
};

// Returns whether the first parenthesis closes at the end of the text. GEOS ignores a text after
// it.
bool is_one_geometry(std::string_view text) {
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    depth += text[i] == '(' ? 1 : text[i] == ')' ? -1 : 0;
    if (text[i] == ')' && depth == 0)
      return text.find_first_not_of(" \t\r\n", i + 1) == std::string_view::npos;
  }
  return false;
}

}  // namespace

Result<WktGeometry> parse_wkt(const std::string& text, const std::string& field) {
  auto read = is_one_geometry(text) ? Wkt().read(text) : std::nullopt;
  if (!read)
    return fail(ErrorCode::malformed, "Invalid geometry",
                "`" + field +
                    "` must be well-known text, such as POINT(1 2), LINESTRING(0 0, 1 2) or "
                    "POLYGON((0 0, 1 0, 1 1, 0 0)).",
                field);
  return std::move(*read);
}

}  // namespace strata::query
