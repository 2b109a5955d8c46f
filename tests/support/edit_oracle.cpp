#include "support/edit_oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "media/shape_texture.h"
#include "render/edit/depth_bias.h"
#include "render/edit/tool_path.h"

namespace strata::test {
namespace {

constexpr double kRounding_px = 2e-3;
constexpr double kRoundingDepth = 1e-6;
constexpr double kRoundingAngle_rad = 5e-4;
constexpr double kRoundingOfSize = 1e-6;  // at a section plane, relative to the model's diagonal

// Returns whether the line between two points of a shape's raster passes through a cell of the
// tool. Tests each row cell by cell, without the distance jumps of the shader. A positive `slack`
// (in cells) enlarges the shape on all sides; a negative one shrinks it.
bool line_meets_shape(const ShapeTexture& shape, const glm::dvec2& a, const glm::dvec2& b,
                      double slack) {
  for (int y = 0; y < kShapeSide; ++y) {
    double low = 0, high = 1;
    const double first = y - slack, end = y + 1 + slack;
    if (a.y == b.y) {
      if (a.y < first || a.y > end) continue;
    } else {
      const double t0 = (first - a.y) / (b.y - a.y), t1 = (end - a.y) / (b.y - a.y);
      low = std::max(low, std::min(t0, t1));
      high = std::min(high, std::max(t0, t1));
      if (low > high) continue;
    }
    const double x0 = a.x + (b.x - a.x) * low, x1 = a.x + (b.x - a.x) * high;
    const auto cell = [](double x) {
      return static_cast<int>(std::clamp(std::floor(x), -2.0, kShapeSide + 2.0));
    };
    for (int x = std::max(0, cell(std::min(x0, x1)) - 1);
         x <= std::min(kShapeSide - 1, cell(std::max(x0, x1)) + 1); ++x)
      if (shape.is_set(x, y) && x - slack <= std::max(x0, x1) && x + 1 + slack >= std::min(x0, x1))
        return true;
  }
  return false;
}

// The equivalent of `inside` for a shape. Returns at least kRounding_px if the shape certainly
// covers the point, at most −kRounding_px if it certainly does not, and a value between them if
// rounding decides.
double inside_shape(const StrokeBatch& stroke, const std::vector<double>& radii,
                    const glm::dvec2& p) {
  const auto in_raster = [&](std::size_t i) {
    const glm::dvec2 center(stroke.path[i].x, stroke.camera.height - stroke.path[i].y);
    return ((p - center) * glm::dvec2(1, -1) / radii[i] + 1.0) * (kShapeSide / 2.0);
  };
  double best = -1;
  for (std::size_t i = stroke.path.size() == 1 ? 0 : 1; i < stroke.path.size(); ++i) {
    const std::size_t from = i == 0 ? 0 : i - 1;
    const glm::dvec2 a = in_raster(from), b = in_raster(i);
    if (glm::any(glm::lessThan(glm::max(a, b), glm::dvec2(-1))) ||
        glm::any(glm::greaterThan(glm::min(a, b), glm::dvec2(kShapeSide + 1))))
      continue;
    const double slack = kRounding_px * kShapeSide / 2 / std::min(radii[from], radii[i]);
    if (!line_meets_shape(*stroke.texture, a, b, slack)) continue;
    if (line_meets_shape(*stroke.texture, a, b, -slack)) return 1;
    best = std::max(
        best, line_meets_shape(*stroke.texture, a, b, 0) ? kRounding_px / 2 : -kRounding_px / 2);
  }
  return best;
}

// Returns the distance from a point inside the tool to the tool's outline, in pixels; negative
// outside. Searches each segment finely enough for kRounding_px, without the closed form of the
// shader.
double inside(const StrokeBatch& stroke, const std::vector<double>& radii, const glm::dvec2& p) {
  const auto point = [&](std::size_t i) {
    return glm::dvec2(stroke.path[i].x, stroke.camera.height - stroke.path[i].y);
  };
  const auto margin = [&](const glm::dvec2& center, double radius) {
    const glm::dvec2 d = glm::abs(p - center);
    return radius - (stroke.shape == ToolShape::disc ? glm::length(d) : std::max(d.x, d.y));
  };
  if (stroke.shape == ToolShape::texture) return inside_shape(stroke, radii, p);
  double best = margin(point(0), radii[0]);
  for (std::size_t i = 1; i < stroke.path.size(); ++i) {
    const glm::dvec2 a = point(i - 1), b = point(i);
    const double reach = std::max(radii[i - 1], radii[i]) + 1;
    if (glm::any(glm::lessThan(p, glm::min(a, b) - reach)) ||
        glm::any(glm::greaterThan(p, glm::max(a, b) + reach)))
      continue;
    const auto at = [&](double t) {
      return margin(a + (b - a) * t, radii[i - 1] + (radii[i] - radii[i - 1]) * t);
    };
    // The margin is concave along the segment, so a ternary search finds its maximum.
    double low = 0, high = 1;
    for (int step = 0; step < 60; ++step) {
      const double third = (high - low) / 3;
      if (at(low + third) < at(high - third))
        low += third;
      else
        high -= third;
    }
    best = std::max(best, at((low + high) / 2));
  }
  return best;
}

// Returns the largest allowed angle minus the angle of the surface in a pixel, as the lowest and
// the highest value. The angle is between the ray from the eye and the normal of the plane
// through the points of the pixel and of two neighbors, in world coordinates. The two values differ
// if rounding decides which neighbors are used.
std::pair<double, double> angle_margins(const StrokeBatch& stroke,
                                        const std::function<double(int, int)>& at, int x, int y) {
  const Camera& camera = stroke.camera;
  const glm::dmat4 world_from_clip = glm::inverse(camera.projection * camera.view);
  const auto point = [&](int px, int py) {
    const glm::dvec4 p =
        world_from_clip * glm::dvec4((px + 0.5) * 2 / camera.width - 1,
                                     (py + 0.5) * 2 / camera.height - 1, at(px, py) * 2 - 1, 1);
    return glm::dvec3(p) / p.w;
  };
  // Returns the side of the neighbor with the nearer depth, or both sides if rounding decides.
  const auto neighbours = [&](int dx, int dy, int where, int last) {
    const double before = std::abs(at(x, y) - at(x - dx, y - dy)),
                 after = std::abs(at(x + dx, y + dy) - at(x, y));
    std::vector<int> sides;
    if (where > 0 && (where == last || before <= after + 1.2e-7)) sides.push_back(-1);
    if (where < last && (where == 0 || after <= before + 1.2e-7)) sides.push_back(1);
    return sides;
  };
  const glm::dvec3 here = point(x, y);
  const glm::dvec3 ray = ray_through_pixel(camera, x + 0.5, camera.height - 1 - y + 0.5).direction;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const int side_x : neighbours(1, 0, x, camera.width - 1)) {
    for (const int side_y : neighbours(0, 1, y, camera.height - 1)) {
      const glm::dvec3 normal =
          glm::cross(point(x + side_x, y) - here, point(x, y + side_y) - here);
      const double angle =
          std::acos(std::min(1.0, std::abs(glm::dot(normal, ray)) / glm::length(normal)));
      low = std::min(low, glm::radians(*stroke.max_angle_deg) - angle);
      high = std::max(high, glm::radians(*stroke.max_angle_deg) - angle);
    }
  }
  return {low, high};
}

// Returns whether the stroke writes one texel: it does if all margins are positive. Sets
// `undecided` if the smallest margin is near 0.
bool decide(const Scene& scene, const StrokeBatch& stroke, const std::vector<double>& radii,
            const std::vector<float>& depth, const glm::dmat4& clip_from_model,
            const render::DepthBias& bias, const glm::vec3& position, bool& undecided) {
  const Camera& camera = stroke.camera;
  const double rounding =
      kRoundingOfSize * glm::length(glm::dvec3(scene.geometry->box_max - scene.geometry->box_min));
  double section_margin = std::numeric_limits<double>::infinity();
  for (const glm::dvec4& plane : camera.section) {
    const double above =
        glm::dot(plane, glm::dvec4(glm::dvec3(position) + scene.geometry->origin, 1));
    section_margin = std::min(section_margin, above / glm::length(glm::dvec3(plane)));
  }
  if (section_margin < -rounding) return false;
  const glm::dvec4 clip = clip_from_model * glm::dvec4(position, 1);
  if (clip.w <= 0 || std::abs(clip.z) > clip.w) return false;
  const glm::dvec3 ndc = glm::dvec3(clip) / clip.w;
  const glm::dvec2 window = (glm::dvec2(ndc) * 0.5 + 0.5) * glm::dvec2(camera.width, camera.height);
  const double window_margin =
      std::min({window.x, window.y, camera.width - window.x, camera.height - window.y});
  double margin_px = std::min(window_margin, inside(stroke, radii, window));
  if (margin_px < -kRounding_px) return false;
  const bool is_uncut = section_margin >= 0;
  undecided = std::abs(margin_px) < kRounding_px || std::abs(section_margin) < rounding;
  if (stroke.through || window_margin <= 0) return is_uncut && margin_px > 0;

  const int x = static_cast<int>(window.x), y = static_cast<int>(window.y);
  const auto at = [&](int px, int py) {
    return double{depth[static_cast<std::size_t>(std::clamp(py, 0, camera.height - 1)) *
                            static_cast<std::size_t>(camera.width) +
                        static_cast<std::size_t>(std::clamp(px, 0, camera.width - 1))]};
  };
  const double here = at(x, y);
  const bool inside =
      !camera.section.empty() && (std::bit_cast<std::uint32_t>(static_cast<float>(here)) & 1u) != 0;
  const double slope = std::min(std::abs(here - at(x - 1, y)), std::abs(at(x + 1, y) - here)) +
                       std::min(std::abs(here - at(x, y - 1)), std::abs(at(x, y + 1) - here));
  const double base = bias.scale / (clip.w * clip.w);
  const double allowed = stroke.fixed_depth_bias.value_or(
      base + std::min(bias.slope_factor * slope, bias.slope_limit * base));
  const double depth_margin = here - (ndc.z * 0.5 + 0.5 - allowed);
  // Near the border of a pixel, the depth test may have read the neighboring pixel.
  const double border = std::min({window.x - x, window.y - y, x + 1 - window.x, y + 1 - window.y});
  undecided = undecided || std::abs(depth_margin) < kRoundingDepth || border < kRounding_px;
  bool faces = true;
  if (stroke.max_angle_deg) {
    const auto [low, high] = angle_margins(stroke, at, x, y);
    faces = here < 1 && low >= 0;
    undecided = undecided || (low < kRoundingAngle_rad && high > -kRoundingAngle_rad);
  }
  return is_uncut && !inside && margin_px > 0 && depth_margin >= 0 && faces;
}

// Returns one radius for each path point, in window pixels.
std::vector<double> radii_of(const StrokeBatch& stroke, const std::vector<float>& depth) {
  const auto narrowed = [&](std::vector<double> radii) {
    for (std::size_t i = 0; i < stroke.widths.size(); ++i) radii[i] *= stroke.widths[i];
    return radii;
  };
  if (stroke.radius_px > 0)
    return narrowed(std::vector<double>(stroke.path.size(), stroke.radius_px));
  std::vector<float> depths;
  for (const auto& point : stroke.path)
    depths.push_back(depth[std::size_t(stroke.camera.height - 1 - int(point.y)) *
                               std::size_t(stroke.camera.width) +
                           std::size_t(point.x)]);
  return narrowed(render::radii_from_depths(stroke, depths, 1));
}

}  // namespace

OracleResult oracle_edit(const Scene& scene, const StrokeBatch& stroke,
                         const std::vector<double>& radii_px, const std::vector<float>& depth) {
  const auto& map = *scene.map;
  const glm::dmat4 clip = stroke.camera.projection * stroke.camera.view *
                          glm::translate(glm::dmat4(1.0), scene.geometry->origin);
  const double diagonal =
      glm::length(glm::dvec3(scene.geometry->box_max) - glm::dvec3(scene.geometry->box_min));
  const auto bias = render::depth_bias_of(stroke, diagonal);
  OracleResult result;
  for (std::uint32_t slot = 0; slot < map.block_of_slot.size(); ++slot) {
    const std::uint32_t block = map.block_of_slot[slot];
    const int block_x = static_cast<int>(block) % map.blocks_per_side,
              block_y = static_cast<int>(block) / map.blocks_per_side;
    const TileAddress tile{static_cast<std::uint16_t>(block_x / 16),
                           static_cast<std::uint16_t>(block_y / 16)};
    for (int i = 0; i < 64; ++i) {
      if (map.packed_position[slot * 64 + static_cast<std::uint32_t>(i)] == mesh::kNoPosition)
        continue;
      if (!map.part.empty() &&
          stroke.camera.hidden_parts.test(map.part[slot * 64 + static_cast<std::uint32_t>(i)]))
        continue;
      bool undecided = false;
      const bool written =
          decide(scene, stroke, radii_px, depth, clip, bias, map.position(slot, i), undecided);
      const int texel = ((block_y % 16) * 8 + i / 8) * kTileSize + (block_x % 16) * 8 + i % 8;
      if (written) result.written[tile].set(texel);
      if (undecided) result.undecided[tile].set(texel);
      result.count += written ? 1 : 0;
    }
  }
  return result;
}

Difference compare(const OracleResult& expected, const render::StrokeOutcome& outcome) {
  std::map<TileAddress, TileMask> got;
  for (const auto& tile : outcome.tiles) got[tile.address] = tile.written;
  std::map<TileAddress, TileMask> all = expected.written;
  all.insert(got.begin(), got.end());
  const auto mask_of = [](const std::map<TileAddress, TileMask>& masks, TileAddress tile) {
    const auto found = masks.find(tile);
    return found == masks.end() ? TileMask{} : found->second;
  };
  Difference difference;
  for (const auto& [tile, unused] : all) {
    const TileMask a = mask_of(expected.written, tile), b = mask_of(got, tile),
                   loose = mask_of(expected.undecided, tile);
    for (int i = 0; i < kTexelsPerTile; ++i) {
      difference.compared += a.test(i) || b.test(i) ? 1 : 0;
      if (a.test(i) == b.test(i)) continue;
      ++(loose.test(i) ? difference.undecided : difference.surface);
    }
  }
  return difference;
}

void expect_as_oracle(TestRenderer& renderer, const Scene& scene, const StrokeBatch& stroke,
                      OracleBounds bounds, std::optional<render::ModelHandle> model) {
  if (!model) model = renderer.add(scene);
  const auto outcome =
      renderer.paint(renderer.add_layer(*model, ValueType::u8, scene.map->resolution), stroke);
  const auto depth = renderer.depth(scene, stroke.camera);
  const auto expected = oracle_edit(scene, stroke, radii_of(stroke, depth), depth);
  const auto difference = compare(expected, outcome);
  EXPECT_GE(expected.count, bounds.at_least)
      << "the stroke must hit something for the test to mean anything";
  EXPECT_EQ(difference.surface, 0) << "of " << difference.compared;
  EXPECT_LE(difference.undecided, 2 + difference.compared / bounds.undecided_one_in);
}

int written_texels(const render::StrokeOutcome& outcome) {
  int count = 0;
  for (const auto& tile : outcome.tiles) count += tile.written.count();
  return count;
}

}  // namespace strata::test
