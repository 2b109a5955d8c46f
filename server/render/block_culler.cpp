#include "render/block_culler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "shared/depth_probe.h"

namespace strata::render {
namespace {

// Float arithmetic of the shader and the rounding of packed positions move a texel by far less than this.
constexpr double kMargin_px = 0.05;
constexpr double kMarginDepth = 1e-6;
constexpr double kMarginRadius = 1e-5;  // of a sphere, relative

// Bounds of (row_i · p) / (row_w · p) over a sphere: the planes row_i - k row_w that touch it.
std::pair<double, double> ratio_bounds(double a, double b, double radius, double aa, double ab, double bb) {
  const double r2 = radius * radius;
  const double qa = b * b - r2 * bb, qb = a * b - r2 * ab, qc = a * a - r2 * aa;
  const double root = std::sqrt(std::max(0.0, qb * qb - qa * qc));
  return {(qb - root) / qa, (qb + root) / qa};
}

double distance_to_axis(const shader::EditSegment& s, const glm::dvec2& point) {
  const glm::dvec2 a{s.ends.x, s.ends.y}, along = glm::dvec2(s.ends.z, s.ends.w) - a;
  const double squared = glm::dot(along, along);
  const double t = squared > 0 ? std::clamp(glm::dot(point - a, along) / squared, 0.0, 1.0) : 0.0;
  return glm::length(point - (a + along * t));
}

// The sides of the tool's box in the window as planes through the eye. Spheres beyond one are left out by a tenth of what their
// exact box costs: most of those that a small tool is tested against.
class BoxPlanes {
 public:
  BoxPlanes(const glm::dmat4& clip, int width, int height, const PixelBox& tool) {
    const glm::dmat4 rows = glm::transpose(clip);
    // Window x · w is linear in the position, and w is above 0 where anything is painted.
    const glm::dvec4 x = 0.5 * width * (rows[0] + rows[3]), y = 0.5 * height * (rows[1] + rows[3]), w = rows[3];
    planes_ = {x - (std::max(tool.x0, 0.0) - kMargin_px) * w, (std::min(tool.x1, double(width)) + kMargin_px) * w - x,
               y - (std::max(tool.y0, 0.0) - kMargin_px) * w, (std::min(tool.y1, double(height)) + kMargin_px) * w - y};
    for (auto& plane : planes_) {
      const double length = glm::length(glm::dvec3(plane));
      plane = length > 0 ? plane / length : glm::dvec4(0, 0, 0, 1);
    }
  }
  bool leave_out(const mesh::SurfaceMap::Bounds& bounds) const {
    const glm::dvec4 center(glm::dvec3(bounds.center), 1);
    const double reach = -bounds.radius * (1 + kMarginRadius);
    return glm::dot(planes_[0], center) < reach || glm::dot(planes_[1], center) < reach ||
           glm::dot(planes_[2], center) < reach || glm::dot(planes_[3], center) < reach;
  }

 private:
  std::array<glm::dvec4, 4> planes_;
};

// Neighbouring blocks mostly share their list.
std::uint32_t list_of(const std::vector<std::uint32_t>& segments, Candidates& candidates) {
  auto& lists = candidates.segment_lists;
  auto& last_list = candidates.last_list;
  const std::span<const std::uint32_t> last(lists.data() + last_list, lists.size() - last_list);
  if (lists.empty() || !std::equal(last.begin(), last.end(), segments.begin(), segments.end())) {
    last_list = lists.size();
    lists.insert(lists.end(), segments.begin(), segments.end());
  }
  return static_cast<std::uint32_t>(last_list);
}

}  // namespace

std::size_t Candidates::count_tiles() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) count += i == 0 || blocks[i].tile != blocks[i - 1].tile;
  return count;
}

std::optional<WindowBox> project_sphere(const glm::dmat4& clip_from_model, int width, int height,
                                        const glm::dvec3& center, double radius) {
  const glm::dmat4 rows = glm::transpose(clip_from_model);
  const glm::dvec4 point(center, 1);
  const glm::dvec3 w_row(rows[3]);
  const double w = glm::dot(rows[3], point);
  const double w_reach = radius * glm::length(w_row);
  if (w + w_reach <= 0) return std::nullopt;
  if (w - w_reach <= std::numeric_limits<double>::epsilon()) {
    return WindowBox{{0, 0, double(width), double(height)}, 0, 0};
  }
  const auto bounds = [&](int row) {
    const glm::dvec3 r(rows[row]);
    return ratio_bounds(glm::dot(rows[row], point), w, radius, glm::dot(r, r), glm::dot(r, w_row),
                        glm::dot(w_row, w_row));
  };
  const auto [x0, x1] = bounds(0);
  const auto [y0, y1] = bounds(1);
  const auto [z0, z1] = bounds(2);
  if (z1 < -1 || z0 > 1) return std::nullopt;
  return WindowBox{
      {(x0 * 0.5 + 0.5) * width, (y0 * 0.5 + 0.5) * height, (x1 * 0.5 + 0.5) * width, (y1 * 0.5 + 0.5) * height},
      z0 * 0.5 + 0.5,
      w - w_reach};
}

std::vector<BlockCuller::Tile> BlockCuller::tiles() const {
  const int per_side = map_.resolution / kTileSize;
  const BoxPlanes planes(clip_, width_, height_, path_.box);
  std::vector<Tile> found;
  for (int y = 0; y < per_side; ++y) {
    for (int x = 0; x < per_side; ++x) {
      const auto& bounds = map_.bounds_128[static_cast<std::size_t>(y * per_side + x)];
      if (bounds.radius < 0 || planes.leave_out(bounds)) continue;
      const auto box = project(bounds);
      if (!box) continue;
      auto segments = segments_under(*box);
      if (segments.empty() || is_hidden(*box)) continue;
      found.push_back({{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y)}, std::move(segments)});
    }
  }
  return found;
}

Candidates BlockCuller::all() const {
  Candidates candidates;
  for (const Tile& tile : tiles()) add_blocks(tile, candidates);
  return candidates;
}

void BlockCuller::add_blocks(const Tile& tile, Candidates& candidates) const {
  const int per_side_32 = map_.resolution / 32;
  const BoxPlanes planes(clip_, width_, height_, path_.box);
  Under under_32, under_block;
  for (int i = 0; i < 16; ++i) {
    const int x = tile.address.x * 4 + i % 4, y = tile.address.y * 4 + i / 4;
    const auto& bounds_32 = map_.bounds_32[static_cast<std::size_t>(y * per_side_32 + x)];
    if (planes.leave_out(bounds_32) || !passes(bounds_32, tile.segments, under_32)) continue;
    for (int k = 0; k < 16; ++k) {
      const int block_x = x * 4 + k % 4, block_y = y * 4 + k / 4;
      const auto slot = map_.slot_of_block[static_cast<std::size_t>(block_y * map_.blocks_per_side + block_x)];
      if (slot == mesh::kNoSlot) continue;
      // Under a large tool most blocks are taken by the sixteen: to test each costs as much as to paint it.
      if (!under_32.all_of_it &&
          (planes.leave_out(map_.bounds_8[slot]) || !passes(map_.bounds_8[slot], under_32.segments, under_block)))
        continue;
      const Under& under = under_32.all_of_it ? under_32 : under_block;
      const auto place = static_cast<std::uint32_t>((block_x & 15) | (block_y & 15) << 4);
      candidates.blocks.push_back({slot, tile.address, place, list_of(under.segments, candidates),
                                   static_cast<std::uint32_t>(under.segments.size()), under.all_of_it});
    }
  }
}

bool BlockCuller::passes(const mesh::SurfaceMap::Bounds& bounds, const std::vector<std::uint32_t>& parent,
                         Under& under) const {
  if (bounds.radius < 0) return false;
  const auto box = project(bounds);
  if (!box) return false;
  under.segments.clear();
  for (const auto segment : parent) {
    if (lies_under(*box, segment)) under.segments.push_back(segment);
  }
  if (under.segments.empty() || is_hidden(*box)) return false;
  under.all_of_it = keep_covering(*box, under.segments);
  return true;
}

std::optional<WindowBox> BlockCuller::project(const mesh::SurfaceMap::Bounds& bounds) const {
  const double radius = bounds.radius * (1 + kMarginRadius);
  auto found = project_sphere(clip_, width_, height_, glm::dvec3(bounds.center), radius);
  if (!found) return found;
  auto& box = found->box;
  box = {box.x0 - kMargin_px, box.y0 - kMargin_px, box.x1 + kMargin_px, box.y1 + kMargin_px};
  if (box.x1 < 0 || box.y1 < 0 || box.x0 > width_ || box.y0 > height_ || !box.overlaps(path_.box)) return std::nullopt;
  return found;
}

std::vector<std::uint32_t> BlockCuller::segments_under(const WindowBox& box) const {
  std::vector<std::uint32_t> list;
  for (std::size_t group = 0; group < path_.group_boxes.size(); ++group) {
    if (!path_.group_boxes[group].overlaps(box.box)) continue;
    const std::size_t first = group * ToolPath::kSegmentsPerGroup;
    const std::size_t last = std::min(first + ToolPath::kSegmentsPerGroup, path_.segments.size());
    for (std::size_t i = first; i < last; ++i) {
      if (lies_under(box, static_cast<std::uint32_t>(i))) list.push_back(static_cast<std::uint32_t>(i));
    }
  }
  return list;
}

// The circle around the box against the segment's axis: long slanted segments have boxes much larger than they are.
bool BlockCuller::lies_under(const WindowBox& window, std::uint32_t segment) const {
  const PixelBox& box = window.box;
  if (!path_.boxes[segment].overlaps(box)) return false;
  const auto& s = path_.segments[segment];
  const glm::dvec2 center{(box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2};
  const double around = std::hypot(box.x1 - box.x0, box.y1 - box.y0) / 2;
  const double reach = std::max(s.tool.x, s.tool.y) * std::sqrt(2.0) + around;  // √2: squares reach that far
  return distance_to_axis(s, center) <= reach;
}

// Where one segment covers the whole box the others do not matter: true, and it alone is kept.
bool BlockCuller::keep_covering(const WindowBox& window, std::vector<std::uint32_t>& list) const {
  const PixelBox& box = window.box;
  const glm::dvec2 center{(box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2};
  const double around = std::hypot(box.x1 - box.x0, box.y1 - box.y0) / 2 + kMargin_px;
  for (const auto segment : list) {
    const auto& s = path_.segments[segment];
    if (distance_to_axis(s, center) + around < path_.inner_radius * std::min(s.tool.x, s.tool.y)) {
      list.assign(1, segment);
      return true;
    }
  }
  return false;
}

bool BlockCuller::is_hidden(const WindowBox& window) const {
  if (!grid_.cells || window.w0 <= 0) return false;
  const double bias = bias_.fixed ? *bias_.fixed : bias_.scale / (window.w0 * window.w0) * (1 + bias_.slope_limit);
  const double nearest = window.z0 - bias - kMarginDepth;
  const auto cell = [](double pixel, int count) {
    return static_cast<int>(std::clamp(std::floor(pixel / shader::kDepthCell), 0.0, count - 1.0));
  };
  const PixelBox& box = window.box;
  const int x0 = cell(std::max(box.x0, path_.box.x0), grid_.width),
            x1 = cell(std::min(box.x1, path_.box.x1), grid_.width);
  const int y0 = cell(std::max(box.y0, path_.box.y0), grid_.height),
            y1 = cell(std::min(box.y1, path_.box.y1), grid_.height);
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      if (grid_.cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(grid_.width) +
                      static_cast<std::size_t>(x)] >= nearest)
        return false;
    }
  }
  return true;
}

}  // namespace strata::render
