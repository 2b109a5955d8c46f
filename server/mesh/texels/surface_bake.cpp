#include "mesh/texels/surface_bake.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <thread>

#include "mesh/parallel.h"
#include "mesh/texels/gutter_ring.h"

namespace strata::mesh {
namespace {

constexpr int kMaxBands = 32;

// also handles NaN
double inside_unit(float value) { return value >= 0 ? std::min(double{value}, 1.0) : 0.0; }

}  // namespace

SurfaceBake::SurfaceBake(const Geometry& geometry, int resolution, SurfaceMap& map, BakeFor purpose)
    : geometry_(geometry),
      map_(map),
      resolution_(resolution),
      purpose_(purpose),
      band_count_(std::min(kMaxBands, resolution / kBlockSize)) {
  map.resolution = resolution;
  map.blocks_per_side = resolution / kBlockSize;
  snapped_.reserve(geometry.vertices.size());
  for (const Vertex& v : geometry.vertices)
    snapped_.push_back(
        snap_to_subtexels(inside_unit(v.uv.x) * resolution, inside_unit(v.uv.y) * resolution));
  islands_ = find_islands(geometry.indices, geometry.vertices.size());
  triangle_area_.resize(geometry.triangle_count());
  for (std::uint32_t t = 0; t < triangle_area_.size(); ++t) {
    // Computed from the double coordinates of the world, because model space uses float.
    const auto at = [&](int k) {
      return geometry.positions[geometry.vertices[vertex(t, k)].position_index];
    };
    const double area = glm::length(glm::cross(at(1) - at(0), at(2) - at(0))) / 2;
    triangle_area_[t] = static_cast<float>(area);
    map.area_total += area;
  }
  const auto blocks = static_cast<std::size_t>(map.blocks_per_side) * map.blocks_per_side;
  surface_of_block_.assign(blocks, 0);
  gutter_of_block_.assign(blocks, 0);
  triangles_of_band_ = triangles_by_band();
  borrowed_.resize(band_count());
  claims_.resize(band_count());
  leftovers_.resize(band_count());
  overlaps_of_band_.assign(band_count(), 0);
  parts_of_band_.resize(band_count());
}

Buckets SurfaceBake::triangles_by_band() const {
  std::vector<std::uint8_t> band_of_row(resolution_);
  for (int band = 0; band < band_count_; ++band)
    std::fill(band_of_row.begin() + first_row(band), band_of_row.begin() + first_row(band + 1),
              static_cast<std::uint8_t>(band));
  return {band_count_, static_cast<std::uint32_t>(geometry_.triangle_count()),
          [&](std::uint32_t t) {
            const int a = snapped_[vertex(t, 0)].y, b = snapped_[vertex(t, 1)].y,
                      c = snapped_[vertex(t, 2)].y;
            // The range is one subtexel wider on each side, because areas are clipped at the exact
            // coordinates.
            const int low = std::clamp((std::min({a, b, c}) - 1) >> 8, 0, resolution_ - 1);
            const int high = std::clamp((std::max({a, b, c}) + 1) >> 8, 0, resolution_ - 1);
            return std::pair{band_of_row[low], band_of_row[high]};
          }};
}

glm::dvec2 SurfaceBake::texels_at(std::uint32_t triangle, int k) const {
  const glm::vec2 uv = geometry_.vertices[vertex(triangle, k)].uv;
  return {inside_unit(uv.x) * resolution_, inside_unit(uv.y) * resolution_};
}

CoverageRaster SurfaceBake::raster_of(std::uint32_t triangle) const {
  return {snapped_[vertex(triangle, 0)], snapped_[vertex(triangle, 1)],
          snapped_[vertex(triangle, 2)]};
}

std::uint32_t SurfaceBake::centroid_texel(std::uint32_t triangle) const {
  const glm::dvec2 centre =
      (texels_at(triangle, 0) + texels_at(triangle, 1) + texels_at(triangle, 2)) / 3.0;
  const auto x = std::min(static_cast<int>(centre.x), resolution_ - 1);
  const auto y = std::min(static_cast<int>(centre.y), resolution_ - 1);
  return static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(resolution_) +
         static_cast<std::uint32_t>(x);
}

std::uint64_t SurfaceBake::block_mask(const std::vector<std::uint64_t>& masks, int block_x,
                                      int block_y) const {
  const int blocks = map_.blocks_per_side;
  if (block_x < 0 || block_y < 0 || block_x >= blocks || block_y >= blocks) return 0;
  return masks[static_cast<std::size_t>(block_y) * blocks + block_x];
}

bool SurfaceBake::is_surface(int x, int y) const {
  return (block_mask(surface_of_block_, x >> 3, y >> 3) >> ((y & 7) * 8 + (x & 7))) & 1u;
}

std::size_t SurfaceBake::texel_index(int x, int y) const {
  const auto block = static_cast<std::size_t>(y >> 3) * map_.blocks_per_side + (x >> 3);
  return std::size_t{map_.slot_of_block[block]} * 64 + (y & 7) * 8 + (x & 7);
}

std::uint32_t SurfaceBake::owner(int x, int y) const {
  return x >= 0 && y >= 0 && x < resolution_ && y < resolution_ && is_surface(x, y)
             ? owner_[texel_index(x, y)]
             : kNobody;
}

void SurfaceBake::mark_surface(int band) {
  const int y_low = first_row(band), y_high = first_row(band + 1);
  for (const std::uint32_t t : triangles_of_band_[band])
    raster_of(t).for_each_span(0, resolution_, y_low, y_high, [&](int y, int x0, int x1) {
      std::uint64_t* row =
          surface_of_block_.data() + static_cast<std::size_t>(y >> 3) * map_.blocks_per_side;
      for (int x = x0; x < x1;) {
        const int next = std::min(x1, (x | 7) + 1);
        const std::uint64_t bits = ((1u << (next - x)) - 1u) << (x & 7);
        row[x >> 3] |= bits << ((y & 7) * 8);
        x = next;
      }
      return true;
    });
  // Triangles between texel centers own the texel of their centroid if no other triangle owns it.
  auto& claims = claims_[band];
  for (const std::uint32_t t : triangles_of_band_[band]) {
    if (triangle_area_[t] <= 0) continue;
    const auto texel = centroid_texel(t);
    const int x = static_cast<int>(texel % resolution_), y = static_cast<int>(texel / resolution_);
    if (y < y_low || y >= y_high || is_surface(x, y)) continue;
    const bool covers_none = raster_of(t).for_each_span(0, resolution_, 0, resolution_,
                                                        [](int, int, int) { return false; });
    if (covers_none) claims.push_back({texel, t});
  }
  std::sort(claims.begin(), claims.end(), [&](const Claim& a, const Claim& b) {
    if (a.texel != b.texel) return a.texel < b.texel;
    const float area_a = triangle_area_[a.triangle], area_b = triangle_area_[b.triangle];
    return area_a != area_b ? area_a > area_b : a.triangle < b.triangle;
  });
  claims.erase(std::unique(claims.begin(), claims.end(),
                           [](const Claim& a, const Claim& b) { return a.texel == b.texel; }),
               claims.end());
  for (const Claim& claim : claims) {
    const int x = static_cast<int>(claim.texel % resolution_),
              y = static_cast<int>(claim.texel / resolution_);
    surface_of_block_[static_cast<std::size_t>(y >> 3) * map_.blocks_per_side + (x >> 3)] |=
        std::uint64_t{1} << ((y & 7) * 8 + (x & 7));
  }
}

void SurfaceBake::mark_gutter(int band) {
  for (int by = first_block_row(band); by < first_block_row(band + 1); ++by)
    for (int bx = 0; bx < map_.blocks_per_side; ++bx) {
      // The block with 2 texels on each side, as rows of 12 bits. Bit 2 is the block's first
      // column.
      std::array<std::uint32_t, 12> rows{};
      std::uint64_t any = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const std::uint64_t mask = block_mask(surface_of_block_, bx + dx, by + dy);
          if (mask == 0) continue;
          any |= mask;
          for (int row = dy < 0 ? 6 : 0; row < (dy > 0 ? 2 : 8); ++row) {
            const auto bits = static_cast<std::uint32_t>((mask >> (8 * row)) & 0xff);
            rows[8 * dy + row + 2] |= dx < 0 ? bits >> 6 : dx > 0 ? (bits & 3) << 10 : bits << 2;
          }
        }
      if (any == 0) continue;
      for (auto& row : rows) row = row | row << 1 | row << 2 | row >> 1 | row >> 2;
      std::uint64_t reached = 0;
      for (int y = 0; y < 8; ++y) {
        const std::uint32_t row = rows[y] | rows[y + 1] | rows[y + 2] | rows[y + 3] | rows[y + 4];
        reached |= std::uint64_t{(row >> 2) & 0xff} << (8 * y);
      }
      const auto block = static_cast<std::size_t>(by) * map_.blocks_per_side + bx;
      gutter_of_block_[block] = reached & ~surface_of_block_[block];
    }
}

void SurfaceBake::assign_slots(int threads) {
  map_.slot_of_block.assign(surface_of_block_.size(), kNoSlot);
  for (std::size_t block = 0; block < surface_of_block_.size(); ++block) {
    const std::uint64_t surface = surface_of_block_[block], gutter = gutter_of_block_[block];
    if ((surface | gutter) == 0) continue;
    map_.slot_of_block[block] = static_cast<std::uint32_t>(map_.block_of_slot.size());
    map_.block_of_slot.push_back(static_cast<std::uint32_t>(block));
    map_.surface_mask.push_back(surface);
    map_.surface_texels += std::popcount(surface);
    map_.gutter_texels += std::popcount(gutter);
  }
  const std::size_t slots = map_.block_of_slot.size();
  // The first access to new memory takes as long as the baking itself, so all threads share it.
  parallel_for(threads, 2, [&](int half) {
    if (half == 0)
      owner_.assign(slots * 64, kNobody);
    else if (purpose_ == BakeFor::owners)
      weights_.assign(slots * 64, 0);
    if (purpose_ == BakeFor::owners) return;
    if (half == 0) {
      map_.area.assign(slots * 64, 0.f);
    } else {
      map_.packed_position.assign(slots * 64, kNoPosition);
      position_.reset(new glm::vec3[slots * 64]);
    }
  });
  if (purpose_ == BakeFor::owners) return;
  map_.packed_box.resize(slots);
  map_.bounds_of_slot.resize(slots);
  if (!geometry_.part_ends.empty()) map_.part.assign(slots * 64, 0);
  map_.sums_of_slot.resize(slots);
  box_of_slot_.resize(slots);
}

namespace {

// The surface positions in a triangle as a function of texel coordinates, in model space.
class PositionPlane {
 public:
  PositionPlane(const std::array<glm::dvec2, 3>& uv, const std::array<glm::dvec3, 3>& corners)
      : origin_(uv[0]),
        base_(corners[0]),
        along_1_(corners[1] - corners[0]),
        along_2_(corners[2] - corners[0]) {
    const glm::dvec2 e1 = uv[1] - uv[0], e2 = uv[2] - uv[0];
    const double twice = e1.x * e2.y - e1.y * e2.x;
    is_line_ = std::abs(twice) <= 1e-12 * (glm::dot(e1, e1) + glm::dot(e2, e2));
    if (is_line_) return;
    weight_1_ = glm::dvec2(e2.y, -e2.x) / twice;
    weight_2_ = glm::dvec2(-e1.y, e1.x) / twice;
  }

  // Returns the weights of the second and third corner at (x, y). Negative weights are set to 0.
  glm::dvec2 weights(double x, double y) const {
    if (is_line_) return glm::dvec2(1.0 / 3.0);
    const glm::dvec2 d(x - origin_.x, y - origin_.y);
    double b1 = glm::dot(weight_1_, d), b2 = glm::dot(weight_2_, d);
    if (b1 < 0 || b2 < 0 || b1 + b2 > 1) {
      const double b0 = std::max(0.0, 1 - b1 - b2);
      b1 = std::max(0.0, b1), b2 = std::max(0.0, b2);
      const double sum = b0 + b1 + b2;
      b1 /= sum, b2 /= sum;
    }
    return {b1, b2};
  }

  std::uint32_t packed_weights(double x, double y) const {
    const auto part = [](double weight) {
      return static_cast<std::uint32_t>(std::lround(std::min(weight, 1.0) * 65535.0));
    };
    const glm::dvec2 b = weights(x, y);
    return part(b.x) | part(b.y) << 16;
  }

  // Returns the point of the triangle with these weights.
  glm::dvec3 at(double x, double y) const {
    const glm::dvec2 b = weights(x, y);
    return base_ + b.x * along_1_ + b.y * along_2_;
  }

 private:
  glm::dvec2 origin_, weight_1_{0}, weight_2_{0};
  glm::dvec3 base_, along_1_, along_2_;
  bool is_line_ = false;
};

}  // namespace

void SurfaceBake::place_surface(int band) {
  const int y_low = first_row(band), y_high = first_row(band + 1);
  const auto plane_of = [&](std::uint32_t t) {
    std::array<glm::dvec2, 3> uv;
    std::array<glm::dvec3, 3> corners;
    for (int k = 0; k < 3; ++k) {
      uv[k] = texels_at(t, k);
      corners[k] = geometry_.vertices[vertex(t, k)].position;
    }
    return PositionPlane(uv, corners);
  };
  const auto place = [&](std::size_t texel, std::uint32_t t, const PositionPlane& plane, int x,
                         int y) {
    owner_[texel] = t;
    if (purpose_ == BakeFor::owners)
      weights_[texel] = plane.packed_weights(x + 0.5, y + 0.5);
    else
      position_[texel] = plane.at(x + 0.5, y + 0.5);
    if (!map_.part.empty()) map_.part[texel] = static_cast<std::uint8_t>(geometry_.part_of(t));
  };
  std::vector<std::uint32_t> shared;
  for (const std::uint32_t t : triangles_of_band_[band]) {
    const CoverageRaster raster = raster_of(t);
    // Most triangles of a dense scan cover few texels. The plane is computed only when the first
    // texel needs it.
    std::optional<PositionPlane> plane;
    raster.for_each_span(0, resolution_, y_low, y_high, [&](int y, int x0, int x1) {
      if (!plane) plane = plane_of(t);
      for (int x = x0; x < x1; ++x) {
        const std::size_t texel = texel_index(x, y);
        const auto present = owner_[texel];
        if (present != kNobody) {
          shared.push_back(static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(resolution_) +
                           x);
          if (triangle_area_[present] >= triangle_area_[t]) continue;
        }
        place(texel, t, *plane, x, y);
      }
      return true;
    });
  }
  std::sort(shared.begin(), shared.end());
  overlaps_of_band_[band] = std::unique(shared.begin(), shared.end()) - shared.begin();
  for (const Claim& claim : claims_[band]) {
    const int x = static_cast<int>(claim.texel % resolution_),
              y = static_cast<int>(claim.texel / resolution_);
    place(texel_index(x, y), claim.triangle, plane_of(claim.triangle), x, y);
  }
}

void SurfaceBake::place_gutter(int band) {
  const int blocks = map_.blocks_per_side;
  for (int by = first_block_row(band); by < first_block_row(band + 1); ++by)
    for (int bx = 0; bx < blocks; ++bx) {
      std::uint64_t rest = gutter_of_block_[static_cast<std::size_t>(by) * blocks + bx];
      for (; rest != 0; rest &= rest - 1) {
        const int i = std::countr_zero(rest), x = bx * 8 + i % 8, y = by * 8 + i / 8;
        for (const TexelOffset o : kGutterRingOffsets) {
          if (!is_surface(x + o.x, y + o.y)) continue;
          const Borrowed borrowed{static_cast<std::uint32_t>(texel_index(x, y)),
                                  static_cast<std::uint32_t>(texel_index(x + o.x, y + o.y))};
          if (purpose_ == BakeFor::map) position_[borrowed.gutter] = position_[borrowed.owner];
          if (!map_.part.empty()) map_.part[borrowed.gutter] = map_.part[borrowed.owner];
          borrowed_[band].push_back(borrowed);
          break;
        }
      }
    }
}

bool SurfaceBake::nearest_surface(int x, int y, std::uint32_t island, glm::ivec2& found) const {
  for (const TexelOffset o : kGutterRingOffsets) {
    const auto t = owner(x + o.x, y + o.y);
    if (t == kNobody || islands_.of_triangle[t] != island) continue;
    found = {x + o.x, y + o.y};
    return true;
  }
  return false;
}

}  // namespace strata::mesh
