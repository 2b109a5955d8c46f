#include "app/maps/map_place.h"

#include <array>
#include <charconv>

#include "domain/layers/value_type.h"
#include "query/maps/map_features.h"

namespace strata::app {

Result<MapAxis> parse_map_axis(std::string_view text) {
  const int axis = text.size() == 2 ? text[1] - 'x' : -1;
  if (axis < 0 || axis > 2 || (text[0] != '-' && text[0] != '+'))
    return fail(ErrorCode::invalid, "Unknown direction",
                "`along` must be one of -x, +x, -y, +y, -z, +z: the direction in which you "
                "look at the map.",
                "along");
  MapAxis made{glm::dvec3(0), axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
  made.direction[axis] = text[0] == '-' ? -1 : 1;
  return made;
}

int epsg_of(const Model& model, int depth) {
  constexpr std::string_view kAuthority = "EPSG:";
  int code = 0;
  if (depth == 2 && model.unit == Unit::m && model.crs.starts_with(kAuthority))
    std::from_chars(model.crs.data() + kAuthority.size(), model.crs.data() + model.crs.size(),
                    code);
  return code;
}

double texel_area(const Model& model, int resolution) {
  const double texels = model.atlas.coverage * resolution * resolution;
  return texels > 0 ? model.area / texels : 0;
}

Result<query::WorldFile> world_of(const MapOptions& options, const MapFiles& files,
                                  const std::optional<query::WorldFile>& own) {
  if (options.world) return query::parse_world_file(*options.world, "world");
  if (const auto text = files.companion_text({"tfw", "tifw", "pgw", "jgw", "wld"}); !text.empty())
    return query::parse_world_file(text, "body");
  if (own) return *own;
  return fail(ErrorCode::invalid, "Position missing",
              "The picture contains no position. Send the six numbers of its world file as "
              "`world`, or send the world file together with the picture.",
              "world");
}

Result<void> check_map_crs(const Model& model, const std::string& crs, bool in_degrees) {
  if (in_degrees)
    return fail(ErrorCode::invalid, "Coordinates in degrees",
                "The coordinates of the map are longitudes and latitudes. Export the map in the "
                "projected coordinate system of the model" +
                    (model.crs.empty() ? "." : ", " + model.crs + "."),
                "body");
  if (!crs.empty() && !model.crs.empty() && crs != model.crs)
    return fail(ErrorCode::invalid, "Different coordinate systems",
                "The map has the coordinate system " + crs + ", but the model has " + model.crs +
                    ". Export the map again in " + model.crs + ".",
                "body");
  return {};
}

Result<void> confirm_map_crs(const MapOptions& options, const Model& model,
                             const std::string& crs) {
  const std::string& requested_crs = options.crs;
  for (const auto& [system, whose] : {std::pair(crs, "map"), std::pair(model.crs, "model")})
    if (!requested_crs.empty() && !system.empty() && requested_crs != system)
      return fail(ErrorCode::invalid, "Different coordinate systems",
                  "`crs` is " + requested_crs + ", but the " + whose + " is in " + system + ".",
                  "crs");
  if (!requested_crs.empty() || crs.empty() || !model.crs.empty()) return {};
  return fail(
      ErrorCode::invalid, "Model without coordinate system",
      "The coordinate system of the map is " + crs +
          ", but the model has no coordinate system. If the coordinates of the model are in " +
          crs + ", repeat the request with `crs=" + crs +
          "`. A curator can also set this coordinate system for the model.",
      "crs");
}

Result<std::uint32_t> bits_of(const Layer& layer, double value, const std::string& where) {
  auto bits = encode_value(layer.type, value);
  if (bits) return *bits;
  Error problem = bits.error();
  problem.detail = where + query::number_text(value) + " cannot be stored. " + problem.detail;
  problem.field = "body";
  return tl::unexpected(std::move(problem));
}

}  // namespace strata::app
