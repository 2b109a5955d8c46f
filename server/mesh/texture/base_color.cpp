#include "mesh/texture/base_color.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "mesh/buckets.h"
#include "mesh/io/load_formats.h"
#include "mesh/texture/gutter_fill.h"
#include "mesh/texture/surface_paint.h"
#include "mesh/texture/texture_sampler.h"

namespace strata::mesh {
namespace {

constexpr int kMinBaseColor = 256, kPlainColors = 2048;
// sides are powers of two up to kMaxPower, and multiples of kSideStep above
constexpr int kMaxPower = 2048, kSideStep = 1024;
constexpr int kGutterRing = 8, kRingsPerSide = 1024;
constexpr int kJpegQuality = 92;
constexpr double kRounding = 1 - 1e-3;    // tolerance before the next larger side is used
constexpr double kMaxMinification = 1.5;  // limit for interpolating between four texels
constexpr double kLost = 0.02;        // share of a texture's pixels; smaller losses are rounding
constexpr double kBytesPerTexel = 6;  // for the image, its coarser levels and the encoded result

std::string size_text(int width, int height) {
  return std::to_string(width) + " × " + std::to_string(height);
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

class Baker {
 public:
  Baker(TriangleMesh& mesh, const Atlas& atlas, std::vector<Repair>& repairs, Progress& progress,
        MemoryLedger* memory)
      : mesh_(mesh),
        atlas_(atlas),
        repairs_(repairs),
        progress_(progress),
        memory_(memory),
        paint_(mesh, atlas) {}

  Result<std::optional<BaseColor>> run() {
    ignore_black();
    look_at_materials();
    if (textured_) {
      if (const int only = only_texture(); only >= 0) {
        auto unchanged = as_it_is(only);
        if (!unchanged || *unchanged) return unchanged;
        forget_texture(only);
      } else if (auto shares = shares_of_textures(); true) {
        auto baked = bake(shares);
        if (!baked || *baked) return baked;
      }
      // No texture could be read, so the mesh is treated like a mesh without textures.
      look_at_materials();
    }
    if (mesh_.materials.empty() || !several_colors_) {
      if (!mesh_.materials.empty()) color_vertices();
      return std::nullopt;
    }
    if (!mesh_.vertex_colors.empty() && !mesh_.colors_tint_materials) return std::nullopt;
    return bake(shares_of_textures());
  }

 private:
  const Material& material_of(std::size_t triangle) const { return paint_.material_of(triangle); }

  // Many exporters write black for a color that they do not know. Such a black hides the texture,
  // or makes the whole surface a black shape on which no form can be seen.
  void ignore_black() {
    std::uint64_t textured = 0;
    for (Material& material : mesh_.materials) {
      if (material.texture < 0 || !is_black(material.color)) continue;
      material.color = {1, 1, 1, material.color.a};
      ++textured;
    }
    note(repairs_, "materials whose black color hid their texture", textured);
    if (std::ranges::all_of(mesh_.vertex_colors, [](auto color) { return !(color & 0xffffffu); })) {
      note(repairs_, "vertices with black as the only color, which is ignored",
           mesh_.vertex_colors.size());
      mesh_.vertex_colors.clear();
    }
    std::uint64_t black = 0;
    while (black < mesh_.triangle_count() && is_black(material_of(black).color)) ++black;
    if (mesh_.materials.empty() || black < mesh_.triangle_count()) return;
    for (Material& material : mesh_.materials) material.color = glm::vec4(1);
    note(repairs_, "triangles with black as the only color, which is ignored", black);
  }

  void look_at_materials() {
    if (mesh_.materials.empty()) return;
    first_color_ = material_of(0).color;
    several_colors_ = textured_ = false;
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

  static bool is_black(const glm::vec4& color) {
    return std::max({color.r, color.g, color.b}) < 1 / 255.f;
  }
  static bool is_white(const glm::vec4& color) { return glm::vec3(color) == glm::vec3(1); }

  // Returns the texture with pixels that need no change, or −1. Moved triangles may have no
  // texture.
  int only_texture() const {
    if (atlas_.report.source != "file" || atlas_.kept_scale < 1 || several_colors_ ||
        !is_white(first_color_))
      return -1;
    if (mesh_.colors_tint_materials && !mesh_.vertex_colors.empty()) return -1;
    int texture = -1;
    auto moved = atlas_.moved.begin();
    for (std::size_t t = 0; t < mesh_.triangle_count(); ++t) {
      const bool is_moved = moved != atlas_.moved.end() && *moved == t;
      if (is_moved) ++moved;
      const int own = material_of(t).texture;
      if (own == texture || (is_moved && own < 0)) continue;
      if (texture >= 0 || own < 0) return -1;
      texture = own;
    }
    return texture;
  }

  // All triangles have one color, which is applied to the vertices.
  void color_vertices() {
    if (is_white(first_color_) || (!mesh_.vertex_colors.empty() && !mesh_.colors_tint_materials))
      return;
    if (mesh_.vertex_colors.empty())
      mesh_.vertex_colors.assign(mesh_.positions.size(), 0xffffffffu);
    for (std::uint32_t& color : mesh_.vertex_colors) {
      std::uint8_t rgb[3] = {std::uint8_t(color), std::uint8_t(color >> 8),
                             std::uint8_t(color >> 16)};
      multiply_light(rgb, first_color_);
      color =
          (color & 0xff000000u) | rgb[0] | std::uint32_t{rgb[1]} << 8 | std::uint32_t{rgb[2]} << 16;
    }
  }

  void note_unreadable(const Texture& texture, const Error& problem) {
    note(repairs_, "texture not read: " + texture.name + ": " + problem.detail, 1);
  }

  void forget_texture(int texture) {
    for (Material& material : mesh_.materials)
      if (material.texture == texture) material.texture = -1;
  }

  Result<MemoryLedger::Share> reserved(double bytes) {
    if (!memory_) return MemoryLedger::Share();
    return memory_->reserve(static_cast<std::uint64_t>(bytes), "the textures of an import");
  }

  // Returns nothing if the texture cannot be read, and notes this.
  Result<std::optional<BaseColor>> as_it_is(int index) {
    Texture& texture = mesh_.textures[index];
    progress_.report(0, "Checking the texture");
    const auto info = inspect_picture(texture.bytes);
    if (!info) return note_unreadable(texture, info.error()), std::nullopt;
    const double pixels = double(info->width) * info->height;
    const bool stays = atlas_.moved.empty() && is_surface_image_format(info->format);
    const auto share = STRATA_TRY(reserved(pixels * (stays ? 4 : kBytesPerTexel)));
    auto whole = decode_picture(texture.bytes);
    if (!whole) return note_unreadable(texture, whole.error()), std::nullopt;
    if (stays) return BaseColor{info->format, info->width, info->height, std::move(texture.bytes)};
    texture.bytes = {};
    progress_.report(0.3, "Painting the base colour");
    if (!atlas_.moved.empty())
      paint_.paint_moved(index, std::max(1, whole->width / kRingsPerSide), *whole);
    if (progress_.cancelled()) return cancelled_problem();
    return encoded(*whole, info->format == PictureFormat::jpeg);
  }

  BaseColor encoded(const Picture& picture, bool as_jpeg) {
    progress_.report(0.85, "Packing the base colour");
    return {as_jpeg ? PictureFormat::jpeg : PictureFormat::png, picture.width, picture.height,
            as_jpeg ? encode_jpeg(picture.rgba, picture.width, picture.height, {kJpegQuality, true})
                    : encode_png(picture.rgba, picture.width, picture.height)};
  }

  glm::dvec2 atlas_uv(std::size_t triangle, int k) const {
    return atlas_.corner_uvs[3 * triangle + k];
  }
  glm::dvec2 texture_uv(std::size_t triangle, int k) const {
    return mesh_.corner_uvs.empty() ? glm::dvec2(0)
                                    : glm::dvec2(mesh_.corner_uvs[3 * triangle + k]);
  }
  template <class Uv>
  double uv_area(std::size_t triangle, Uv uv) const {
    const glm::dvec2 a = (this->*uv)(triangle, 0);
    return std::abs(cross((this->*uv)(triangle, 1) - a, (this->*uv)(triangle, 2) - a)) / 2;
  }

  // The pixels of a texture that its triangles use, and their share of the atlas. The first entry
  // is for triangles without a texture.
  struct Share {
    PictureInfo info;
    double texture_pixels = 0, atlas = 0;
    bool read = false;
  };

  std::vector<Share> shares_of_textures() const {
    std::vector<Share> shares(mesh_.textures.size() + 1);
    for (std::size_t i = 0; i < mesh_.textures.size(); ++i)
      if (const auto info = inspect_picture(mesh_.textures[i].bytes); info)
        shares[i + 1].info = *info;
    for (std::size_t t = 0; t < mesh_.triangle_count(); ++t) {
      const int texture = material_of(t).texture;
      Share& share = shares[texture + 1];
      share.atlas += uv_area(t, &Baker::atlas_uv);
      const double pixels =
          uv_area(t, &Baker::texture_uv) * double(share.info.width) * double(share.info.height);
      if (texture >= 0 && std::isfinite(pixels)) share.texture_pixels += pixels;
    }
    return shares;
  }

  // Reserves memory for the largest image that fits, up to the size that keeps all pixels.
  Result<MemoryLedger::Share> reserve_picture(const std::vector<Share>& shares, int& side) {
    double source = 0;
    for (const Share& share : shares)
      source = std::max(source, 4.0 * share.info.width * share.info.height);
    for (side = resolution_for(shares);; side = std::max(kMinBaseColor, side / 2)) {
      auto share = reserved(kBytesPerTexel * side * side + source);
      if (share || side == kMinBaseColor) return share;
    }
  }

  // Returns nothing if the mesh has textures but no texture can be read.
  Result<std::optional<BaseColor>> bake(std::vector<Share> shares) {
    const std::size_t textures = mesh_.textures.size();
    // Triangles are grouped by texture. Triangles without a texture come first.
    const auto place_of = [&](std::uint32_t t) { return material_of(t).texture + 1; };
    const Buckets by_texture(static_cast<int>(textures) + 1,
                             static_cast<std::uint32_t>(mesh_.triangle_count()),
                             [&](std::uint32_t t) {
                               return std::pair{place_of(t), place_of(t)};
                             });
    int side = 0;
    const auto memory = STRATA_TRY(reserve_picture(shares, side));
    Picture picture{side, side, std::vector<std::uint8_t>(std::size_t(side) * side * 4, 0)};
    bool any_read = !textured_;
    for (std::size_t i = 0; i <= textures; ++i) {
      progress_.report(0.7 * double(i) / double(textures + 1), "Painting the base colour");
      if (progress_.cancelled()) return cancelled_problem();
      const auto triangles = by_texture[static_cast<int>(i)];
      if (triangles.empty()) continue;
      Picture source;
      if (i > 0) {
        source = decoded(mesh_.textures[i - 1], shares[i], side);
        if (source.rgba.empty()) forget_texture(static_cast<int>(i - 1));
        shares[i].read = !source.rgba.empty();
        any_read = any_read || shares[i].read;
      }
      paint_.paint(triangles, source, picture);
    }
    if (!any_read) return std::nullopt;
    note_lost_pixels(shares, side);
    progress_.report(0.7, "Painting the base colour");
    fill_gutter(picture, kGutterRing);
    if (progress_.cancelled()) return cancelled_problem();
    return encoded(picture, all_jpeg_);
  }

  static int resolution_for(const std::vector<Share>& shares) {
    double pixels = 0, atlas = 0;
    for (const Share& share : shares)
      if (share.texture_pixels > 0) {
        pixels += share.texture_pixels;
        atlas += share.atlas;
      }
    if (!(pixels > 0) || !(atlas > 0)) return kPlainColors;
    const double needed = std::clamp(std::sqrt(pixels / atlas) * kRounding, double(kMinBaseColor),
                                     double(kMaxBaseColor));
    if (needed <= kMaxPower)
      return static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::ceil(needed))));
    return static_cast<int>(std::ceil(needed / kSideStep)) * kSideStep;
  }

  // Notes the original size and the kept size if pixels were lost.
  void note_lost_pixels(const std::vector<Share>& shares, int side) {
    double used = 0, retained = 0;
    std::uint64_t smaller = 0;
    std::map<std::pair<int, int>, int, std::greater<>> sizes;
    for (std::size_t i = 1; i < shares.size(); ++i) {
      const Share& share = shares[i];
      if (!share.read) continue;
      ++sizes[{share.info.width, share.info.height}];
      const double own = std::min(share.texture_pixels, share.atlas * side * side);
      used += share.texture_pixels;
      retained += own;
      smaller += own < share.texture_pixels * (1 - kLost);
    }
    if (smaller == 0) return;
    std::string came;
    constexpr std::size_t kMaxSizes = 5;
    std::size_t listed = 0;
    for (const auto& [size, count] : sizes) {
      if (listed++ == kMaxSizes) {
        came += ", …";
        break;
      }
      came += (came.empty() ? "" : ", ") + std::to_string(count) + " of " +
              size_text(size.first, size.second);
    }
    char share[16];
    std::snprintf(share, sizeof share, "%.0f %%", 100 * retained / used);
    note(repairs_,
         "textures made smaller: " + came + " pixels became one picture of " +
             size_text(side, side) + ", which keeps " + share +
             " of the pixels that the surface uses",
         smaller);
  }

  // Decodes a texture to at most the resolution of the atlas. Returns an empty image on failure.
  Picture decoded(Texture& texture, const Share& share, int side) {
    auto picture = decode_picture(texture.bytes);
    if (!picture) note_unreadable(texture, picture.error());
    texture.bytes = {};
    if (!picture) return {};
    double minification =
        std::sqrt(share.texture_pixels / std::max(share.atlas * side * side, 1e-300));
    for (; minification > kMaxMinification && (picture->width > 1 || picture->height > 1);
         minification /= 2)
      picture = halve(*picture);
    return std::move(*picture);
  }

  TriangleMesh& mesh_;
  const Atlas& atlas_;
  std::vector<Repair>& repairs_;
  Progress& progress_;
  MemoryLedger* memory_;
  SurfacePaint paint_;
  glm::vec4 first_color_{1};
  bool several_colors_ = false, textured_ = false, all_jpeg_ = false;
};

}  // namespace

Result<std::optional<BaseColor>> bake_base_color(TriangleMesh& mesh, const Atlas& atlas,
                                                 std::vector<Repair>& repairs, Progress& progress,
                                                 MemoryLedger* memory) {
  return Baker(mesh, atlas, repairs, progress, memory).run();
}

}  // namespace strata::mesh
