#include "render/edit/block_culler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "mesh/parallel.h"
#include "shared/depth_probe.h"

namespace strata::render {
namespace {

// The margins are much larger than the errors of float arithmetic in the shader and of packed
// positions.
constexpr double kMargin_px = 0.05;
constexpr double kMarginDepth = 1e-6;
constexpr double kMarginRadius = 1e-5;  // relative to a sphere's radius

// Returns the bounds of (row_i · p) / (row_w · p) over a sphere: the values k for which the plane
// row_i - k row_w touches the sphere.
std::pair<double, double> ratio_bounds(double a, double b, double radius, double aa, double ab,
                                       double bb) {
  const double r2 = radius * radius;
  const double qa = b * b - r2 * bb, qb = a * b - r2 * ab, qc = a * a - r2 * aa;
  const double root = std::sqrt(std::max(0.0, qb * qb - qa * qc));
  return {(qb - root) / qa, (qb + root) / qa};
}

double half_diagonal(const PixelBox& box) {
  return glm::length(glm::dvec2(box.x1 - box.x0, box.y1 - box.y0)) / 2;
}

double distance_to_axis(const shader::EditSegment& s, const glm::dvec2& point) {
  const glm::dvec2 a{s.ends.x, s.ends.y}, along = glm::dvec2(s.ends.z, s.ends.w) - a;
  const double squared = glm::dot(along, along);
  const double t = squared > 0 ? std::clamp(glm::dot(point - a, along) / squared, 0.0, 1.0) : 0.0;
  return glm::length(point - (a + along * t));
}

// If kSubtreesForThreads or more subtrees of level kSharedLevel pass the tests, threads share them.
constexpr std::size_t kSharedLevel = 3;
constexpr std::size_t kSubtreesForThreads = 32;

// Most blocks under a large tool are accepted in groups of eight, because a test of each block
// takes as long as painting it.
constexpr std::size_t kWholeLevel = 1;

// Returns the sides of the tool's box in the window, as planes through the eye. A test of a sphere
// against one plane takes a tenth of the time of computing the sphere's exact box.
std::array<glm::dvec4, 4> sides_of(const PixelBox& tool, const glm::dmat4& clip, int width,
                                   int height) {
  const glm::dmat4 rows = glm::transpose(clip);
  // Window x · w is linear in the position, and w is above 0 at all paintable points.
  const glm::dvec4 x = 0.5 * width * (rows[0] + rows[3]), y = 0.5 * height * (rows[1] + rows[3]),
                   w = rows[3];
  std::array planes = {x - (std::max(tool.x0, 0.0) - kMargin_px) * w,
                       (std::min(tool.x1, double(width)) + kMargin_px) * w - x,
                       y - (std::max(tool.y0, 0.0) - kMargin_px) * w,
                       (std::min(tool.y1, double(height)) + kMargin_px) * w - y};
  for (auto& plane : planes) {
    const double length = glm::length(glm::dvec3(plane));
    plane = length > 0 ? plane / length : glm::dvec4(0, 0, 0, 1);
  }
  return planes;
}

}  // namespace

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
  return WindowBox{{(x0 * 0.5 + 0.5) * width, (y0 * 0.5 + 0.5) * height, (x1 * 0.5 + 0.5) * width,
                    (y1 * 0.5 + 0.5) * height},
                   z0 * 0.5 + 0.5,
                   w - w_reach};
}

BlockCuller::BlockCuller(const mesh::SurfaceMap& map, const glm::dmat4& clip_from_model, int width,
                         int height, const ToolPath& path, const DepthBias& bias,
                         const DepthGrid& grid)
    : map_(map),
      clip_(clip_from_model),
      width_(width),
      height_(height),
      path_(path),
      bias_(bias),
      grid_(grid),
      tool_planes_(sides_of(path.box, clip_from_model, width, height)) {}

// Descends from a subtree that passed the tests. Calls take(level, index, under) for each subtree
// that passes and is at `stop_level` or completely inside the tool.
template <class Take>
void BlockCuller::descend(std::size_t level, std::size_t index, const Under& under,
                          std::size_t stop_level, Scratch& scratch, Take&& take) const {
  if (level == stop_level || (level <= kWholeLevel && under.all_of_it)) {
    take(level, index, under);
    return;
  }
  const auto& children = map_.tree.levels[level - 1];
  const std::size_t first = index * mesh::BlockTree::kChildren;
  Under& under_child = scratch[level - 1];
  for (std::size_t child = first;
       child < std::min(first + mesh::BlockTree::kChildren, children.size()); ++child)
    if (passes(children[child], under, under_child))
      descend(level - 1, child, under_child, stop_level, scratch, take);
}

std::vector<BlockCuller::Subtree> BlockCuller::find_subtrees() const {
  const auto& levels = map_.tree.levels;
  if (levels.empty()) return {};
  Under all, under;
  all.segments.resize(path_.segments.size());
  std::iota(all.segments.begin(), all.segments.end(), 0u);
  const std::size_t top = levels.size() - 1;
  if (!passes(levels[top].front(), all, under)) return {};
  Scratch scratch;
  std::vector<Subtree> found;
  descend(top, 0, under, std::min(top, kSharedLevel), scratch,
          [&](std::size_t level, std::size_t index, const Under& of_it) {
            found.push_back({level, index, of_it});
          });
  return found;
}

BlockCuller::Found BlockCuller::find_parts(const Subtree& subtree) const {
  Found found;
  const auto take = [&](std::size_t level, std::size_t index, const Under& under) {
    const auto list = found.segment_lists.add(under.segments);
    const auto count = static_cast<std::uint32_t>(under.segments.size());
    std::size_t first = index, last = index + 1;
    for (; level > 0; --level)
      first *= mesh::BlockTree::kChildren, last *= mesh::BlockTree::kChildren;
    for (last = std::min(last, map_.tree.parts.size()); first < last; ++first)
      found.parts.push_back({static_cast<std::uint32_t>(first), list, count, under.all_of_it});
  };
  Scratch scratch;
  descend(subtree.level, subtree.index, subtree.under, 0, scratch, take);
  return found;
}

TouchedParts BlockCuller::find(int threads) const {
  const auto subtrees = find_subtrees();
  std::vector<Found> found(subtrees.size());
  mesh::parallel_for(subtrees.size() < kSubtreesForThreads ? 1 : threads,
                     static_cast<int>(subtrees.size()),
                     [&](int i) { found[i] = find_parts(subtrees[i]); });

  TouchedParts touched;
  const std::size_t per_side = static_cast<std::size_t>(map_.resolution / kTileSize);
  std::vector<std::uint32_t> end(per_side * per_side, 0);
  for (const Found& of_subtree : found)
    for (const auto& part : of_subtree.parts) ++end[map_.tree.parts[part.part].tile];
  std::size_t count = 0;
  for (std::size_t tile = 0; tile < end.size(); ++tile) {
    if (end[tile] == 0) continue;
    const auto x = static_cast<std::uint16_t>(tile % per_side),
               y = static_cast<std::uint16_t>(tile / per_side);
    touched.tiles.push_back({{x, y}, count, end[tile]});
    count += std::exchange(end[tile], static_cast<std::uint32_t>(count));
  }
  touched.parts.resize(count);
  for (const Found& of_subtree : found) {
    const std::uint32_t offset = touched.segment_lists.append(of_subtree.segment_lists);
    for (auto part : of_subtree.parts) {
      part.segments += offset;
      touched.parts[end[map_.tree.parts[part.part].tile]++] = part;
    }
  }
  return touched;
}

void BlockCuller::add_blocks(const TouchedParts& touched, const TouchedParts::Tile& tile,
                             Candidates& candidates) const {
  constexpr std::uint32_t kBlocksPerTile = kTileSize / kBlockSize, kNone = 0xffffffffu;
  const auto parts = std::span(touched.parts).subspan(tile.first, tile.count);
  // The parts of each block form a linked list.
  std::array<std::uint32_t, std::size_t{kBlocksPerTile} * kBlocksPerTile> first;
  first.fill(kNone);
  std::vector<std::uint32_t> next(parts.size());
  for (std::size_t i = parts.size(); i-- > 0;) {
    auto& head = first[map_.tree.parts[parts[i].part].place];
    next[i] = std::exchange(head, static_cast<std::uint32_t>(i));
  }
  std::vector<std::uint32_t> segments;
  for (std::uint32_t place = 0; place < first.size(); ++place) {
    if (first[place] == kNone) continue;
    const TouchedParts::Part& part = parts[first[place]];
    const auto list_of = [&](const TouchedParts::Part& of) {
      return touched.segment_lists.at(of.segments, of.segment_count);
    };
    const mesh::BlockTree::Part& in_tree = map_.tree.parts[part.part];
    CandidateBlock block{in_tree.slot,       tile.address, place,       0,
                         part.segment_count, part.part,    part.in_tool};
    if (in_tree.shares_block) block.in_tool = false;  // other parts of the block may be outside
    if (next[first[place]] == kNone) {
      block.segments = candidates.segment_lists.add(list_of(part));
    } else {
      segments.clear();
      for (std::uint32_t i = first[place]; i != kNone; i = next[i]) {
        const auto list = list_of(parts[i]);
        segments.insert(segments.end(), list.begin(), list.end());
      }
      std::ranges::sort(segments);
      segments.erase(std::ranges::unique(segments).begin(), segments.end());
      block.segments = candidates.segment_lists.add(segments);
      block.segment_count = static_cast<std::uint32_t>(segments.size());
      block.part = CandidateBlock::kManyParts;
    }
    candidates.blocks.push_back(block);
  }
}

bool BlockCuller::passes(const mesh::BoundingSphere& bounds, const Under& parent,
                         Under& under) const {
  if (leaves_out(bounds)) return false;
  const auto box = project(bounds);
  if (!box) return false;
  if (parent.all_of_it) {
    if (is_hidden(*box)) return false;
    under = parent;
    return true;
  }
  under.segments.clear();
  for (const auto segment : parent.segments) {
    if (lies_under(*box, segment)) under.segments.push_back(segment);
  }
  if (under.segments.empty() || is_hidden(*box)) return false;
  under.all_of_it = keep_covering(*box, under.segments);
  return true;
}

bool BlockCuller::leaves_out(const mesh::BoundingSphere& bounds) const {
  const glm::dvec4 center(glm::dvec3(bounds.center), 1);
  const double reach = -bounds.radius * (1 + kMarginRadius);
  return glm::dot(tool_planes_[0], center) < reach || glm::dot(tool_planes_[1], center) < reach ||
         glm::dot(tool_planes_[2], center) < reach || glm::dot(tool_planes_[3], center) < reach;
}

std::optional<WindowBox> BlockCuller::project(const mesh::BoundingSphere& bounds) const {
  const double radius = bounds.radius * (1 + kMarginRadius);
  auto found = project_sphere(clip_, width_, height_, glm::dvec3(bounds.center), radius);
  if (!found) return found;
  auto& box = found->box;
  box = {box.x0 - kMargin_px, box.y0 - kMargin_px, box.x1 + kMargin_px, box.y1 + kMargin_px};
  if (box.x1 < 0 || box.y1 < 0 || box.x0 > width_ || box.y0 > height_ || !box.overlaps(path_.box))
    return std::nullopt;
  return found;
}

// Tests the circle around the box against the segment's axis, because the box of a long slanted
// segment is much larger than the segment.
bool BlockCuller::lies_under(const WindowBox& window, std::uint32_t segment) const {
  const PixelBox& box = window.box;
  if (!path_.boxes[segment].overlaps(box)) return false;
  const auto& s = path_.segments[segment];
  const glm::dvec2 center{(box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2};
  const double around = half_diagonal(box);
  // √2: the distance to the corners of a square tool
  const double reach = std::max(s.tool.x, s.tool.y) * std::sqrt(2.0) + around;
  return distance_to_axis(s, center) <= reach;
}

// If one segment covers the whole box, removes the other segments from the list, because they have
// no effect, and returns true.
bool BlockCuller::keep_covering(const WindowBox& window, std::vector<std::uint32_t>& list) const {
  const PixelBox& box = window.box;
  const glm::dvec2 center{(box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2};
  const double around = half_diagonal(box) + kMargin_px;
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
  const double bias =
      bias_.fixed ? *bias_.fixed : bias_.scale / (window.w0 * window.w0) * (1 + bias_.slope_limit);
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
