#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/maps/gis_plane.h"
#include "net/api/route_context.h"
#include "net/http/http_types.h"
#include "protocol/messages.h"

// The common parts of the OGC APIs under /ogc: addresses, formats, coordinate systems and the query
// parameters that the standards define. They refuse invalid parameters with 400, as the standards
// require.
namespace strata::net {

inline constexpr std::string_view kCrs84 = "http://www.opengis.net/def/crs/OGC/1.3/CRS84";
inline constexpr const char* kGeoTiffType = "image/tiff; application=geotiff";
inline constexpr const char* kCoverageJsonType = "application/prs.coverage+json";

// Returns "https://host/ogc", as the client reaches this server.
std::string ogc_base(const RouteContext& context, const Request& request);

// Returns the address with a part of a query ("along=%2By") at its end. An empty part adds nothing.
std::string with_query(std::string address, std::string_view part);
// Returns the direction of view that the client asked for as a part of a query, or an empty text.
// Links keep it, so that a client which begins with it sees only this plane.
std::string along_query(const Request& request);

// Accepts the given values of `f`. Refuses (malformed, `f`) others.
Result<void> check_format(const Request& request, const std::vector<std::string_view>& known);

nlohmann::json ogc_link(std::string href, std::string_view relation, std::string_view type,
                        std::string_view title);

// Returns the document as JSON or, if `f=html` or the Accept header asks for it, as a page with the
// same content (ogc_page.h). Adds links to both forms to its `links`.
Result<Response> ogc_document(const RouteContext& context, const Request& request,
                              nlohmann::json document);

// Returns the identifier of the plane's own system: that of the EPSG register, or an address under
// /ogc/crs.
std::string uri_of(const app::GisPlane& plane, const Model& model, const std::string& base);
// Returns the identifiers of all systems of the plane. The first is the default for features.
std::vector<std::string> systems_of(const app::GisPlane& plane, const Model& model,
                                    const std::string& base);
// Returns the system in a query parameter, and the usual one of the plane if it is absent. A system
// is given as its identifier, as "EPSG:25833" or as "CRS84".
Result<app::GisSystem> system_of(const Request& request, const std::string& parameter,
                                 const app::GisPlane& plane, const Model& model,
                                 const std::string& base);

// A rectangle, with coordinates in the order of its system.
struct GisBox {
  glm::dvec2 low{0}, high{0};
};
// Returns `bbox`: four numbers, or six of which the heights are ignored.
Result<std::optional<GisBox>> bbox_of(const Request& request);

// Returns the state that `datetime` selects: a time selects the state then, and an interval the
// state at its end. Returns nothing for the current state.
Result<std::optional<protocol::At>> datetime_of(const Request& request);

// Returns the plane of the request: the one in `along`, or the usual one of the model.
Result<app::GisPlane> plane_of(const Request& request, const Model& model);

// Returns an error with the status that the OGC APIs require for invalid parameters: 400.
Error as_malformed(Error error);

}  // namespace strata::net
