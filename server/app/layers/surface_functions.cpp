#include "app/layers/surface_functions.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <memory>
#include <string>
#include <utility>

#include "app/layers/layer_views.h"
#include "app/layers/reserved_regions.h"
#include "domain/scene/model.h"
#include "domain/scene/up.h"
#include "mesh/parallel.h"
#include "mesh/surface/geometry.h"
#include "mesh/texels/texel_graph.h"
#include "query/conditions/expression_evaluator.h"
#include "query/interpolation/interpolate.h"
#include "query/regions/distance_values.h"
#include "query/regions/focal.h"
#include "query/regions/hysteresis.h"
#include "query/regions/line_depth.h"
#include "query/regions/majority.h"
#include "query/regions/open_close.h"
#include "query/regions/run_off.h"
#include "query/regions/sieve.h"
#include "query/regions/watershed.h"
#include "room/pipeline/expression_binding.h"
#include "room/rooms.h"
#include "room/surface.h"

namespace strata::app {
namespace {

// Bytes per texel of the map while one function is computed, and of the values of each function.
constexpr std::uint64_t kWorkBytesPerTexel = 60, kValueBytesPerTexel = 5;

// The part of a job in which a function is computed.
struct Stage {
  double from, to;
};

// Computes functions of one formula.
class SurfaceFunctionValues {
 public:
  SurfaceFunctionValues(const Services& services, room::Room& room, const Layer& layer,
                        const Author& author, std::shared_ptr<const mesh::SurfaceMap> map,
                        std::shared_ptr<const mesh::TexelGraph> graph)
      : services_(services),
        layer_(layer),
        author_(author),
        geometry_(room.surface().geometry()),
        map_(std::move(map)),
        graph_(std::move(graph)),
        frame_{geometry_->origin, room.model().metres()},
        up_(up_frame(room.model().up).up) {}

  // Reads `views`, and returns the values as one more.
  Result<query::LayerView> compute(const query::SurfaceFormula::Function& requested,
                                   const std::vector<query::LayerView>& views, Progress& progress,
                                   Stage stage) const {
    progress.begin_stage(stage.from, stage.to);
    const Expression& argument = requested.function.parts.front();
    const auto bound = STRATA_TRY(room::bind_for_layer(argument, views, services_.store,
                                                       author_.role, layer_.visibility, kField));
    query::LayerView result;
    result.layer.slug = requested.slug;
    result.layer.resolution = layer_.resolution;
    // f32 does not hold all keys
    result.layer.type =
        requested.function.chooses_value() ? type_of(argument, views) : ValueType::f32;
    auto values = STRATA_TRY(
        argument.is_condition()
            ? of_condition(bound, requested.function, progress, stage)
            : of_numbers(bound, requested.function, type_of(argument, views), progress, stage));
    result.snapshot.tiles =
        STRATA_TRY(query::make_tiles(result.layer.type, *map_, std::move(values), progress));
    return result;
  }

 private:
  using Op = Expression::Op;
  static constexpr const char* kField = "expression";
  static constexpr std::uint32_t kTrue = std::bit_cast<std::uint32_t>(1.0f);

  static bool is_cleanup(Op op) { return op >= Op::sieve && op <= Op::closing; }

  Result<query::SurfaceValues> of_condition(const room::BoundForLayer& condition,
                                            const Expression& function, Progress& progress,
                                            Stage stage) const {
    auto selected = STRATA_TRY(query::select_where(condition.expression, condition.layers, *map_,
                                                   kField, mesh::background_threads(), frame_));
    if (function.op == Op::distance)
      return query::distance_values(selected, function.number, *map_, *graph_, progress,
                                    mesh::background_threads());
    query::SurfaceValues values{std::vector<std::uint32_t>(selected.size() * 64), {}};
    for (std::uint32_t texel = 0; texel < values.bits.size(); ++texel)
      if ((selected[texel / 64] >> texel % 64 & 1u) != 0) values.bits[texel] = kTrue;
    values.valid = std::move(selected);
    return cleaned(std::move(values), function, progress, stage);
  }

  Result<query::SurfaceValues> cleaned(query::SurfaceValues values, const Expression& function,
                                       Progress& progress, Stage stage) const {
    auto result = clean(std::move(values), function, progress, stage);
    if (!result && !result.error().field.empty()) result.error().field = kField;
    return result;
  }

  Result<query::SurfaceValues> clean(query::SurfaceValues values, const Expression& function,
                                     Progress& progress, Stage stage) const {
    const int threads = mesh::background_threads();
    if (function.op == Op::opening)
      return query::open_value(std::move(values), kTrue, function.number / 2, *map_, *graph_,
                               progress, threads);
    if (function.op == Op::closing)
      return query::close_value(std::move(values), kTrue, function.number / 2, *map_, *graph_,
                                progress, threads);
    if (function.op == Op::majority)
      return query::majority(std::move(values), {function.number, frame_.metres}, *map_, *graph_,
                             progress, threads);
    const double found = (stage.from + stage.to) / 2;
    progress.begin_stage(stage.from, found);
    const auto regions =
        STRATA_TRY(find_reserved_regions(services_, values, *map_, *graph_, progress));
    progress.begin_stage(found, stage.to);
    auto changed =
        STRATA_TRY(function.op == Op::fill_holes
                       ? query::fill_holes(std::move(values), regions.regions, function.number,
                                           *map_, *graph_, progress)
                       : query::sieve(std::move(values), regions.regions, function.number,
                                      query::SieveTo::longest_border, *map_, *graph_, progress));
    return std::move(changed.values);
  }

  Result<query::SurfaceValues> of_numbers(const room::BoundForLayer& number,
                                          const Expression& function, ValueType type,
                                          Progress& progress, Stage stage) const {
    const int threads = mesh::background_threads();
    const auto tiles = STRATA_TRY(query::compute_tiles(number.expression, number.layers, *map_,
                                                       frame_, type, kField, threads));
    auto values = query::read_surface_values(tiles, type, *map_);
    if (is_cleanup(function.op)) return cleaned(std::move(values), function, progress, stage);
    if (function.op == Op::nearest)
      return query::nearest_values(values, function.number, *map_, *graph_, progress, threads);
    if (function.op == Op::interpolated || function.op == Op::interpolation_error)
      return query::interpolated_values(
          function.op == Op::interpolated ? query::Interpolated::mean : query::Interpolated::error,
          values, type, function.number, *map_, *graph_, kField, progress, threads);
    if (function.op == Op::watershed)
      return query::watershed_values(values, type, function.number, *map_, *graph_, kField,
                                     progress);
    if (function.op == Op::run_off) return run_off(values, type, progress, stage);
    if (function.op == Op::valley || function.op == Op::ridge)
      return query::line_depth_values(
          function.op == Op::valley ? query::Line::valley : query::Line::ridge, values, type,
          function.number, *map_, *graph_, kField, progress, threads);
    if (function.op == Op::hysteresis)
      return query::hysteresis_values(values, type, {function.parts[1].number, function.number},
                                      *map_, *graph_, progress);
    if (function.op == Op::hot_spot_chance)
      return query::hot_spot_chances(values, type, function.number,
                                     static_cast<int>(function.parts[1].number), *map_, *graph_,
                                     kField, progress, threads);
    return query::focal_values(focal_of(function.op), values, type, function.number, *map_, *graph_,
                               kField, progress, threads);
  }

  // In litres per metre of width, from the rain in l/m².
  Result<query::SurfaceValues> run_off(const query::SurfaceValues& rain, ValueType type,
                                       Progress& progress, Stage stage) const {
    const double drips_found = (2 * stage.from + stage.to) / 3,
                 rays_made = (stage.from + stage.to) / 2;
    progress.begin_stage(stage.from, drips_found);
    const auto drips = STRATA_TRY(
        query::dripping_texels(geometry_, *map_, up_, progress, mesh::background_threads()));
    progress.begin_stage(drips_found, rays_made);
    const auto falls =
        STRATA_TRY(query::WaterFalls::make(geometry_, *map_, *graph_, up_, progress));
    progress.begin_stage(rays_made, stage.to);
    auto water =
        STRATA_TRY(query::run_off(rain, type, up_, drips, falls, *map_, *graph_, progress)).passing;
    for (std::uint32_t& bits : water.bits)
      bits = std::bit_cast<std::uint32_t>(
          static_cast<float>(double{std::bit_cast<float>(bits)} * frame_.metres));
    return water;
  }

  static query::Focal focal_of(Op op) {
    switch (op) {
      case Op::focal_min: return query::Focal::min;
      case Op::focal_max: return query::Focal::max;
      case Op::focal_variety: return query::Focal::variety;
      case Op::hot_spot: return query::Focal::hot_spot;
      default: return query::Focal::mean;
    }
  }

  static ValueType type_of(const Expression& number, const std::vector<query::LayerView>& views) {
    if (number.op != Expression::Op::layer) return ValueType::f32;
    const auto found =
        std::ranges::find(views, number.name, [](const auto& view) { return view.layer.slug; });
    return found == views.end() ? ValueType::f32 : found->layer.type;
  }

  const Services& services_;
  const Layer& layer_;
  const Author& author_;
  const std::shared_ptr<const mesh::Geometry> geometry_;
  const std::shared_ptr<const mesh::SurfaceMap> map_;
  const std::shared_ptr<const mesh::TexelGraph> graph_;
  const query::Frame frame_;
  const glm::dvec3 up_;
};

}  // namespace

Result<MemoryLedger::Share> reserve_surface_functions(const Services& services, room::Room& room,
                                                      const Layer& layer,
                                                      const query::SurfaceFormula& formula) {
  const auto map = STRATA_TRY(room.surface().map(layer.resolution));
  const auto graph = STRATA_TRY(room.surface().graph(layer.resolution));
  const bool interpolates = std::ranges::any_of(formula.functions, [](const auto& each) {
    const auto op = each.function.op;
    return op == Expression::Op::interpolated || op == Expression::Op::interpolation_error;
  });
  return services.rooms.memory().reserve(
      map->block_of_slot.size() * 64 *
              (kWorkBytesPerTexel + formula.functions.size() * kValueBytesPerTexel) +
          graph->linked_texels() * kBytesPerLinkedTexel +
          (interpolates ? query::kInterpolationBytes : 0),
      "functions along the surface");
}

Result<void> compute_surface_functions(const Services& services, room::Room& room,
                                       const Layer& layer, const query::SurfaceFormula& formula,
                                       const Author& author, std::vector<query::LayerView>& shapes,
                                       Progress& progress, std::size_t first, std::size_t steps) {
  auto map = STRATA_TRY(room.surface().map(layer.resolution));
  auto graph = STRATA_TRY(room.surface().graph(layer.resolution));
  const SurfaceFunctionValues values(services, room, layer, author, std::move(map),
                                     std::move(graph));
  std::vector<std::string> read;
  for (const auto& function : formula.functions)
    std::ranges::copy(layers_of(function.function), std::back_inserter(read));
  std::vector<query::LayerView> views = STRATA_TRY(views_read(room, read));
  views.insert(views.end(), shapes.begin(), shapes.end());
  for (const auto& function : formula.functions) {
    const Stage stage{double(first) / double(steps), double(first + 1) / double(steps)};
    ++first;
    auto computed = STRATA_TRY(values.compute(function, views, progress, stage));
    if (progress.cancelled()) return cancelled_problem();
    views.push_back(computed);
    shapes.push_back(std::move(computed));
  }
  return {};
}

}  // namespace strata::app
