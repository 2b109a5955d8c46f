#include "query/maps/crs.h"

#include <proj.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

namespace strata::query {
namespace {

struct DestroyContext {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
};
struct DestroyPj {
  void operator()(PJ* object) const { proj_destroy(object); }
};
using Object = std::unique_ptr<PJ, DestroyPj>;

struct Axes {
  bool are_plane = false;  // easting and northing in meters, in any order
  bool is_north_first = false;
};
Axes axes_of(PJ_CONTEXT* context, const PJ* crs) {
  const Object system(proj_crs_get_coordinate_system(context, crs));
  std::string directions[2];
  for (int i = 0; i < 2; ++i) {
    const char* direction = nullptr;
    double metres = 0;
    if (!system || !proj_cs_get_axis_info(context, system.get(), i, nullptr, nullptr, &direction,
                                          &metres, nullptr, nullptr, nullptr))
      return {};
    if (metres != 1) return {};
    directions[i] = direction;
  }
  const bool is_east_first = directions[0] == "east" && directions[1] == "north",
             is_north_first = directions[0] == "north" && directions[1] == "east";
  return {is_east_first || is_north_first, is_north_first};
}

std::optional<glm::dvec2> converted(PJ* conversion, PJ_DIRECTION direction,
                                    const glm::dvec2& place) {
  proj_errno_reset(conversion);
  const PJ_COORD out = proj_trans(conversion, direction, proj_coord(place.x, place.y, 0, HUGE_VAL));
  if (!std::isfinite(out.xy.x) || !std::isfinite(out.xy.y)) return std::nullopt;
  return glm::dvec2(out.xy.x, out.xy.y);
}

}  // namespace

struct Crs::Held {
  std::unique_ptr<PJ_CONTEXT, DestroyContext> context{proj_context_create()};
  Object to_degrees;  // from easting, northing to longitude, latitude
};

Crs::Crs() : held_(std::make_unique<Held>()) {}
Crs::~Crs() = default;

Result<std::shared_ptr<const Crs>> Crs::of_epsg(int code) {
  constexpr std::size_t kMostKept = 16;
  thread_local std::map<int, Result<std::shared_ptr<const Crs>>> kept;
  if (const auto found = kept.find(code); found != kept.end()) return found->second;
  if (kept.size() >= kMostKept) kept.clear();
  return kept.emplace(code, make(code)).first->second;
}

Result<std::shared_ptr<const Crs>> Crs::make(int code) {
  const std::shared_ptr<Crs> crs(new Crs);
  PJ_CONTEXT* context = crs->held_->context.get();
  proj_log_level(context, PJ_LOG_NONE);
  proj_context_set_enable_network(context, 0);  // a server must not load grids from elsewhere
  const std::string label = "EPSG:" + std::to_string(code);
  Object system(proj_create_from_database(context, "EPSG", std::to_string(code).c_str(),
                                          PJ_CATEGORY_CRS, 0, nullptr));
  if (!system)
    return fail(ErrorCode::not_found, "Unknown coordinate system",
                "The database of coordinate systems does not contain " + label + ".", "crs");
  if (proj_get_type(system.get()) == PJ_TYPE_COMPOUND_CRS)
    system.reset(proj_crs_get_sub_crs(context, system.get(), 0));
  const char* own_code = proj_get_id_code(system.get(), 0);
  const Axes axes = axes_of(context, system.get());
  if (proj_get_type(system.get()) != PJ_TYPE_PROJECTED_CRS || !axes.are_plane)
    return fail(ErrorCode::invalid, "No plane coordinates in meters",
                label + " is not a coordinate system with plane coordinates in meters.", "crs");
  const Object degrees(proj_create(context, "OGC:CRS84"));
  const Object conversion(degrees ? proj_create_crs_to_crs_from_pj(context, system.get(),
                                                                   degrees.get(), nullptr, nullptr)
                                  : nullptr);
  if (conversion)
    crs->held_->to_degrees.reset(proj_normalize_for_visualization(context, conversion.get()));
  if (!crs->held_->to_degrees)
    return fail(ErrorCode::invalid, "No conversion",
                label + " cannot be converted to longitude and latitude.", "crs");
  crs->code_ = own_code ? std::atoi(own_code) : code;
  crs->name_ = proj_get_name(system.get());
  const char* const options[] = {"MULTILINE=NO", nullptr};
  if (const char* wkt = proj_as_wkt(context, system.get(), PJ_WKT2_2019, options)) crs->wkt_ = wkt;
  crs->is_north_first_ = axes.is_north_first;
  return std::shared_ptr<const Crs>(crs);
}

std::optional<glm::dvec2> Crs::to_degrees(const glm::dvec2& place) const {
  return converted(held_->to_degrees.get(), PJ_FWD, place);
}

std::optional<glm::dvec2> Crs::from_degrees(const glm::dvec2& degrees) const {
  return converted(held_->to_degrees.get(), PJ_INV, degrees);
}

}  // namespace strata::query
