#include "jobs/shape_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "domain/scene/compass.h"
#include "domain/scene/up.h"
#include "mesh/analysis/curvature.h"
#include "mesh/analysis/model_change.h"
#include "mesh/analysis/model_distance.h"
#include "mesh/analysis/openness.h"
#include "mesh/analysis/rain_sectors.h"
#include "mesh/analysis/sampled_field.h"
#include "mesh/analysis/sky_exposure.h"
#include "mesh/analysis/sun_sectors.h"
#include "mesh/io/vertex_properties.h"
#include "mesh/surface/boundary.h"
#include "mesh/texels/texel_owners.h"
#include "store/content/models.h"

namespace strata::jobs {
namespace {

using GeometryPtr = std::shared_ptr<const mesh::Geometry>;
// Returns the value at a point of a triangle. NaN: no value. Called on several threads.
using SurfaceValue = std::function<double(std::uint32_t triangle, const glm::vec3& weights)>;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
// Shares of the progress. Measuring takes most of the time for kinds with rays or neighborhoods.
constexpr double kMeasured = 0.7;
constexpr double kPrepared = 0.15;  // for kinds that first make samples or rays
// Of a change to its level of detection.
constexpr double kMaxRatio = 10;
// If the horizontal part of the normal is shorter, the surface has no azimuth.
constexpr float kFlat = 0.02f;

// Returns the azimuth of a normal: clockwise from north as seen from above, 0…360 degrees.
float azimuth(const Compass& compass, const glm::vec3& normal) {
  const float x = glm::dot(normal, glm::vec3(compass.east)),
              y = glm::dot(normal, glm::vec3(compass.north));
  if (x * x + y * y < kFlat * kFlat) return kNone;
  const double degrees = glm::degrees(std::atan2(double{x}, double{y})) - compass.turned_degrees;
  return static_cast<float>(degrees - 360 * std::floor(degrees / 360));
}

SurfaceValue at_vertices(GeometryPtr geometry, std::vector<double> values, ValueType type) {
  return [geometry = std::move(geometry), values = std::move(values), is_key = !is_float(type)](
             std::uint32_t triangle, const glm::vec3& w) {
    return mesh::value_in_triangle(*geometry, values, triangle, w, is_key);
  };
}

class Measure {
 public:
  Measure(store::Store& store, const Model& model, GeometryPtr geometry, const ShapeRecipe& recipe,
          ValueType type, Progress& progress)
      : store_(store),
        model_(model),
        geometry_(std::move(geometry)),
        recipe_(recipe),
        type_(type),
        progress_(progress) {}

  Result<SurfaceValue> value() {
    switch (recipe_.kind) {
      case ShapeKind::height: return height();
      case ShapeKind::slope: return slope();
      case ShapeKind::azimuth: return facing();
      case ShapeKind::roughness:
      case ShapeKind::mean_curvature:
      case ShapeKind::gaussian_curvature:
      case ShapeKind::max_curvature:
      case ShapeKind::min_curvature: return fitted();
      case ShapeKind::ambient_occlusion: return openness();
      case ShapeKind::boundary_distance: return to_boundary();
      case ShapeKind::model_distance: return to_model();
      case ShapeKind::change:
      case ShapeKind::level_of_detection:
      case ShapeKind::significant_change: return change();
      case ShapeKind::sun_hours:
      case ShapeKind::sun_energy: return sun();
      case ShapeKind::driving_rain: return rain();
      case ShapeKind::vertex_property: return property();
      case ShapeKind::part:
        return SurfaceValue([this](std::uint32_t t, const glm::vec3&) {
          return static_cast<double>(geometry_->part_of(t));
        });
      case ShapeKind::lightness: break;
    }
    return fail(ErrorCode::internal, "Unknown kind",
                "The server does not support this kind of layer.");
  }
  std::string other_model() const { return other_model_; }
  std::string source() const { return source_; }

 private:
  double in_units(double millimetres) const { return millimetres / 1000 / model_.metres(); }
  glm::dvec3 world(std::uint32_t triangle, const glm::vec3& weights) const {
    glm::dvec3 point(0);
    for (int k = 0; k < 3; ++k)
      point +=
          double{weights[k]} *
          geometry_
              ->positions[geometry_->vertices[geometry_->indices[3 * std::size_t{triangle} + k]]
                              .position_index];
    return point;
  }
  // Returns the spacing of `points` points that cover the surface evenly. It does not depend on the
  // mesh.
  float even_spacing(double points) const {
    return static_cast<float>(std::sqrt(std::max(model_.area, 1e-300) / points));
  }

  Result<SurfaceValue> sampled(float spacing, const mesh::PointFunction& function) {
    const mesh::SurfaceNormals normals(geometry_);
    auto field =
        STRATA_TRY(mesh::SampledField::make(geometry_, normals, spacing, function, progress_));
    auto shared = std::make_shared<const mesh::SampledField>(std::move(field));
    return SurfaceValue(
        [shared](std::uint32_t triangle, const glm::vec3& w) { return shared->at(triangle, w); });
  }

  Result<SurfaceValue> height() {
    const glm::dvec3 up = up_frame(model_.up).up;
    // `up` is an axis, so the lowest corner of the box has the height of the lowest point.
    const double zero = recipe_.absolute ? 0
                                         : std::min(glm::dot(up, model_.bounds_min),
                                                    glm::dot(up, model_.bounds_max));
    return SurfaceValue([this, up, zero](std::uint32_t t, const glm::vec3& w) {
      return glm::dot(world(t, w), up) - zero;
    });
  }

  Result<SurfaceValue> slope() {
    auto normals = std::make_shared<const mesh::SurfaceNormals>(geometry_);
    const glm::vec3 up(up_frame(model_.up).up);
    return SurfaceValue([normals, up](std::uint32_t t, const glm::vec3& w) {
      return glm::degrees(std::acos(std::clamp(glm::dot(normals->at(t, w), up), -1.0f, 1.0f)));
    });
  }

  Result<SurfaceValue> facing() {
    auto normals = std::make_shared<const mesh::SurfaceNormals>(geometry_);
    return SurfaceValue([normals, compass = Compass(model_)](std::uint32_t t, const glm::vec3& w) {
      return azimuth(compass, normals->at(t, w));
    });
  }

  Result<SurfaceValue> fitted() {
    const auto radius = static_cast<float>(in_units(*recipe_.radius_mm));
    progress_.begin_stage(0, kPrepared);
    const auto made = STRATA_TRY(mesh::SurfaceSamples::make(*geometry_, radius, progress_));
    const mesh::SurfaceSamples& samples = made;
    progress_.begin_stage(kPrepared, kMeasured);
    const auto curvature = [&](auto part) {
      return [&samples, part](const glm::vec3& p, const glm::vec3& n) {
        const auto c = mesh::curvature_at(samples, p, n);
        return c ? static_cast<float>(part(*c)) : kNone;
      };
    };
    const float spacing = std::max(radius / 3, even_spacing(1e6));
    switch (recipe_.kind) {
      case ShapeKind::mean_curvature:
        return sampled(spacing, curvature([](const auto& c) { return c.mean(); }));
      case ShapeKind::gaussian_curvature:
        return sampled(spacing, curvature([](const auto& c) { return c.gaussian(); }));
      case ShapeKind::max_curvature:
        return sampled(spacing, curvature([](const auto& c) { return c.max; }));
      case ShapeKind::min_curvature:
        return sampled(spacing, curvature([](const auto& c) { return c.min; }));
      default: break;
    }
    return sampled(spacing, [&samples](const glm::vec3& p, const glm::vec3& n) {
      const auto roughness = mesh::roughness_at(samples, p, n);
      return roughness ? static_cast<float>(*roughness) : kNone;
    });
  }

  Result<SurfaceValue> openness() {
    progress_.begin_stage(0, kPrepared);
    auto rays = STRATA_TRY(mesh::Openness::make(
        geometry_, static_cast<float>(in_units(*recipe_.distance_mm)), *recipe_.rays, progress_));
    progress_.begin_stage(kPrepared, kMeasured);
    return sampled(even_spacing(5e5),
                   [&](const glm::vec3& p, const glm::vec3& n) { return (rays)->at(p, n); });
  }

  Result<SurfaceValue> sun() {
    const auto [first, days] = days_of(recipe_);
    return exposed(mesh::sun_sectors(*recipe_.latitude_deg, {first, days}),
                   recipe_.kind == ShapeKind::sun_hours ? &mesh::SkyExposure::Sum::hours
                                                        : &mesh::SkyExposure::Sum::amount);
  }

  Result<SurfaceValue> rain() {
    return exposed(mesh::rain_sectors({recipe_.wind_shares, *recipe_.wind_speed_m_s,
                                       *recipe_.rain_mm, *recipe_.rain_mm_per_hour}),
                   &mesh::SkyExposure::Sum::amount);
  }

  // The directions of the sectors are east, north and up.
  Result<SurfaceValue> exposed(std::vector<mesh::SkySector> sectors,
                               double mesh::SkyExposure::Sum::*part) {
    progress_.begin_stage(0, kPrepared);
    const UpFrame frame = up_frame(model_.up);
    const double turned = glm::radians(*recipe_.north_deg);
    const glm::dvec3 north = std::cos(turned) * frame.into + std::sin(turned) * frame.right,
                     east = std::cos(turned) * frame.right - std::sin(turned) * frame.into;
    for (mesh::SkySector& sector : sectors) {
      const glm::dvec3 way = sector.direction;
      sector.direction = way.x * east + way.y * north + way.z * frame.up;
    }
    const auto sky = STRATA_TRY(mesh::SkyExposure::make(geometry_, std::move(sectors), progress_));
    progress_.begin_stage(kPrepared, kMeasured);
    return sampled(even_spacing(5e5), [&](const glm::vec3& p, const glm::vec3& n) {
      return static_cast<float>(sky->at(p, n).*part);
    });
  }

  Result<SurfaceValue> to_boundary() {
    progress_.report(0, "Looking for open edges");
    const mesh::BoundaryDistance distance(*geometry_);
    if (distance.is_closed())
      return fail(ErrorCode::invalid, "No open edges",
                  "This model is closed. It has no open edge, so there is no distance to measure.",
                  "compute.kind");
    return sampled(even_spacing(1e6),
                   [&](const glm::vec3& p, const glm::vec3&) { return distance.at(p); });
  }

  struct Other {
    GeometryPtr geometry;
    double metres;
  };
  Result<Other> read_other_model() {
    auto other = store_.models().find(recipe_.model);
    if (!other) return refuse_model(other.error());
    if (other->id == model_.id)
      return fail(ErrorCode::invalid, "Same model",
                  "The distance of a model to itself is always 0. Choose another model.",
                  "compute.model");
    if (!other->crs.empty() && !model_.crs.empty() && other->crs != model_.crs)
      return fail(ErrorCode::invalid, "Different coordinate systems",
                  "This model has the coordinate system " + model_.crs +
                      ", but the other model has " + other->crs +
                      ". Transform both scans into one coordinate system and import them again.",
                  "compute.model");
    other_model_ = other->name;
    progress_.report(0, "Reading the other model");
    auto bytes = store_.models().geometry(other->id);
    if (!bytes) return refuse_model(bytes.error());
    auto there = STRATA_TRY(mesh::decode_geometry(*bytes));
    return Other{std::make_shared<const mesh::Geometry>(std::move(there)), other->metres()};
  }

  Result<SurfaceValue> to_model() {
    const auto other = STRATA_TRY(read_other_model());
    const mesh::ModelDistance distance(geometry_->origin, model_.metres(), other.geometry,
                                       other.metres, in_units(*recipe_.distance_mm));
    return sampled(even_spacing(1e6),
                   [&](const glm::vec3& p, const glm::vec3&) { return distance.at(p); });
  }

  Result<SurfaceValue> change() {
    const auto other = STRATA_TRY(read_other_model());
    const mesh::ChangeScales scales{
        in_units(*recipe_.normal_scale_mm), in_units(*recipe_.projection_scale_mm),
        in_units(*recipe_.distance_mm), in_units(*recipe_.registration_mm)};
    const auto made = STRATA_TRY(mesh::ModelChange::make(
        *geometry_, model_.metres(), *other.geometry, other.metres, scales, progress_, kPrepared));
    progress_.begin_stage(kPrepared, kMeasured);
    // The values are means over the cylinder, so a quarter of its diameter loses no detail.
    const float spacing = std::max(static_cast<float>(scales.projection / 4), even_spacing(1e6));
    const auto measured = [&](auto part) {
      return sampled(spacing, [&made, part](const glm::vec3& p, const glm::vec3& n) {
        const auto found = made.at(p, n);
        return found ? static_cast<float>(part(*found)) : kNone;
      });
    };
    using Change = mesh::ModelChange::Change;
    const double mm = model_.metres() * 1000;
    if (recipe_.kind == ShapeKind::change)
      return measured([=](const Change& c) { return c.distance * mm; });
    if (recipe_.kind == ShapeKind::level_of_detection)
      return measured([=](const Change& c) { return c.detection * mm; });
    // The ratio is interpolated between the samples, and then divided into classes. It is limited,
    // so that a very large ratio of one sample does not outweigh its neighbors.
    const auto ratio = STRATA_TRY(measured([](const Change& c) {
      return std::clamp(c.distance / c.detection, -kMaxRatio, kMaxRatio);
    }));
    return SurfaceValue([ratio](std::uint32_t t, const glm::vec3& w) {
      const double times = ratio(t, w);
      if (std::isnan(times)) return times;
      return times > 1 ? 1.0 : times < -1 ? 2.0 : 0.0;
    });
  }
  static tl::unexpected<Error> refuse_model(Error problem) {
    if (problem.code == ErrorCode::not_found) problem.field = "compute.model";
    return tl::unexpected(std::move(problem));
  }

  // Reads the property from the named source file, or else from the only source file with this
  // property.
  Result<SurfaceValue> property() {
    std::vector<std::string> having;
    for (const SourceFile& source : model_.source_files) {
      if (!recipe_.source.empty() && source.name != recipe_.source) continue;
      std::vector<std::uint8_t> beginning;
      auto read = store_.models().read_source(model_.id, source.name,
                                              [&](std::span<const std::uint8_t> chunk) {
                                                beginning.assign(chunk.begin(), chunk.end());
                                                return false;
                                              });
      if (!read) return tl::unexpected(read.error());
      const auto names = mesh::vertex_property_names(beginning);
      if (std::find(names.begin(), names.end(), recipe_.property) != names.end())
        having.push_back(source.name);
    }
    if (having.size() != 1)
      return fail(
          ErrorCode::invalid, having.empty() ? "Property not found" : "Property in several files",
          having.empty() ? "No source file of this model has vertices with a numeric property \"" +
                               recipe_.property + "\"."
                         : "Several source files have the property \"" + recipe_.property +
                               "\". Choose one of these files.",
          having.empty() ? "compute.property" : "compute.source");
    source_ = having.front();
    progress_.report(0, "Reading the scan");
    auto file = STRATA_TRY(read_source(store_, model_, source_, progress_));
    auto column = STRATA_TRY(mesh::read_vertex_property(file, recipe_.property));
    return at_vertices(geometry_, mesh::values_at_positions(*geometry_, column, !is_float(type_)),
                       type_);
  }

  store::Store& store_;
  const Model& model_;
  const GeometryPtr geometry_;
  const ShapeRecipe& recipe_;
  const ValueType type_;
  Progress& progress_;
  std::string other_model_, source_;
};

// Returns the range of the painted values, computed from texels at equal steps.
ValueRange range_of(const TileMap& tiles, ValueType type) {
  constexpr std::size_t kMaxValues = 1'000'000;
  const std::size_t step = std::max<std::size_t>(1, tiles.size() * kTexelsPerTile / kMaxValues);
  std::vector<float> values;
  double least = INFINITY, most = -INFINITY;
  for (const auto& [address, tile] : tiles)
    for (std::size_t texel = 0; texel < kTexelsPerTile; texel += step) {
      if (!tile->valid.test(static_cast<int>(texel))) continue;
      const double value = decode_value(type, tile->bits(static_cast<int>(texel)));
      values.push_back(static_cast<float>(value));
      least = std::min(least, value);
      most = std::max(most, value);
    }
  if (values.empty()) return {};
  const auto quantile = [&](double share) {
    const auto at = values.begin() +
                    static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return double{*at};
  };
  return {least, quantile(0.02), quantile(0.98), most};
}

// Paints values at all texels. If `rounds` is true, measured values are rounded for integer types.
// Otherwise all values must fit the type. `from` is the share of the work that is already done.
Result<TileMap> paint(const mesh::Geometry& geometry, const SurfaceValue& value, ValueType type,
                      int resolution, bool rounds, double from, Progress& progress) {
  progress.begin_stage(from, (1 + from) / 2);
  const auto owners = STRATA_TRY(mesh::bake_texel_owners(geometry, resolution, progress));
  progress.begin_stage((1 + from) / 2, 1);
  std::mutex mutex;
  std::optional<Error> unfit;
  const auto bits = [&](std::size_t texel) -> std::optional<std::uint32_t> {
    const double number = value(owners.triangle[texel], owners.weights_of(texel));
    if (!std::isfinite(number)) return std::nullopt;
    auto encoded = encode_value(type, rounds && !is_float(type) ? std::round(number) : number);
    if (encoded) return *encoded;
    std::lock_guard lock(mutex);
    unfit = encoded.error();
    unfit->field = "type";
    progress.cancel();
    return std::nullopt;
  };
  auto tiles = mesh::paint_texels(owners, type, bits, progress);
  if (unfit) return tl::unexpected(*unfit);
  return tiles;
}

}  // namespace

Result<std::vector<std::uint8_t>> read_source(store::Store& store, const Model& model,
                                              const std::string& source, Progress& progress) {
  std::vector<std::uint8_t> file;
  STRATA_TRY(store.models().read_source(model.id, source, [&](std::span<const std::uint8_t> chunk) {
    file.insert(file.end(), chunk.begin(), chunk.end());
    return !progress.cancelled();
  }));
  if (progress.cancelled()) return cancelled_problem();
  return file;
}

Result<TileMap> paint_normals(const std::shared_ptr<const mesh::Geometry>& geometry, int axis,
                              int resolution, Progress& progress) {
  const mesh::SurfaceNormals normals(geometry);
  const auto component = [&](std::uint32_t triangle, const glm::vec3& weights) {
    return normals.at(triangle, weights)[axis];
  };
  return paint(*geometry, component, ValueType::f32, resolution, false, 0, progress);
}

Result<TileMap> paint_vertex_values(const std::shared_ptr<const mesh::Geometry>& geometry,
                                    std::vector<double> values, ValueType type, int resolution,
                                    Progress& progress) {
  return paint(*geometry, at_vertices(geometry, std::move(values), type), type, resolution, false,
               0, progress);
}

Result<ShapeLayer> compute_shape_layer(store::Store& store, const Model& model,
                                       const std::shared_ptr<const mesh::Geometry>& geometry,
                                       const ShapeRecipe& recipe, ValueType type, int resolution,
                                       Progress& progress) {
  progress.begin_stage(0, kMeasured);
  Measure measure(store, model, geometry, recipe, type, progress);
  const auto value = STRATA_TRY(measure.value());
  const bool rounds = recipe.kind != ShapeKind::vertex_property;
  auto tiles = STRATA_TRY(paint(*geometry, value, type, resolution, rounds, kMeasured, progress));

  ShapeRecipe used = recipe;
  if (used.kind == ShapeKind::vertex_property) used.source = measure.source();
  return described(std::move(tiles), used, model, type, measure.other_model());
}

ShapeLayer described(TileMap tiles, const ShapeRecipe& recipe, const Model& model, ValueType type,
                     const std::string& other) {
  ShapeLayer layer;
  layer.tiles = std::move(tiles);
  layer.unit = unit_of(recipe, model);
  layer.description = description_of(recipe, model, other);
  layer.palette = recipe.kind == ShapeKind::part
                      ? palette_of(model.parts)
                      : palette_of(recipe.kind, range_of(layer.tiles, type));
  layer.recipe = to_json(recipe);
  return layer;
}

}  // namespace strata::jobs
