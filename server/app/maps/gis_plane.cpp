#include "app/maps/gis_plane.h"

#include <array>
#include <cmath>

namespace strata::app {
namespace {

// The directions in which the first coordinate of the plane increases to the right.
constexpr std::array<std::string_view, 3> kUnmirrored{"-x", "+y", "-z"};

MapAxis usual_axis(const Model& model) {
  if (epsg_of(model, 2) != 0) return parse_map_axis("-z").value();
  const glm::dvec3 size = model.bounds_max - model.bounds_min;
  int depth = 2;  // the smallest extent; of equal ones, the last
  for (const int axis : {1, 0})
    if (size[axis] < size[depth]) depth = axis;
  return parse_map_axis(kUnmirrored[static_cast<std::size_t>(depth)]).value();
}

std::shared_ptr<const query::Crs> crs_of(const Model& model, int depth) {
  const int code = epsg_of(model, depth);
  if (code == 0) return nullptr;
  // A model whose system has no plane coordinates in meters is seen on a local plane.
  return query::Crs::of_epsg(code).value_or(nullptr);
}

glm::dvec2 swapped(const glm::dvec2& place) { return {place.y, place.x}; }

}  // namespace

GisPlane::GisPlane(const Model& model, const std::optional<MapAxis>& axis)
    : axis_(axis ? *axis : usual_axis(model)),
      metres_(model.metres()),
      crs_(crs_of(model, depth())) {}

std::string GisPlane::along() const { return {looks_up() ? '+' : '-', "xyz"[depth()]}; }

std::string GisPlane::name() const { return {"xyz"[axis_.u], "xyz"[axis_.v]}; }

std::string GisPlane::axes() const { return name().substr(0, 1) + " and " + name().substr(1); }

namespace {

// Samples the rectangle, because its sides may be curved in the other system.
template <class Convert>
std::optional<GisPlane::Box> converted(const GisPlane::Box& box, const Convert& convert) {
  constexpr int kSteps = 8;  // along each side
  std::optional<GisPlane::Box> bounds;
  for (int i = 0; i <= kSteps; ++i)
    for (int k = 0; k <= kSteps; ++k) {
      const glm::dvec2 share = glm::dvec2(i, k) / double(kSteps);
      const std::optional<glm::dvec2> place = convert(box.low + share * (box.high - box.low));
      if (!place) continue;
      bounds = bounds ? GisPlane::Box{glm::min(bounds->low, *place), glm::max(bounds->high, *place)}
                      : GisPlane::Box{*place, *place};
    }
  return bounds;
}

}  // namespace

std::optional<GisPlane::Box> GisPlane::write_box(const Box& box, GisSystem system) const {
  return converted(box, [&](const glm::dvec2& place) { return write(place, system); });
}

std::optional<GisPlane::Box> GisPlane::read_box(const Box& box, GisSystem system) const {
  return converted(box, [&](const glm::dvec2& place) { return read(place, system); });
}

std::string GisPlane::wkt(const std::string& model) const {
  if (crs_) return crs_->wkt();
  std::string quoted;
  for (const char c : model) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  const auto axis = [&](int which, const char* order) {
    return std::string("AXIS[\"(") + "XYZ"[which] + ")\",unspecified,ORDER[" + order + "]]";
  };
  return "ENGCRS[\"" + quoted + ": " + axes() + "\",EDATUM[\"" + quoted + "\"],CS[Cartesian,2]," +
         axis(axis_.u, "1") + "," + axis(axis_.v, "2") + ",LENGTHUNIT[\"metre\",1]]";
}

std::optional<glm::dvec2> GisPlane::write(const glm::dvec2& place, GisSystem system) const {
  const glm::dvec2 in_metres = metres_ * place;
  if (system == GisSystem::degrees) return crs_ ? crs_->to_degrees(in_metres) : std::nullopt;
  return crs_ && crs_->is_north_first() ? swapped(in_metres) : in_metres;
}

std::optional<glm::dvec2> GisPlane::read(const glm::dvec2& coordinates, GisSystem system) const {
  std::optional<glm::dvec2> in_metres = coordinates;
  if (system == GisSystem::degrees)
    in_metres = crs_ ? crs_->from_degrees(coordinates) : std::nullopt;
  else if (crs_ && crs_->is_north_first())
    in_metres = swapped(coordinates);
  if (!in_metres) return std::nullopt;
  const glm::dvec2 place = *in_metres / metres_;
  if (!std::isfinite(place.x) || !std::isfinite(place.y)) return std::nullopt;
  return place;
}

}  // namespace strata::app
