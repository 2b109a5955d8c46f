#include "query/sampling/values.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "domain/layers/texel_lookup.h"
#include "domain/people/question.h"
#include "domain/scene/camera.h"
#include "mesh/parallel.h"
#include "mesh/surface/search_tree.h"
#include "mesh/texels/texel_graph.h"
#include "query/sampling/nearest_points.h"
#include "query/sampling/surface_point.h"

namespace strata::query {
namespace {

bool is_finite(const glm::vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

SurfacePoint surface_point(const mesh::SearchTree::Hit& hit, const glm::dvec3& origin,
                           const std::vector<LayerView>& layers) {
  SurfacePoint point{true, glm::dvec3(hit.position) + origin, hit.normal, hit.distance, hit.uv, {}};
  point.values.reserve(layers.size());
  for (const auto& layer : layers) point.values.push_back(value_at(layer, hit.uv));
  return point;
}

SurfacePoint off_the_model(const std::vector<LayerView>& layers) {
  SurfacePoint point;
  for (const auto& layer : layers) point.values.push_back({layer.layer.slug, false, 0});
  return point;
}

LayerValue value_at(const LayerView& view, glm::vec2 uv) {
  const auto bits = bits_at(view.snapshot.tiles, view.layer.resolution, uv);
  if (!bits) return {view.layer.slug, false, 0};
  return {view.layer.slug, true, decode_value(view.layer.type, *bits)};
}

SurfacePoint nearest_point(const mesh::SearchTree& tree, const glm::dvec3& origin,
                           const glm::dvec3& world_point, const std::vector<LayerView>& layers) {
  const glm::vec3 in_model(world_point - origin);
  if (!is_finite(in_model)) return off_the_model(layers);
  const auto hit = tree.nearest(in_model, std::numeric_limits<float>::max());
  return hit ? surface_point(*hit, origin, layers) : off_the_model(layers);
}

namespace {

// Returns the index along a curve through the bounding box of the points (Morton 1966). Neighbors
// on the curve are mostly neighbors in space.
std::uint64_t curve_index(const glm::dvec3& place) {
  std::uint64_t index = 0;
  for (int axis = 0; axis < 3; ++axis) {
    auto bits = static_cast<std::uint64_t>(std::clamp(place[axis], 0.0, 1.0) * 0x1fffff);
    for (const auto& [shift, mask] : {std::pair{32, 0x1f00000000ffffull},
                                      {16, 0x1f0000ff0000ffull},
                                      {8, 0x100f00f00f00f00full},
                                      {4, 0x10c30c30c30c30c3ull},
                                      {2, 0x1249249249249249ull}})
      bits = (bits | bits << shift) & mask;
    index |= bits << axis;
  }
  return index;
}

}  // namespace

std::vector<SurfacePoint> nearest_points(const mesh::SearchTree& tree, const glm::dvec3& origin,
                                         std::span<const glm::dvec3> world_points,
                                         const std::vector<LayerView>& layers, int threads) {
  constexpr float kFar = std::numeric_limits<float>::max();
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const glm::dvec3& point : world_points)
    low = glm::min(low, point), high = glm::max(high, point);
  const glm::dvec3 size = glm::max(high - low, 1e-300);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(world_points.size());
  for (std::uint32_t i = 0; i < world_points.size(); ++i)
    order.emplace_back(curve_index((world_points[i] - low) / size), i);
  std::ranges::sort(order);
  constexpr std::size_t kPointsAtOnce = 1024;
  std::vector<SurfacePoint> points(world_points.size());
  mesh::parallel_for(
      threads, static_cast<int>((order.size() + kPointsAtOnce - 1) / kPointsAtOnce), [&](int part) {
        const std::size_t first = static_cast<std::size_t>(part) * kPointsAtOnce;
        // a point on the surface; the nearest point cannot be farther away
        std::optional<glm::vec3> last;
        for (std::size_t i = first; i < std::min(order.size(), first + kPointsAtOnce); ++i) {
          const std::uint32_t number = order[i].second;
          const glm::vec3 in_model(world_points[number] - origin);
          if (!is_finite(in_model)) {
            points[number] = off_the_model(layers);
            continue;
          }
          // Slightly more than the distance, because the distance is rounded.
          const float limit =
              last ? std::min(kFar, glm::distance(in_model, *last) * 1.0001f + 1e-30f) : kFar;
          auto hit = tree.nearest(in_model, limit);
          if (!hit) hit = tree.nearest(in_model, kFar);
          points[number] = hit ? surface_point(*hit, origin, layers) : off_the_model(layers);
          if (hit) last = hit->position;
        }
      });
  return points;
}

SurfacePoint pick(const mesh::SearchTree& tree, const glm::dvec3& origin, const Camera& camera,
                  double x, double y, const std::vector<LayerView>& layers) {
  if (!(x >= 0 && y >= 0 && x <= camera.width && y <= camera.height)) return off_the_model(layers);
  const Ray ray = ray_through_pixel(camera, x, y);
  const RaySpan span = uncut_span(camera, ray);
  if (span.begin > span.end) return off_the_model(layers);
  const glm::vec3 start(ray.origin + span.begin * ray.direction - origin), direction(ray.direction);
  if (!is_finite(start) || !is_finite(direction)) return off_the_model(layers);
  auto hit = tree.first_hit(start, direction, camera.hidden_parts);
  if (!hit || span.begin + hit->distance > span.end) return off_the_model(layers);
  if (eye_is_cut_away(camera) && glm::dot(hit->normal, direction) > 0)
    return off_the_model(layers);  // inside a solid
  hit->distance += static_cast<float>(span.begin);
  return surface_point(*hit, origin, layers);
}

namespace {

// Calls visit(cell, pixel, point) for the surface point at the center of each cell of a grid over
// the window of the camera, on several threads. Cells are numbered row by row from the top left,
// and those without a surface are left out.
template <class Visit>
void for_each_seen(const mesh::SearchTree& tree, const glm::dvec3& origin, const Camera& camera,
                   int columns, int rows, const std::vector<LayerView>& layers,
                   const Visit& visit) {
  mesh::parallel_for(mesh::background_threads(), rows, [&](int row) {
    const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns);
    for (int column = 0; column < columns; ++column) {
      const glm::dvec2 pixel{(column + 0.5) * camera.width / columns,
                             (row + 0.5) * camera.height / rows};
      const auto point = pick(tree, origin, camera, pixel.x, pixel.y, layers);
      if (point.hit) visit(first + static_cast<std::size_t>(column), pixel, point);
    }
  });
}

std::size_t cells_of(int columns, int rows) {
  return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
}
void spend_cells(std::size_t cells) {
  if (Question* question = Question::current()) question->spend(cells);
}

}  // namespace

std::vector<std::optional<std::uint32_t>> seen_keys(const mesh::SearchTree& tree,
                                                    const glm::dvec3& origin, const Camera& camera,
                                                    int columns, int rows, const LayerView& layer) {
  std::vector<std::optional<std::uint32_t>> keys(cells_of(columns, rows));
  for_each_seen(tree, origin, camera, columns, rows, {layer},
                [&](std::size_t cell, const glm::dvec2&, const SurfacePoint& point) {
                  if (const LayerValue& value = point.values[0]; value.valid)
                    keys[cell] = static_cast<std::uint32_t>(static_cast<std::int64_t>(value.value));
                });
  return keys;
}

std::vector<std::uint8_t> picture_of_values(const mesh::SearchTree& tree, const glm::dvec3& origin,
                                            const Camera& camera, int columns, int rows,
                                            const LayerView& layer) {
  constexpr double kBare = 190;      // gray of surface without a value
  constexpr double kDarkest = 0.35;  // share of the light where the view is grazing
  const std::size_t cells = cells_of(columns, rows);
  spend_cells(cells);
  std::vector<std::uint8_t> rgba(cells * 4, 0);
  for_each_seen(
      tree, origin, camera, columns, rows, {layer},
      [&](std::size_t cell, const glm::dvec2& pixel, const SurfacePoint& point) {
        const glm::dvec3 ray = ray_through_pixel(camera, pixel.x, pixel.y).direction;
        const double facing = std::abs(glm::dot(glm::dvec3(point.normal), ray));
        const double light = kDarkest + (1 - kDarkest) * facing;
        const LayerValue& value = point.values[0];
        const Rgba color = value.valid ? color_of(layer.layer.palette, value.value) : Rgba{};
        const double covered = color[3] / 255.0;
        std::uint8_t* out = &rgba[cell * 4];
        for (std::size_t channel = 0; channel < 3; ++channel)
          out[channel] = static_cast<std::uint8_t>(
              std::lround(light * std::lerp(kBare, static_cast<double>(color[channel]), covered)));
        out[3] = 255;
      });
  return rgba;
}

std::vector<std::uint8_t> seen_selection(const mesh::SearchTree& tree, const glm::dvec3& origin,
                                         const Camera& camera, int columns, int rows,
                                         const mesh::SurfaceMap& map,
                                         const std::vector<std::uint64_t>* selection) {
  const std::size_t cells = cells_of(columns, rows);
  spend_cells(cells);
  std::vector<std::uint8_t> seen(cells, 0);
  for_each_seen(
      tree, origin, camera, columns, rows, {},
      [&](std::size_t cell, const glm::dvec2&, const SurfacePoint& point) {
        const auto texel = mesh::surface_texel_at(map, point.uv);
        if (!texel) return;
        // a word of TexelSelection has the 64 texels of a slot
        if (selection == nullptr || ((*selection)[*texel / 64] >> (*texel % 64) & 1u) != 0)
          seen[cell] = 1;
      });
  return seen;
}

}  // namespace strata::query
