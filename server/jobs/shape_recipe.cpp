#include "jobs/shape_recipe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/text/number_text.h"
#include "core/text/utf8.h"
#include "domain/scene/compass.h"
#include "mesh/analysis/surface_samples.h"

namespace strata::jobs {
namespace {

constexpr std::array<std::string_view, 20> kNames{"height",
                                                  "slope",
                                                  "azimuth",
                                                  "mean_curvature",
                                                  "gaussian_curvature",
                                                  "max_curvature",
                                                  "min_curvature",
                                                  "roughness",
                                                  "ambient_occlusion",
                                                  "boundary_distance",
                                                  "model_distance",
                                                  "change",
                                                  "level_of_detection",
                                                  "significant_change",
                                                  "sun_hours",
                                                  "sun_energy",
                                                  "driving_rain",
                                                  "vertex_property",
                                                  "part",
                                                  "lightness"};

constexpr std::size_t kMaxLabel = 200;  // bytes, of a class
constexpr double kEdgesPerRadius = 4;
// The cylinder then contains about 50 vertices of each mesh. Lague et al. recommend at least 20.
constexpr double kEdgesPerProjection = 8;
constexpr double kProjectionsPerNormal = 2;
constexpr double kUsualProjectionsPerDistance = 50, kMaxProjectionsPerDistance = 200;
constexpr double kDefaultRainPerHour = 1;  // mm
constexpr int kDefaultRays = 64;
constexpr int kMinRays = 16, kMaxRays = 1024;

// Returns the last bytes of the text, at most `most`, without a partial character.
std::string end_of(const std::string& text, std::size_t most) {
  std::size_t cut = text.size() - std::min(text.size(), most);
  while (!is_utf8(std::string_view(text).substr(cut))) ++cut;
  return text.substr(cut);
}

bool takes_radius(ShapeKind kind) {
  return kind >= ShapeKind::mean_curvature && kind <= ShapeKind::roughness;
}
bool takes_distance(ShapeKind kind) {
  return kind == ShapeKind::ambient_occlusion || kind == ShapeKind::model_distance ||
         is_change(kind);
}
bool takes_north(ShapeKind kind) { return is_sun(kind) || kind == ShapeKind::driving_rain; }
bool takes_model(ShapeKind kind) { return kind == ShapeKind::model_distance || is_change(kind); }

double millimetres(double units, const Model& model) { return units * model.metres() * 1000; }
double diagonal_mm(const Model& model) {
  return millimetres(glm::length(model.bounds_max - model.bounds_min), model);
}

// Returns a little more than the mean length of an edge: 1.52 √(mean area), the edge length in a
// mesh of equal equilateral triangles.
double edge_mm(const Model& model) {
  return millimetres(1.52 * std::sqrt(model.area / static_cast<double>(std::max<std::uint64_t>(
                                                       1, model.triangles))),
                     model);
}

// Rounds to two digits for display.
double rounded(double value) {
  if (!(value > 0)) return value;
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::round(value / unit) * unit;
}

Result<void> refuse_foreign(bool is_set, bool takes, const char* member, ShapeKind kind) {
  if (!is_set || takes) return {};
  return fail(ErrorCode::invalid, "Option not applicable",
              "`" + std::string(member) + "` does not apply to the kind " +
                  std::string(name(kind)) + ". Leave it out.",
              "compute." + std::string(member));
}

Result<void> check_members(const ShapeRecipe& r) {
  const ShapeKind kind = r.kind;
  const struct {
    bool is_set, takes;
    const char* member;
  } members[] = {
      {r.radius_mm.has_value(), takes_radius(kind), "radius_mm"},
      {r.distance_mm.has_value(), takes_distance(kind), "distance_mm"},
      {r.normal_scale_mm.has_value(), is_change(kind), "normal_scale_mm"},
      {r.projection_scale_mm.has_value(), is_change(kind), "projection_scale_mm"},
      {r.registration_mm.has_value(), is_change(kind), "registration_mm"},
      {r.latitude_deg.has_value(), is_sun(kind), "latitude_deg"},
      {r.north_deg.has_value(), takes_north(kind), "north_deg"},
      {!r.from.empty(), is_sun(kind), "from"},
      {!r.to.empty(), is_sun(kind), "to"},
      {!r.wind_shares.empty(), kind == ShapeKind::driving_rain, "wind_shares"},
      {r.wind_speed_m_s.has_value(), kind == ShapeKind::driving_rain, "wind_speed_m_s"},
      {r.rain_mm.has_value(), kind == ShapeKind::driving_rain, "rain_mm"},
      {r.rain_mm_per_hour.has_value(), kind == ShapeKind::driving_rain, "rain_mm_per_hour"},
      {r.rays.has_value(), kind == ShapeKind::ambient_occlusion, "rays"},
      {r.absolute, kind == ShapeKind::height, "absolute"},
      {!r.model.empty(), takes_model(kind), "model"},
      {!r.property.empty(), kind == ShapeKind::vertex_property, "property"},
      {!r.source.empty(), kind == ShapeKind::vertex_property, "source"},
      {!r.look.empty(), kind == ShapeKind::lightness, "look"}};
  for (const auto& [is_set, takes, member] : members)
    STRATA_TRY(refuse_foreign(is_set, takes, member, kind));
  if (takes_model(kind) && r.model.empty())
    return fail(ErrorCode::invalid, "Model missing",
                "Choose the other model. The server measures the distance to its surface.",
                "compute.model");
  if (kind == ShapeKind::vertex_property && r.property.empty())
    return fail(ErrorCode::invalid, "Property missing",
                "Enter a property of the vertices of the scan, such as quality.",
                "compute.property");
  return {};
}

// Returns the day of a text in the format MM-DD; 0 is 1 January.
std::optional<int> day_of_year(const std::string& text) {
  constexpr std::array kDays{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (text.size() != 5 || text[2] != '-' || !is_digit(text[0]) || !is_digit(text[1]) ||
      !is_digit(text[3]) || !is_digit(text[4]))
    return std::nullopt;
  const int month = (text[0] - '0') * 10 + text[1] - '0',
            day = (text[3] - '0') * 10 + text[4] - '0';
  if (month < 1 || month > 12 || day < 1 || day > kDays[static_cast<std::size_t>(month - 1)])
    return std::nullopt;
  int before = 0;
  for (int i = 1; i < month; ++i) before += kDays[static_cast<std::size_t>(i - 1)];
  return before + day - 1;
}

Result<void> complete_north(ShapeRecipe& recipe, const Model& model) {
  if (const Compass compass(model); !recipe.north_deg && compass.is_known)
    recipe.north_deg = compass.turned_degrees;
  if (!recipe.north_deg)
    return fail(ErrorCode::invalid, "North unknown",
                "The direction of north is not known for this model. Enter the angle from the "
                "direction of the front view to north, clockwise as seen from above.",
                "compute.north_deg");
  if (!(std::abs(*recipe.north_deg) <= 360))
    return fail(ErrorCode::invalid, "Out of range",
                "The direction of north must be from -360 to 360 degrees.", "compute.north_deg");
  return {};
}

Result<void> complete_sun(ShapeRecipe& recipe, const Model& model) {
  if (!recipe.latitude_deg)
    return fail(ErrorCode::invalid, "Latitude missing",
                "Enter the latitude of the site in degrees, positive in the north.",
                "compute.latitude_deg");
  if (!(std::abs(*recipe.latitude_deg) <= 90))
    return fail(ErrorCode::invalid, "Out of range", "The latitude must be from -90 to 90 degrees.",
                "compute.latitude_deg");
  STRATA_TRY(complete_north(recipe, model));
  if (recipe.from.empty()) recipe.from = "01-01";
  if (recipe.to.empty()) recipe.to = "12-31";
  for (const auto& [day, member] : {std::pair(&recipe.from, "from"), std::pair(&recipe.to, "to")})
    if (!day_of_year(*day))
      return fail(ErrorCode::invalid, "No day of the year",
                  "Enter a month and a day in the format MM-DD, such as 06-21. 29 February is not "
                  "possible, because the year has 365 days.",
                  "compute." + std::string(member));
  return {};
}

Result<void> complete_rain(ShapeRecipe& recipe, const Model& model) {
  const auto& shares = recipe.wind_shares;
  if ((shares.size() != 8 && shares.size() != 16) ||
      !std::ranges::all_of(shares, [](double share) { return share >= 0 && share <= 1e6; }) ||
      std::ranges::all_of(shares, [](double share) { return share == 0; }))
    return fail(ErrorCode::invalid, "Wind rose not usable",
                "Enter how much of the rain falls with wind from each of 8 or 16 directions, "
                "clockwise from north. No number can be negative, and one must be larger than 0.",
                "compute.wind_shares");
  if (!recipe.rain_mm_per_hour) recipe.rain_mm_per_hour = kDefaultRainPerHour;
  const struct {
    const std::optional<double>& value;
    double least, most;
    const char *member, *detail;
  } numbers[] = {
      {recipe.wind_speed_m_s, 0, 100, "wind_speed_m_s",
       "Enter the mean speed of the wind while it rains, from 0 to 100 m/s."},
      {recipe.rain_mm, 0.1, 1e5, "rain_mm", "Enter the rain of a year, from 0.1 to 100000 mm."},
      {recipe.rain_mm_per_hour, 0.01, 1000, "rain_mm_per_hour",
       "The mean intensity of the rain must be from 0.01 to 1000 mm per hour."}};
  for (const auto& [value, least, most, member, detail] : numbers)
    if (!value || !(*value >= least && *value <= most))
      return fail(ErrorCode::invalid, value ? "Out of range" : "Value missing", detail,
                  "compute." + std::string(member));
  return complete_north(recipe, model);
}

double least_radius_mm(const Model& model) {
  return millimetres(
      mesh::SurfaceSamples::least_radius(model.area, model.bounds_max - model.bounds_min), model);
}

Result<void> check_length(double value, double least, double most, const char* member) {
  if (value >= least && value <= most) return {};
  return fail(ErrorCode::invalid, "Out of range for this model",
              "For this model, the value must be from " + short_number(rounded(least * 1.05)) +
                  " to " + short_number(rounded(most)) + " mm.",
              "compute." + std::string(member));
}

// The scales have the same values for both models, so the coarser mesh determines them.
Result<void> complete_scales(ShapeRecipe& recipe, const Model& model, const Model& other) {
  const double diagonal = diagonal_mm(model);
  const double least = 2 * std::max(least_radius_mm(model), least_radius_mm(other));
  const double most = std::max(diagonal, 2 * least);
  if (!recipe.projection_scale_mm)
    recipe.projection_scale_mm = rounded(std::clamp(
        kEdgesPerProjection * std::max(edge_mm(model), edge_mm(other)), 1.1 * least, most));
  const double projection = *recipe.projection_scale_mm;
  STRATA_TRY(check_length(projection, least, most, "projection_scale_mm"));
  if (!recipe.normal_scale_mm)
    recipe.normal_scale_mm = rounded(std::min(kProjectionsPerNormal * projection, most));
  STRATA_TRY(check_length(*recipe.normal_scale_mm, least, most, "normal_scale_mm"));
  const double farthest = kMaxProjectionsPerDistance * projection;
  if (!recipe.distance_mm)
    recipe.distance_mm =
        rounded(std::clamp(diagonal / 10, projection, kUsualProjectionsPerDistance * projection));
  STRATA_TRY(check_length(*recipe.distance_mm, projection / 2, farthest, "distance_mm"));
  if (!recipe.registration_mm) recipe.registration_mm = 0;
  if (!(*recipe.registration_mm >= 0 && *recipe.registration_mm <= farthest))
    return fail(
        ErrorCode::invalid, "Out of range for this model",
        "For this model, the value must be from 0 to " + short_number(rounded(farthest)) + " mm.",
        "compute.registration_mm");
  return {};
}

Palette linear(double low, double high, std::initializer_list<Rgba> colors) {
  if (!(high > low)) high = low + (low == 0 ? 1 : std::abs(low) * 1e-3);
  Palette palette{PaletteMode::linear, low, high, {}, {}};
  const double last = static_cast<double>(colors.size() - 1);
  for (const Rgba& color : colors)
    palette.points.push_back(
        {low + (high - low) * static_cast<double>(palette.points.size()) / last, color, {}});
  return palette;
}

Palette viridis(double low, double high) {
  Palette palette = default_palette(ValueType::f32, false);
  const Palette span = linear(low, high, {{}, {}});
  for (auto& point : palette.points) point.at = span.min + (span.max - span.min) * point.at;
  palette.min = span.min;
  palette.max = span.max;
  return palette;
}

// Blue means hollow or behind, red means bulging or in front. The colors are distinct for all types
// of color vision.
Palette diverging(double limit) {
  return linear(-limit, limit,
                {{33, 102, 172, 255},
                 {103, 169, 207, 255},
                 {247, 247, 247, 255},
                 {239, 138, 98, 255},
                 {178, 24, 43, 255}});
}

Palette significance() {
  Palette palette{PaletteMode::categorical, 0, 2, {}, {}};
  palette.points = {{0, {214, 214, 214, 255}, "no significant change"},
                    {1, {178, 24, 43, 255}, "significant gain"},
                    {2, {33, 102, 172, 255}, "significant loss"}};
  return palette;
}

Palette sunshine(double most) {
  return linear(0, most,
                {{28, 38, 74, 255},
                 {112, 58, 110, 255},
                 {200, 84, 84, 255},
                 {245, 160, 70, 255},
                 {255, 240, 170, 255}});
}

// From dry stone to wet blue.
Palette rainfall(double most) {
  return linear(0, most,
                {{246, 239, 220, 255},
                 {186, 215, 206, 255},
                 {104, 170, 200, 255},
                 {46, 105, 173, 255},
                 {24, 42, 105, 255}});
}

Palette compass() {
  Palette palette{PaletteMode::linear, 0, 360, {}, {}};
  palette.points = {{0, {44, 90, 160, 255}, "north"},
                    {90, {242, 209, 107, 255}, "east"},
                    {180, {156, 47, 47, 255}, "south"},
                    {270, {143, 199, 181, 255}, "west"},
                    {360, {44, 90, 160, 255}, "north"}};
  return palette;
}

std::string scales_of(const ShapeRecipe& r) {
  const auto mm = [](const std::optional<double>& value) {
    return short_number(value.value_or(0)) + " mm";
  };
  return " M3C2 with a normal scale of " + mm(r.normal_scale_mm) + ", a projection scale of " +
         mm(r.projection_scale_mm) + " and a registration error of " + mm(r.registration_mm) +
         ". Searched up to " + mm(r.distance_mm) + ".";
}

std::string period_of(const ShapeRecipe& r) {
  return " from " + r.from + " to " + r.to + " at a latitude of " +
         short_number(r.latitude_deg.value_or(0)) + "°, with north at " +
         short_number(r.north_deg.value_or(0)) +
         "°. With the shadows of the model itself. Without clouds, diffuse light and other objects.";
}

std::string climate_of(const ShapeRecipe& r) {
  std::string shares;
  for (const double share : r.wind_shares)
    shares += (shares.empty() ? "" : " ") + short_number(share);
  return " for " + short_number(r.rain_mm.value_or(0)) + " mm of rain of " +
         short_number(r.rain_mm_per_hour.value_or(0)) + " mm per hour, with wind of " +
         short_number(r.wind_speed_m_s.value_or(0)) + " m/s and shares of " + shares +
         " for its directions clockwise from north, with north at " +
         short_number(r.north_deg.value_or(0)) +
         "°. Free-field formula of ISO 15927-3, with the shelter of the model itself. Without the flow of the wind around the object, splashes and other objects.";
}

std::string sentence(const ShapeRecipe& r, const Model& model, const std::string& other) {
  const std::string within = r.radius_mm ? short_number(*r.radius_mm) + " mm" : "";
  const std::string fit = " From the quadric that best fits the surface within " + within + ".";
  switch (r.kind) {
    case ShapeKind::height:
      return r.absolute ? "World coordinate along the model's up (" + model.up + ")."
                        : "Height above the model's lowest point, along its up (" + model.up + ").";
    case ShapeKind::slope:
      return "Inclination of the surface: 0° where it is horizontal and faces up, 90° where it is vertical, 180° where it faces down.";
    case ShapeKind::azimuth:
      return "Direction that the surface faces, clockwise from north, seen from above; no value where the surface is horizontal.";
    case ShapeKind::mean_curvature:
      return "Mean curvature: positive where the surface bulges, negative where it is hollow." +
             fit;
    case ShapeKind::gaussian_curvature:
      return "Gaussian curvature: positive in bumps and hollows, negative in saddles, 0 where it could be unrolled." +
             fit;
    case ShapeKind::max_curvature:
      return "Largest principal curvature: high on ridges and edges." + fit;
    case ShapeKind::min_curvature:
      return "Smallest principal curvature: low in grooves and cracks." + fit;
    case ShapeKind::roughness:
      return "Distance of the surface to the plane that best fits it within " + within + ".";
    case ShapeKind::ambient_occlusion:
      return "Share of the light from all around that reaches the surface: 1 where nothing blocks it, 0 in deep cavities. " +
             std::to_string(r.rays.value_or(kDefaultRays)) + " rays of " +
             short_number(r.distance_mm.value_or(0)) + " mm.";
    case ShapeKind::boundary_distance:
      return "Straight distance to the nearest open edge of the mesh.";
    case ShapeKind::model_distance:
      return "Distance to the surface of " + other +
             ": positive where this model is in front of that surface (material was added), negative where it is behind. Searched up to " +
             short_number(r.distance_mm.value_or(0)) + " mm.";
    case ShapeKind::change:
      return "Change of the surface since " + other +
             ": positive where material was added, negative where it was removed. Averaged over a cylinder along the mean normal." +
             scales_of(r);
    case ShapeKind::level_of_detection:
      return "Smallest change since " + other +
             " that can be distinguished from noise and alignment, with a confidence of 95 %." +
             scales_of(r);
    case ShapeKind::significant_change:
      return "Where the change since " + other +
             " is larger than noise and alignment can explain, with a confidence of 95 %: 0 no, 1 material was added, 2 material was removed." +
             scales_of(r);
    case ShapeKind::sun_hours: return "Hours of direct sun" + period_of(r);
    case ShapeKind::sun_energy: return "Energy of the direct sun under a clear sky" + period_of(r);
    case ShapeKind::driving_rain: return "Rain on the surface" + climate_of(r);
    case ShapeKind::vertex_property:
      return "Property " + r.property + " of the scan's vertices, from " + r.source + ".";
    case ShapeKind::part: return "Part of the model, by its number.";
    case ShapeKind::lightness:
      return "Lightness (L* of CIELAB) of " +
             (r.look.empty() ? "the visible colors" : "the surface image " + other) +
             ": 0 black, 100 white.";
  }
  return {};
}

}  // namespace

std::string_view name(ShapeKind kind) { return kNames[static_cast<std::size_t>(kind)]; }

std::optional<ShapeKind> parse_shape_kind(std::string_view name) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == name) return static_cast<ShapeKind>(i);
  return std::nullopt;
}

bool is_change(ShapeKind kind) {
  return kind >= ShapeKind::change && kind <= ShapeKind::significant_change;
}

bool is_sun(ShapeKind kind) {
  return kind == ShapeKind::sun_hours || kind == ShapeKind::sun_energy;
}

bool has_classes(ShapeKind kind) {
  return kind == ShapeKind::significant_change || kind == ShapeKind::part;
}

DaysOfYear days_of(const ShapeRecipe& recipe) {
  constexpr int kDaysPerYear = 365;
  const int first = day_of_year(recipe.from).value_or(0),
            last = day_of_year(recipe.to).value_or(kDaysPerYear - 1);
  return {first, (last - first + kDaysPerYear) % kDaysPerYear + 1};
}

Result<ShapeRecipe> completed(ShapeRecipe recipe, const Model& model, const Model* other) {
  STRATA_TRY(check_members(recipe));
  if (recipe.kind == ShapeKind::part && model.parts.empty())
    return fail(ErrorCode::invalid, "No parts",
                "This model was imported from one scan, so it has no parts.", "compute.kind");
  if (is_change(recipe.kind)) {
    STRATA_TRY(complete_scales(recipe, model, other ? *other : model));
    return recipe;
  }
  if (is_sun(recipe.kind)) {
    STRATA_TRY(complete_sun(recipe, model));
    return recipe;
  }
  if (recipe.kind == ShapeKind::driving_rain) {
    STRATA_TRY(complete_rain(recipe, model));
    return recipe;
  }
  const double diagonal = diagonal_mm(model), least = least_radius_mm(model);
  if (takes_radius(recipe.kind)) {
    if (!recipe.radius_mm)
      recipe.radius_mm = rounded(std::max(kEdgesPerRadius * edge_mm(model), least * 1.05));
    if (auto good =
            check_length(*recipe.radius_mm, least, std::max(diagonal, 2 * least), "radius_mm");
        !good)
      return tl::unexpected(good.error());
  }
  if (takes_distance(recipe.kind)) {
    if (!recipe.distance_mm)
      recipe.distance_mm =
          rounded(diagonal / (recipe.kind == ShapeKind::ambient_occlusion ? 4 : 10));
    if (auto good =
            check_length(*recipe.distance_mm, diagonal * 1e-6, diagonal * 100, "distance_mm");
        !good)
      return tl::unexpected(good.error());
  }
  if (recipe.kind == ShapeKind::ambient_occlusion) {
    if (!recipe.rays) recipe.rays = kDefaultRays;
    if (*recipe.rays < kMinRays || *recipe.rays > kMaxRays)
      return fail(ErrorCode::invalid, "Out of range",
                  "The number of rays per point must be from 16 to 1024.", "compute.rays");
  }
  return recipe;
}

nlohmann::json to_json(const ShapeRecipe& r) {
  nlohmann::json json{{"kind", name(r.kind)}};
  if (r.radius_mm) json["radius_mm"] = *r.radius_mm;
  if (r.distance_mm) json["distance_mm"] = *r.distance_mm;
  if (r.normal_scale_mm) json["normal_scale_mm"] = *r.normal_scale_mm;
  if (r.projection_scale_mm) json["projection_scale_mm"] = *r.projection_scale_mm;
  if (r.registration_mm) json["registration_mm"] = *r.registration_mm;
  if (r.latitude_deg) json["latitude_deg"] = *r.latitude_deg;
  if (r.north_deg) json["north_deg"] = *r.north_deg;
  if (!r.from.empty()) json["from"] = r.from;
  if (!r.to.empty()) json["to"] = r.to;
  if (!r.wind_shares.empty()) json["wind_shares"] = r.wind_shares;
  if (r.wind_speed_m_s) json["wind_speed_m_s"] = *r.wind_speed_m_s;
  if (r.rain_mm) json["rain_mm"] = *r.rain_mm;
  if (r.rain_mm_per_hour) json["rain_mm_per_hour"] = *r.rain_mm_per_hour;
  if (r.rays) json["rays"] = *r.rays;
  if (r.absolute) json["absolute"] = true;
  if (!r.model.empty()) json["model"] = r.model;
  if (!r.property.empty()) json["property"] = r.property;
  if (!r.source.empty()) json["source"] = r.source;
  if (!r.look.empty()) json["look"] = r.look;
  return json;
}

std::string unit_of(const ShapeRecipe& recipe, const Model& model) {
  std::string unit(name(model.unit));
  switch (recipe.kind) {
    case ShapeKind::slope:
    case ShapeKind::azimuth: return "°";
    case ShapeKind::mean_curvature:
    case ShapeKind::max_curvature:
    case ShapeKind::min_curvature: return "1/" + unit;
    case ShapeKind::gaussian_curvature: return "1/" + unit + "²";
    case ShapeKind::change:
    case ShapeKind::level_of_detection: return "mm";
    case ShapeKind::sun_hours: return "h";
    case ShapeKind::sun_energy: return "kWh/m²";
    case ShapeKind::driving_rain: return "l/m²";
    case ShapeKind::significant_change:
    case ShapeKind::ambient_occlusion:
    case ShapeKind::lightness:
    case ShapeKind::part:
    case ShapeKind::vertex_property: return "";
    default: return unit;
  }
}

std::string description_of(const ShapeRecipe& recipe, const Model& model,
                           const std::string& other) {
  if (recipe.kind == ShapeKind::lightness) return sentence(recipe, model, other);
  return sentence(recipe, model, other) + " Computed from the mesh of " +
         std::to_string(model.triangles) + " triangles.";
}

Palette palette_of(const std::vector<ModelPart>& parts) {
  Palette palette{PaletteMode::categorical, 0, static_cast<double>(parts.size() - 1), {}, {}};
  for (std::uint32_t number = 0; number < parts.size(); ++number) {
    const ModelPart& part = parts[number];
    const std::string label = part.folder.empty() ? part.name : part.folder + "/" + part.name;
    // Parts in one deep folder differ at the end.
    palette.points.push_back(
        {static_cast<double>(number), generated_color(number + 1), end_of(label, kMaxLabel)});
  }
  return palette;
}

Palette palette_of(ShapeKind kind, const ValueRange& range) {
  switch (kind) {
    case ShapeKind::slope: return viridis(0, range.high <= 90 ? 90 : 180);
    case ShapeKind::azimuth: return compass();
    case ShapeKind::mean_curvature:
    case ShapeKind::gaussian_curvature:
    case ShapeKind::max_curvature:
    case ShapeKind::min_curvature:
    case ShapeKind::model_distance:
    case ShapeKind::change: {
      const double limit = rounded(std::max(std::abs(range.low), std::abs(range.high)));
      return diverging(limit > 0 ? limit : 1);
    }
    case ShapeKind::roughness:
    case ShapeKind::level_of_detection: return viridis(0, rounded(range.high));
    case ShapeKind::significant_change: return significance();
    case ShapeKind::ambient_occlusion:
      return linear(0, 1, {{16, 18, 27, 255}, {120, 122, 130, 255}, {255, 255, 255, 255}});
    case ShapeKind::sun_hours:
    case ShapeKind::sun_energy: return sunshine(range.most);
    case ShapeKind::driving_rain: return rainfall(range.most);
    case ShapeKind::vertex_property: return viridis(range.low, range.high);
    case ShapeKind::lightness: return linear(0, 100, {{0, 0, 0, 255}, {255, 255, 255, 255}});
    case ShapeKind::boundary_distance: return viridis(0, rounded(range.most));
    case ShapeKind::part:
    case ShapeKind::height: break;
  }
  return viridis(range.least, range.most);
}

}  // namespace strata::jobs
