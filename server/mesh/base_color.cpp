#include "mesh/base_color.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "mesh/buckets.h"
#include "mesh/color_math.h"
#include "mesh/gutter_fill.h"
#include "mesh/load_formats.h"
#include "mesh/parallel.h"
#include "mesh/texel_raster.h"
#include "mesh/texture_sampler.h"

namespace strata::mesh {
namespace {

constexpr int kSmallestBaseColor = 256, kPlainColors = 2048;
constexpr int kGutterRing = 8;
constexpr int kJpegQuality = 92;
constexpr double kDensitySlack = 0.9;      // of the side of a power of two, before the next one is taken
constexpr double kMostMinification = 1.5;  // that mixing four texels bears
constexpr int kBands = 2;
constexpr std::uint8_t kCovered = 255, kClaimed = 254;

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

class Baker {
 public:
  Baker(TriangleMesh& mesh, const Atlas& atlas, std::vector<Repair>& repairs, Progress& progress)
      : mesh_(mesh), atlas_(atlas), repairs_(repairs), progress_(progress) {}

  Result<std::optional<BaseColor>> run() {
    look_at_materials();
    if (mesh_.materials.empty() || (!textured_ && !several_colors_)) {
      if (!mesh_.materials.empty()) color_vertices();
      return std::nullopt;
    }
    if (!textured_ && !mesh_.vertex_colors.empty() && !mesh_.colors_tint_materials) return std::nullopt;
    if (const int only = only_texture(); only >= 0) return as_it_is(only);
    return bake();
  }

 private:
  const Material& material_of(std::size_t triangle) const {
    static const Material plain;
    const std::uint16_t material = mesh_.triangle_materials.empty() ? kNoMaterial : mesh_.triangle_materials[triangle];
    return material == kNoMaterial ? plain : mesh_.materials[material];
  }

  void look_at_materials() {
    if (mesh_.materials.empty()) return;
    first_color_ = material_of(0).color;
    all_jpeg_ = true;
    for (std::size_t t = 0; t < mesh_.triangle_count(); ++t) {
      const Material& material = material_of(t);
      several_colors_ = several_colors_ || glm::vec3(material.color) != glm::vec3(first_color_);
      textured_ = textured_ || material.texture >= 0;
    }
    for (const Texture& texture : mesh_.textures)
      all_jpeg_ = all_jpeg_ && picture_format(texture.bytes) == PictureFormat::jpeg;
    all_jpeg_ = all_jpeg_ && textured_;
  }

  static bool is_white(const glm::vec4& color) { return glm::vec3(color) == glm::vec3(1); }

  // The texture whose bytes can stay as they are, or −1.
  int only_texture() const {
    if (atlas_.report.source != "file" || several_colors_ || !is_white(first_color_)) return -1;
    if (mesh_.colors_tint_materials && !mesh_.vertex_colors.empty()) return -1;
    const int texture = material_of(0).texture;
    for (std::size_t t = 0; t < mesh_.triangle_count(); ++t)
      if (material_of(t).texture != texture) return -1;
    return texture;
  }

  // One colour for all: the vertices carry it.
  void color_vertices() {
    if (is_white(first_color_) || (!mesh_.vertex_colors.empty() && !mesh_.colors_tint_materials)) return;
    if (mesh_.vertex_colors.empty()) mesh_.vertex_colors.assign(mesh_.positions.size(), 0xffffffffu);
    for (std::uint32_t& color : mesh_.vertex_colors) {
      std::uint8_t rgb[3] = {std::uint8_t(color), std::uint8_t(color >> 8), std::uint8_t(color >> 16)};
      multiply(rgb, first_color_);
      color = (color & 0xff000000u) | rgb[0] | std::uint32_t{rgb[1]} << 8 | std::uint32_t{rgb[2]} << 16;
    }
  }

  static void multiply(std::uint8_t* rgb, const glm::vec4& color) {
    const ColorTables& tables = color_tables();
    for (int c = 0; c < 3; ++c)
      rgb[c] = tables.srgb[static_cast<std::size_t>(tables.linear[rgb[c]] * linear_of_srgb(color[c]) + 0.5)];
  }

  void note_unreadable(const Texture& texture, const Problem& problem) {
    note(repairs_, "texture not read: " + texture.name + ": " + problem.detail, 1);
  }

  Result<std::optional<BaseColor>> as_it_is(int index) {
    Texture& texture = mesh_.textures[index];
    progress_.report(0, "Checking the texture");
    if (const auto whole = decode_picture(texture.bytes); !whole) {
      note_unreadable(texture, whole.error());
      return std::nullopt;
    }
    const auto info = inspect_picture(texture.bytes);
    return BaseColor{info->format, info->width, info->height, std::move(texture.bytes)};
  }

  glm::dvec2 atlas_uv(std::size_t triangle, int k) const { return atlas_.corner_uvs[3 * triangle + k]; }
  glm::dvec2 texture_uv(std::size_t triangle, int k) const {
    return mesh_.corner_uvs.empty() ? glm::dvec2(0) : glm::dvec2(mesh_.corner_uvs[3 * triangle + k]);
  }
  template <class Uv>
  double uv_area(std::size_t triangle, Uv uv) const {
    const glm::dvec2 a = (this->*uv)(triangle, 0);
    return std::abs(cross((this->*uv)(triangle, 1) - a, (this->*uv)(triangle, 2) - a)) / 2;
  }

  // Texels of the textures, and share of the atlas, that the triangles of each texture take.
  struct Share {
    double texture_pixels = 0, atlas = 0;
  };

  Result<std::optional<BaseColor>> bake() {
    const std::size_t textures = mesh_.textures.size();
    std::vector<PictureInfo> infos(textures);
    for (std::size_t i = 0; i < textures; ++i)
      if (const auto info = inspect_picture(mesh_.textures[i].bytes); info) infos[i] = *info;
    std::vector<Share> shares(textures + 1);
    for (std::size_t t = 0; t < mesh_.triangle_count(); ++t) {
      const int texture = material_of(t).texture;
      Share& share = shares[texture + 1];
      share.atlas += uv_area(t, &Baker::atlas_uv);
      if (texture >= 0)
        share.texture_pixels +=
            uv_area(t, &Baker::texture_uv) * double(infos[texture].width) * double(infos[texture].height);
    }
    // Triangles by their textures; those without come first.
    const auto place_of = [&](std::uint32_t t) { return material_of(t).texture + 1; };
    const Buckets by_texture(static_cast<int>(textures) + 1, static_cast<std::uint32_t>(mesh_.triangle_count()),
                             [&](std::uint32_t t) {
                               return std::pair{place_of(t), place_of(t)};
                             });
    const int side = resolution_for(shares);
    picture_.width = picture_.height = side;
    picture_.rgba.assign(std::size_t(side) * side * 4, 0);
    for (std::size_t i = 0; i <= textures; ++i) {
      progress_.report(0.7 * double(i) / double(textures + 1), "Painting the base colour");
      if (progress_.cancelled()) return cancelled_problem();
      const auto triangles = by_texture[static_cast<int>(i)];
      if (triangles.empty()) continue;
      Picture source;
      if (i > 0) source = decoded(mesh_.textures[i - 1], shares[i], side);
      paint(triangles, source);
    }
    progress_.report(0.7, "Painting the base colour");
    fill_gutter(picture_, kGutterRing);
    progress_.report(0.85, "Packing the base colour");
    if (progress_.cancelled()) return cancelled_problem();
    BaseColor result{all_jpeg_ ? PictureFormat::jpeg : PictureFormat::png, side, side, {}};
    result.bytes = all_jpeg_ ? encode_jpeg(picture_.rgba, side, side, {kJpegQuality, true})
                             : encode_png(picture_.rgba, side, side);
    return result;
  }

  static int resolution_for(const std::vector<Share>& shares) {
    double pixels = 0, atlas = 0;
    for (const Share& share : shares)
      if (share.texture_pixels > 0) {
        pixels += share.texture_pixels;
        atlas += share.atlas;
      }
    if (!(pixels > 0) || !(atlas > 0)) return kPlainColors;
    const double side = std::clamp(std::sqrt(pixels / atlas) * kDensitySlack, 1.0, double(kLargestBaseColor));
    const auto power = std::bit_ceil(static_cast<unsigned>(std::ceil(side)));
    return std::clamp(static_cast<int>(power), kSmallestBaseColor, kLargestBaseColor);
  }

  // As fine as the atlas can show. An empty picture where it cannot be decoded.
  Picture decoded(Texture& texture, const Share& share, int side) {
    auto picture = decode_picture(texture.bytes);
    if (!picture) note_unreadable(texture, picture.error());
    texture.bytes = {};
    if (!picture) return {};
    double minification = std::sqrt(share.texture_pixels / std::max(share.atlas * side * side, 1e-300));
    for (; minification > kMostMinification && (picture->width > 1 || picture->height > 1); minification /= 2)
      picture = halve(*picture);
    return std::move(*picture);
  }

  void paint(std::span<const std::uint32_t> triangles, const Picture& source) {
    const TextureSampler sampler(source);
    const int side = picture_.width, rows = (side + kBands - 1) / kBands;
    parallel_for(kBands, kBands, [&](int band) {
      for (const std::uint32_t t : triangles)
        paint_triangle(t, source.rgba.empty() ? nullptr : &sampler, band * rows, std::min(side, (band + 1) * rows));
    });
  }

  void paint_triangle(std::uint32_t t, const TextureSampler* sampler, int row_begin, int row_end) {
    const int side = picture_.width;
    const glm::dvec2 a = atlas_uv(t, 0) * double(side), b = atlas_uv(t, 1) * double(side),
                     c = atlas_uv(t, 2) * double(side);
    const double low = std::min({a.y, b.y, c.y}) - 1, high = std::max({a.y, b.y, c.y}) + 1;
    if (high < row_begin || low > row_end) return;
    const double area = cross(b - a, c - a);
    const Material& material = material_of(t);
    const auto put = [&](int x, int y, std::uint8_t mark) {
      const glm::dvec2 at = glm::dvec2(x + 0.5, y + 0.5) - a;
      glm::dvec3 weights(1.0 / 3);
      if (area != 0) {
        weights.y = std::clamp(cross(at, c - a) / area, 0.0, 1.0);
        weights.z = std::clamp(cross(b - a, at) / area, 0.0, 1.0 - weights.y);
        weights.x = 1 - weights.y - weights.z;
      }
      std::uint8_t* out = &picture_.rgba[(std::size_t(side - 1 - y) * side + x) * 4];
      if (mark == kClaimed && out[3] != 0) return;
      shade(t, material, weights, sampler, out);
      out[3] = mark;
    };
    const CoverageRaster raster(snap_to_subtexels(a.x, a.y), snap_to_subtexels(b.x, b.y), snap_to_subtexels(c.x, c.y));
    bool covers = false;
    raster.for_each_span(0, side, 0, side, [&](int y, int x_begin, int x_end) {
      covers = true;
      if (y >= row_begin && y < row_end)
        for (int x = x_begin; x < x_end; ++x) put(x, y, kCovered);
      return true;
    });
    if (covers) return;
    // Too thin for any texel's centre: the one it lies in, unless another triangle has it.
    const glm::dvec2 middle = (a + b + c) / 3.0;
    const int x = std::clamp(static_cast<int>(middle.x), 0, side - 1),
              y = std::clamp(static_cast<int>(middle.y), 0, side - 1);
    if (y >= row_begin && y < row_end) put(x, y, kClaimed);
  }

  void shade(std::uint32_t t, const Material& material, const glm::dvec3& weights, const TextureSampler* sampler,
             std::uint8_t* out) const {
    out[0] = out[1] = out[2] = 255;
    if (sampler) {
      const glm::dvec2 uv = texture_uv(t, 0) * weights.x + texture_uv(t, 1) * weights.y + texture_uv(t, 2) * weights.z;
      const glm::vec3 sampled = sampler->sample(uv, material.wrap_u, material.wrap_v) + 0.5f;
      for (int c = 0; c < 3; ++c) out[c] = static_cast<std::uint8_t>(sampled[c]);
    }
    if (!is_white(material.color)) multiply(out, material.color);
    // A triangle without any material shows its vertices' colours.
    const bool tinted = mesh_.colors_tint_materials || (!sampler && is_white(material.color));
    if (mesh_.vertex_colors.empty() || !tinted) return;
    glm::dvec3 tint(0);
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t color = mesh_.vertex_colors[mesh_.triangles[3 * std::size_t{t} + k]];
      tint += weights[k] * glm::dvec3(color & 0xff, color >> 8 & 0xff, color >> 16 & 0xff) / 255.0;
    }
    multiply(out, glm::vec4(tint, 1));
  }

  TriangleMesh& mesh_;
  const Atlas& atlas_;
  std::vector<Repair>& repairs_;
  Progress& progress_;
  glm::vec4 first_color_{1};
  bool several_colors_ = false, textured_ = false, all_jpeg_ = false;
  Picture picture_;
};

}  // namespace

Result<std::optional<BaseColor>> bake_base_color(TriangleMesh& mesh, const Atlas& atlas, std::vector<Repair>& repairs,
                                                 Progress& progress) {
  return Baker(mesh, atlas, repairs, progress).run();
}

}  // namespace strata::mesh
