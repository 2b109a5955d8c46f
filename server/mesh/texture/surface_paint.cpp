#include "mesh/texture/surface_paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "mesh/parallel.h"
#include "mesh/texels/texel_raster.h"
#include "mesh/texture/color_math.h"

namespace strata::mesh {
namespace {

constexpr int kBands = 2;
constexpr std::uint8_t kCovered = 255, kClaimed = 254;

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

bool is_white(const glm::vec4& color) { return glm::vec3(color) == glm::vec3(1); }

void store(const glm::vec3& color, std::uint8_t* out) {
  for (int c = 0; c < 3; ++c) out[c] = static_cast<std::uint8_t>(color[c] + 0.5f);
}

}  // namespace

void multiply_light(std::uint8_t* rgb, const glm::vec4& color) {
  const ColorTables& tables = color_tables();
  for (int c = 0; c < 3; ++c)
    rgb[c] =
        tables
            .srgb[static_cast<std::size_t>(tables.linear[rgb[c]] * linear_of_srgb(color[c]) + 0.5)];
}

const Material& SurfacePaint::material_of(std::size_t triangle) const {
  static const Material plain;
  const std::uint16_t material =
      mesh_.triangle_materials.empty() ? kNoMaterial : mesh_.triangle_materials[triangle];
  return material == kNoMaterial ? plain : mesh_.materials[material];
}

// Calls put(x, y, weights of the corners, mark) for each texel in the rows [row_begin, row_end). y
// points upward.
template <class Put>
void SurfacePaint::raster(std::uint32_t t, glm::ivec2 size, int row_begin, int row_end,
                          Put put) const {
  const glm::dvec2 a = atlas_uv(t, 0) * glm::dvec2(size), b = atlas_uv(t, 1) * glm::dvec2(size),
                   c = atlas_uv(t, 2) * glm::dvec2(size);
  const double low = std::min({a.y, b.y, c.y}) - 1, high = std::max({a.y, b.y, c.y}) + 1;
  if (high < row_begin || low > row_end) return;
  const double area = cross(b - a, c - a);
  const auto weigh = [&](int x, int y, std::uint8_t mark) {
    const glm::dvec2 at = glm::dvec2(x + 0.5, y + 0.5) - a;
    glm::dvec3 weights(1.0 / 3);
    if (area != 0) {
      weights.y = std::clamp(cross(at, c - a) / area, 0.0, 1.0);
      weights.z = std::clamp(cross(b - a, at) / area, 0.0, 1.0 - weights.y);
      weights.x = 1 - weights.y - weights.z;
    }
    put(x, y, weights, mark);
  };
  const CoverageRaster coverage(snap_to_subtexels(a.x, a.y), snap_to_subtexels(b.x, b.y),
                                snap_to_subtexels(c.x, c.y));
  bool covers = false;
  coverage.for_each_span(0, size.x, 0, size.y, [&](int y, int x_begin, int x_end) {
    covers = true;
    if (y >= row_begin && y < row_end)
      for (int x = x_begin; x < x_end; ++x) weigh(x, y, kCovered);
    return true;
  });
  if (covers) return;
  // The triangle is too thin for any texel center. It uses the texel that contains its centroid
  // unless another triangle owns this texel.
  const glm::dvec2 middle = (a + b + c) / 3.0;
  const int x = std::clamp(static_cast<int>(middle.x), 0, size.x - 1),
            y = std::clamp(static_cast<int>(middle.y), 0, size.y - 1);
  if (y >= row_begin && y < row_end) weigh(x, y, kClaimed);
}

void SurfacePaint::paint(std::span<const std::uint32_t> triangles, const Picture& source,
                         Picture& picture) const {
  const TextureSampler sampler(source);
  const glm::ivec2 size(picture.width, picture.height);
  const int rows = (size.y + kBands - 1) / kBands;
  parallel_for(kBands, kBands, [&](int band) {
    for (const std::uint32_t t : triangles) {
      const Material& material = material_of(t);
      raster(t, size, band * rows, std::min(size.y, (band + 1) * rows),
             [&](int x, int y, const glm::dvec3& weights, std::uint8_t mark) {
               std::uint8_t* out = &picture.rgba[(std::size_t(size.y - 1 - y) * size.x + x) * 4];
               if (mark == kClaimed && out[3] != 0) return;
               shade(t, material, weights, source.rgba.empty() ? nullptr : &sampler, out);
               out[3] = mark;
             });
    }
  });
}

void SurfacePaint::shade(std::uint32_t t, const Material& material, const glm::dvec3& weights,
                         const TextureSampler* sampler, std::uint8_t* out) const {
  out[0] = out[1] = out[2] = 255;
  if (sampler) {
    const glm::dvec2 uv =
        texture_uv(t, 0) * weights.x + texture_uv(t, 1) * weights.y + texture_uv(t, 2) * weights.z;
    store(sampler->sample(uv, material.wrap_u, material.wrap_v), out);
  }
  if (!is_white(material.color)) multiply_light(out, material.color);
  // A triangle without any material shows the colors of its vertices.
  const bool tinted = mesh_.colors_tint_materials || (!sampler && is_white(material.color));
  if (mesh_.vertex_colors.empty() || !tinted) return;
  glm::dvec3 tint(0);
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t color = mesh_.vertex_colors[mesh_.triangles[3 * std::size_t{t} + k]];
    tint += weights[k] * glm::dvec3(color & 0xff, color >> 8 & 0xff, color >> 16 & 0xff) / 255.0;
  }
  multiply_light(out, glm::vec4(tint, 1));
}

void SurfacePaint::paint_moved(int texture, int ring, Picture& picture) const {
  const glm::ivec2 size(picture.width, picture.height);
  const TextureSampler sampler(picture);
  const auto has_coordinates = [&](std::uint32_t t) {
    if (material_of(t).texture != texture) return false;
    const glm::dvec2 sum = texture_uv(t, 0) + texture_uv(t, 1) + texture_uv(t, 2);
    return std::isfinite(sum.x) && std::isfinite(sum.y);
  };
  // For each vertex of triangles without coordinates: a corner of a triangle with coordinates.
  std::unordered_map<std::uint32_t, std::uint32_t> corner_of;
  for (const auto t : atlas_.moved)
    if (!has_coordinates(t))
      for (std::size_t k = 0; k < 3; ++k)
        corner_of.emplace(mesh_.triangles[3 * std::size_t{t} + k], 0xffffffffu);
  if (!corner_of.empty()) {
    std::vector<bool> moves(mesh_.triangle_count());
    for (const auto t : atlas_.moved) moves[t] = true;
    for (std::uint32_t corner = 0; corner < mesh_.triangles.size(); ++corner)
      if (const auto entry = corner_of.find(mesh_.triangles[corner]);
          entry != corner_of.end() && !moves[corner / 3] && has_coordinates(corner / 3))
        entry->second = corner;
  }
  const auto color_at_vertex = [&](std::uint32_t vertex) -> std::optional<glm::vec3> {
    const std::uint32_t corner = corner_of.at(vertex);
    if (corner == 0xffffffffu) return std::nullopt;
    const std::uint32_t t = corner / 3;
    const Material& material = material_of(t);
    // The sample is slightly inside the triangle, because other colors are beyond the rim of a
    // chart or of the texture.
    const glm::dvec2 middle = (texture_uv(t, 0) + texture_uv(t, 1) + texture_uv(t, 2)) / 3.0;
    const glm::dvec2 uv = glm::mix(texture_uv(t, static_cast<int>(corner % 3)), middle, 0.05);
    return sampler.sample(uv, material.wrap_u, material.wrap_v);
  };

  // Painted texels are written afterwards, because another lookup may read the same texel.
  struct Texel {
    std::uint32_t at;
    std::array<std::uint8_t, 3> rgb;
  };
  std::vector<Texel> texels;
  const auto index = [&](int x, int y) {
    return static_cast<std::uint32_t>(size.y - 1 - y) * size.x + x;
  };
  for (const auto t : atlas_.moved) {
    const bool sampled = has_coordinates(t);
    std::array<glm::vec3, 3> corners{};
    if (!sampled) {
      glm::vec3 sum(0);
      int known = 0;
      std::array<std::optional<glm::vec3>, 3> found;
      for (std::size_t k = 0; k < 3; ++k)
        if ((found[k] = color_at_vertex(mesh_.triangles[3 * std::size_t{t} + k])))
          sum += *found[k], ++known;
      const glm::vec3 mean = known > 0 ? sum / float(known) : glm::vec3(255);
      for (std::size_t k = 0; k < 3; ++k) corners[k] = found[k].value_or(mean);
    }
    raster(t, size, 0, size.y, [&](int x, int y, const glm::dvec3& weights, std::uint8_t) {
      Texel texel{index(x, y), {}};
      if (sampled)
        shade(t, material_of(t), weights, &sampler, texel.rgb.data());
      else
        store(corners[0] * float(weights.x) + corners[1] * float(weights.y) +
                  corners[2] * float(weights.z),
              texel.rgb.data());
      texels.push_back(texel);
    });
  }

  std::vector<bool> taken(std::size_t(size.x) * size.y);
  for (std::uint32_t t = 0; t < mesh_.triangle_count(); ++t)
    raster(t, size, 0, size.y,
           [&](int x, int y, const glm::dvec3&, std::uint8_t) { taken[index(x, y)] = true; });
  const auto write = [&](const Texel& texel) {
    std::copy(texel.rgb.begin(), texel.rgb.end(), &picture.rgba[std::size_t{texel.at} * 4]);
    picture.rgba[std::size_t{texel.at} * 4 + 3] = 255;
  };
  for (const Texel& texel : texels) write(texel);
  for (std::vector<Texel> next; ring > 0 && !texels.empty(); --ring, texels.swap(next)) {
    next.clear();
    for (const Texel& texel : texels) {
      const int x = static_cast<int>(texel.at % size.x), y = static_cast<int>(texel.at / size.x);
      for (const glm::ivec2 beside : {glm::ivec2(x + 1, y), {x - 1, y}, {x, y + 1}, {x, y - 1}}) {
        if (beside.x < 0 || beside.x >= size.x || beside.y < 0 || beside.y >= size.y) continue;
        const auto at = static_cast<std::uint32_t>(beside.y) * size.x + beside.x;
        if (taken[at]) continue;
        taken[at] = true;
        next.push_back({at, texel.rgb});
        write(next.back());
      }
    }
  }
}

}  // namespace strata::mesh
