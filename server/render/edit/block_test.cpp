#include "render/edit/block_test.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "media/shape_texture.h"
#include "shared/section.h"

// CMakeLists.txt sets -O3 and disables floating-point traps and errno. Otherwise the compiler would
// not vectorize the loops below.
#define STRATA_LANES inline __attribute__((always_inline))

namespace strata::render {
namespace {

constexpr int kLanes = kBlockSize * kBlockSize;
static_assert(std::endian::native == std::endian::little, "positions are read as pairs of 32 bits");

// The position of each texel in the window, and whether it has passed all tests so far.
struct alignas(64) Lanes {
  float x[kLanes], y[kLanes], depth[kLanes], w[kLanes];
  std::int32_t live[kLanes];   // 0 or 1
  std::int32_t pixel[kLanes];  // index of the pixel in the depth copy; 0 if `live` is 0
};

STRATA_LANES void project(const BlockTest& test, const std::uint64_t* positions,
                          const mesh::SurfaceMap::PackedBox& box, Lanes& lanes) {
  alignas(64) std::uint32_t packed[2 * kLanes];
  std::memcpy(packed, positions, sizeof packed);
  const glm::mat4& m = test.clip_from_model;
  const float m00 = m[0][0], m01 = m[0][1], m02 = m[0][2], m03 = m[0][3], m10 = m[1][0],
              m11 = m[1][1], m12 = m[1][2], m13 = m[1][3], m20 = m[2][0], m21 = m[2][1],
              m22 = m[2][2], m23 = m[2][3], m30 = m[3][0], m31 = m[3][1], m32 = m[3][2],
              m33 = m[3][3];
  const float x0 = box.min.x, y0 = box.min.y, z0 = box.min.z, dx = box.step.x, dy = box.step.y,
              dz = box.step.z;
  const auto width = static_cast<float>(test.width), height = static_cast<float>(test.height);
  const int pitch = test.width;
  for (int i = 0; i < kLanes; ++i) {
    const std::uint32_t low = packed[2 * i], high = packed[2 * i + 1];
    const float px = x0 + static_cast<float>(static_cast<std::int32_t>(low & 0x1fffffu)) * dx;
    const float py =
        y0 + static_cast<float>(static_cast<std::int32_t>(low >> 21 | (high & 0x3ffu) << 11)) * dy;
    const float pz = z0 + static_cast<float>(static_cast<std::int32_t>(high >> 10)) * dz;
    const float cx = m00 * px + m10 * py + m20 * pz + m30,
                cy = m01 * px + m11 * py + m21 * pz + m31;
    const float cz = m02 * px + m12 * py + m22 * pz + m32,
                cw = m03 * px + m13 * py + m23 * pz + m33;
    const float x = (cx / cw * 0.5f + 0.5f) * width, y = (cy / cw * 0.5f + 0.5f) * height;
    const std::int32_t live = std::int32_t{(low & high) != 0xffffffffu} & std::int32_t{cw > 0.0f} &
                              std::int32_t{std::abs(cz) <= cw} & std::int32_t{x >= 0.0f} &
                              std::int32_t{y >= 0.0f} & std::int32_t{x < width} &
                              std::int32_t{y < height};
    lanes.x[i] = x;
    lanes.y[i] = y;
    lanes.depth[i] = cz / cw * 0.5f + 0.5f;
    lanes.w[i] = cw;
    lanes.live[i] = live;
    lanes.pixel[i] = live ? static_cast<std::int32_t>(y) * pitch + static_cast<std::int32_t>(x) : 0;
  }
}

// Rejects texels that the section cuts away, and texels at which the inside of a solid is visible
// (shaders/shared/section.h).
STRATA_LANES void test_section(const BlockTest& test, const std::uint64_t* positions,
                               const mesh::SurfaceMap::PackedBox& box, Lanes& lanes) {
  alignas(64) std::uint32_t packed[2 * kLanes];
  std::memcpy(packed, positions, sizeof packed);
  for (const glm::vec4& plane : test.section) {
    const float a = plane.x, b = plane.y, c = plane.z, d = plane.w;
    const float x0 = box.min.x, y0 = box.min.y, z0 = box.min.z, dx = box.step.x, dy = box.step.y,
                dz = box.step.z;
    for (int i = 0; i < kLanes; ++i) {
      const std::uint32_t low = packed[2 * i], high = packed[2 * i + 1];
      const float px = x0 + static_cast<float>(static_cast<std::int32_t>(low & 0x1fffffu)) * dx;
      const float py =
          y0 +
          static_cast<float>(static_cast<std::int32_t>(low >> 21 | (high & 0x3ffu) << 11)) * dy;
      const float pz = z0 + static_cast<float>(static_cast<std::int32_t>(high >> 10)) * dz;
      lanes.live[i] &= std::int32_t{a * px + b * py + c * pz + d >= 0.0f};
    }
  }
  if (!test.depth) return;
  const float* const depth = test.depth->depth.data();
  for (int i = 0; i < kLanes; ++i) {
    std::uint32_t bits;
    std::memcpy(&bits, depth + lanes.pixel[i], sizeof bits);
    lanes.live[i] &= std::int32_t{(bits & shader::kInsideMark) == 0};
  }
}

STRATA_LANES void add_dab(const shader::EditSegment& s, const Lanes& lanes, std::int32_t* inside) {
  const float ax = s.ends.x, ay = s.ends.y, radius = std::max(s.tool.x, s.tool.y),
              squared = radius * radius;
  for (int i = 0; i < kLanes; ++i) {
    const float dx = lanes.x[i] - ax, dy = lanes.y[i] - ay;
    inside[i] |= std::int32_t{dx * dx + dy * dy < squared};
  }
}

STRATA_LANES void add_swept_disc(const shader::EditSegment& s, const Lanes& lanes,
                                 std::int32_t* inside) {
  const float ax = s.ends.x, ay = s.ends.y, length = s.tool.w, shift = s.tool.z, r0 = s.tool.x,
              r1 = s.tool.y;
  const float ux = (s.ends.z - ax) / length, uy = (s.ends.w - ay) / length;
  for (int i = 0; i < kLanes; ++i) {
    const float px = lanes.x[i] - ax, py = lanes.y[i] - ay;
    const float beside = std::abs(py * ux - px * uy);
    float along = px * ux + py * uy + beside * shift;
    along = along < 0.0f ? 0.0f : along;
    along = along > length ? length : along;
    const float t = along / length, radius = r0 * (1.0f - t) + r1 * t;
    const float dx = px - ux * along, dy = py - uy * along;
    inside[i] |= std::int32_t{dx * dx + dy * dy < radius * radius};
  }
}

// A point is inside the swept square if, for some t in [0, 1], it is inside the square around a + t
// (b - a). These are four linear conditions c + t g > 0.
STRATA_LANES void add_swept_square(const shader::EditSegment& s, const Lanes& lanes,
                                   std::int32_t* inside) {
  const float sx = s.ends.z - s.ends.x, sy = s.ends.w - s.ends.y, grow = s.tool.y - s.tool.x;
  const float g[4] = {grow + sx, grow + sy, grow - sx, grow - sy};
  const float radius = s.tool.x;
  const std::int32_t is_dab = s.tool.w == 0.0f;
  for (int i = 0; i < kLanes; ++i) {
    const float px = lanes.x[i] - s.ends.x, py = lanes.y[i] - s.ends.y;
    const float c[4] = {radius - px, radius - py, radius + px, radius + py};
    float low = 0.0f, high = 1.0f;
    std::int32_t ok = 1;
    for (int k = 0; k < 4; ++k) {
      const float t = -c[k] / g[k];
      ok &= std::int32_t{g[k] != 0.0f} | std::int32_t{c[k] > 0.0f};
      const float raised = t > low ? t : low, lowered = t < high ? t : high;
      low = g[k] > 0.0f ? raised : low;
      high = g[k] < 0.0f ? lowered : high;
    }
    inside[i] |= ok & (std::int32_t{low < high} | (std::int32_t{low == high} & is_dab));
  }
}

// Returns whether a line between two points of the shape's raster meets a set cell. Each step
// leaves the empty square of cells around the current cell. Therefore only a few steps are needed,
// at most one for each cell along the line.
bool meets_shape(const std::uint8_t* distances, float ax, float ay, float bx, float by) {
  constexpr auto kSide = static_cast<float>(kShapeSide);
  constexpr float kNever = std::numeric_limits<float>::infinity();
  const float dx = bx - ax, dy = by - ay;
  float low = 0.0f, high = 1.0f;
  const auto clip = [&](float from, float step) {
    if (step == 0.0f) return from >= 0.0f && from < kSide;
    const float t0 = -from / step, t1 = (kSide - from) / step;
    low = std::max(low, std::min(t0, t1));
    high = std::min(high, std::max(t0, t1));
    return low <= high;
  };
  if (!clip(ax, dx) || !clip(ay, dy)) return false;
  const auto cell_of = [](float at) { return std::clamp(static_cast<int>(at), 0, kShapeSide - 1); };
  int x = cell_of(ax + low * dx), y = cell_of(ay + low * dy);
  for (int step = 0; step < 2 * kShapeSide; ++step) {
    const int distance = distances[y * kShapeSide + x];
    if (distance == 0) return true;
    const int x0 = x - distance + 1, x1 = x + distance, y0 = y - distance + 1, y1 = y + distance;
    const float tx = dx == 0.0f ? kNever : (static_cast<float>(dx > 0.0f ? x1 : x0) - ax) / dx;
    const float ty = dy == 0.0f ? kNever : (static_cast<float>(dy > 0.0f ? y1 : y0) - ay) / dy;
    if (std::min(tx, ty) > high) return false;
    if (tx <= ty) {
      x = dx > 0.0f ? x1 : x0 - 1;
      y = std::clamp(static_cast<int>(std::floor(ay + tx * dy)), y0, y1 - 1);
    } else {
      y = dy > 0.0f ? y1 : y0 - 1;
      x = std::clamp(static_cast<int>(std::floor(ax + ty * dx)), x0, x1 - 1);
    }
    if (x < 0 || y < 0 || x >= kShapeSide || y >= kShapeSide) return false;
  }
  return false;
}

// Maps a window point into the shape's raster at both ends of the segment. The raster's first row
// is the top row.
void add_swept_texture(const shader::EditSegment& s, const std::uint8_t* distances,
                       const Lanes& lanes, std::int32_t* inside) {
  constexpr float kHalf = kShapeSide / 2.0f;
  const float from_scale = kHalf / s.tool.x, to_scale = kHalf / s.tool.y;
  for (int i = 0; i < kLanes; ++i) {
    if (inside[i] != 0 || lanes.live[i] == 0) continue;
    inside[i] = meets_shape(distances, kHalf + (lanes.x[i] - s.ends.x) * from_scale,
                            kHalf - (lanes.y[i] - s.ends.y) * from_scale,
                            kHalf + (lanes.x[i] - s.ends.z) * to_scale,
                            kHalf - (lanes.y[i] - s.ends.w) * to_scale);
  }
}

STRATA_LANES void test_tool(const BlockTest& test, std::span<const std::uint32_t> segments,
                            Lanes& lanes) {
  alignas(64) std::int32_t inside[kLanes] = {};
  for (const std::uint32_t number : segments) {
    const shader::EditSegment& s = test.path->segments[number];
    if (test.shape == ToolShape::texture)
      add_swept_texture(s, test.texture->distances().data(), lanes, inside);
    else if (test.shape == ToolShape::square)
      add_swept_square(s, lanes, inside);
    else if (s.tool.w > 0.0f)
      add_swept_disc(s, lanes, inside);
    else
      add_dab(s, lanes, inside);
  }
  for (int i = 0; i < kLanes; ++i) lanes.live[i] &= inside[i];
}

STRATA_LANES void test_depth(const BlockTest& test, Lanes& lanes) {
  const float* const depth = test.depth->depth.data();
  if (test.bias.fixed) {
    const auto fixed = static_cast<float>(*test.bias.fixed);
    for (int i = 0; i < kLanes; ++i)
      lanes.live[i] &= std::int32_t{lanes.depth[i] - fixed <= depth[lanes.pixel[i]]};
    return;
  }
  const float* const slopes = test.depth->slope.data();
  const auto scale = static_cast<float>(test.bias.scale),
             factor = static_cast<float>(test.bias.slope_factor),
             limit = static_cast<float>(test.bias.slope_limit);
  for (int i = 0; i < kLanes; ++i) {
    const float base = scale / (lanes.w[i] * lanes.w[i]);
    const float by_slope = factor * slopes[lanes.pixel[i]], most = limit * base;
    const float bias = base + (by_slope < most ? by_slope : most);
    lanes.live[i] &= std::int32_t{lanes.depth[i] - bias <= depth[lanes.pixel[i]]};
  }
}

// Tests the limit of FacingLimit. At the window's border, uses the neighbor that exists. Rejects
// pixels without surface.
STRATA_LANES void test_facing(const BlockTest& test, Lanes& lanes) {
  const FacingLimit& facing = *test.facing;
  const float* const depth = test.depth->depth.data();
  const int pitch = test.width, last_x = test.width - 1, last_y = test.height - 1;
  const auto width = static_cast<float>(test.width), height = static_cast<float>(test.height);
  const glm::vec3 x_row = facing.x_row, y_row = facing.y_row, w_row = facing.w_row,
                  far_row = facing.far_row;
  const float least = facing.least_squared_cosine;
  for (int i = 0; i < kLanes; ++i) {
    // A rejected texel reads the first pixel, because its own pixel may be outside the window.
    const std::int32_t live = lanes.live[i], pixel = live ? lanes.pixel[i] : 0;
    const std::int32_t px = live ? static_cast<std::int32_t>(lanes.x[i]) : 0,
                       py = live ? static_cast<std::int32_t>(lanes.y[i]) : 0;
    const float here = depth[pixel];
    const float left = here - depth[pixel - (px > 0 ? 1 : 0)],
                right = depth[pixel + (px < last_x ? 1 : 0)] - here;
    const float below = here - depth[pixel - (py > 0 ? pitch : 0)],
                above = depth[pixel + (py < last_y ? pitch : 0)] - here;
    const bool is_left = (std::abs(left) <= std::abs(right) && px > 0) || px == last_x;
    const bool is_below = (std::abs(below) <= std::abs(above) && py > 0) || py == last_y;
    const float along_x = (is_left ? left : right) * width,
                along_y = (is_below ? below : above) * height;
    const float u = (static_cast<float>(px) + 0.5f) * 2.0f / width - 1.0f;
    const float v = (static_cast<float>(py) + 0.5f) * 2.0f / height - 1.0f;
    const float near = 2.0f * (1.0f - here);
    const float ax = x_row.x - u * w_row.x, ay = x_row.y - u * w_row.y, az = x_row.z - u * w_row.z;
    const float bx = y_row.x - v * w_row.x, by = y_row.y - v * w_row.y, bz = y_row.z - v * w_row.z;
    const float rx = ay * bz - az * by, ry = az * bx - ax * bz, rz = ax * by - ay * bx;
    const float nx = along_x * ax + along_y * bx + far_row.x - near * w_row.x;
    const float ny = along_x * ay + along_y * by + far_row.y - near * w_row.y;
    const float nz = along_x * az + along_y * bz + far_row.z - near * w_row.z;
    const float along = nx * rx + ny * ry + nz * rz;
    const float lengths = (nx * nx + ny * ny + nz * nz) * (rx * rx + ry * ry + rz * rz);
    lanes.live[i] =
        live & std::int32_t{along * along >= least * lengths} & std::int32_t{here < 1.0f};
  }
}

// Packs the lanes into bits: bit i is lane i.
STRATA_LANES std::uint64_t bits_of(const std::int32_t* lanes) {
  alignas(64) std::uint8_t bytes[kLanes];
  for (int i = 0; i < kLanes; ++i) bytes[i] = static_cast<std::uint8_t>(lanes[i]);
  std::uint64_t bits = 0;
  for (int row = 0; row < kBlockSize; ++row) {
    std::uint64_t eight;
    std::memcpy(&eight, bytes + row * kBlockSize, sizeof eight);
    // Collects the lowest bit of each byte.
    bits |= (eight * 0x0102040810204080u >> 56) << (row * kBlockSize);
  }
  return bits;
}

STRATA_LANES std::uint64_t test_lanes(const BlockTest& test, const std::uint64_t* positions,
                                      const mesh::SurfaceMap::PackedBox& box,
                                      std::span<const std::uint32_t> segments, bool in_tool) {
  Lanes lanes;
  project(test, positions, box, lanes);
  if (!in_tool) test_tool(test, segments, lanes);
  if (test.depth) test_depth(test, lanes);
  if (test.depth && test.facing) test_facing(test, lanes);
  if (!test.section.empty()) test_section(test, positions, box, lanes);
  return bits_of(lanes.live);
}

std::uint64_t test_plain(const BlockTest& test, const std::uint64_t* positions,
                         const mesh::SurfaceMap::PackedBox& box,
                         std::span<const std::uint32_t> segments, bool in_tool) {
  return test_lanes(test, positions, box, segments, in_tool);
}

#if defined(__x86_64__)
__attribute__((target("avx2,fma"))) std::uint64_t test_avx2(const BlockTest& test,
                                                            const std::uint64_t* positions,
                                                            const mesh::SurfaceMap::PackedBox& box,
                                                            std::span<const std::uint32_t> segments,
                                                            bool in_tool) {
  return test_lanes(test, positions, box, segments, in_tool);
}

__attribute__((target("avx512f,avx512bw,avx512dq,avx512vl,fma,prefer-vector-width=512")))
std::uint64_t
test_avx512(const BlockTest& test, const std::uint64_t* positions,
            const mesh::SurfaceMap::PackedBox& box, std::span<const std::uint32_t> segments,
            bool in_tool) {
  return test_lanes(test, positions, box, segments, in_tool);
}
#endif

}  // namespace

VectorUnit best_vector_unit() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") &&
      __builtin_cpu_supports("fma"))
    return VectorUnit::avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return VectorUnit::avx2;
#endif
  return VectorUnit::plain;
}

TestBlock test_block_on(VectorUnit unit) {
#if defined(__x86_64__)
  if (unit == VectorUnit::avx512) return test_avx512;
  if (unit == VectorUnit::avx2) return test_avx2;
#endif
  (void)unit;
  return test_plain;
}

}  // namespace strata::render
