#include "render/memory/palette_textures.h"

#include <algorithm>
#include <bit>
#include <span>

namespace strata::render {
namespace {

constexpr std::uint32_t kRows = 256;
constexpr std::size_t kFirstPoints = 1 << 16;  // initial capacity

std::uint32_t packed_pattern(const Palette::Point& point) {
  if (point.pattern == Pattern::solid) return 0;
  const auto angle = static_cast<std::uint32_t>(point.angle / 180 * 16384 + 0.5) & 0x3fffu;
  const auto spacing =
      *encode_value(ValueType::f16, std::clamp(point.spacing_mm, 0.0, kWidestSpacing_mm));
  return static_cast<std::uint32_t>(point.pattern) | angle << 2 | spacing << 16;
}

std::vector<shader::PalettePoint> points_of(const Palette& palette, ValueType type) {
  std::vector<shader::PalettePoint> points;
  for (const Palette::Point& point : palette.points) {
    if (palette.mode == PaletteMode::step) {
      points.push_back({std::bit_cast<std::uint32_t>(static_cast<float>(point.at)),
                        packed(point.color), packed_pattern(point)});
    } else if (const auto bits = encode_value(type, point.at)) {
      // No texel has a key that is outside the type's range.
      points.push_back({*bits, packed(point.color), packed_pattern(point)});
    }
  }
  if (palette.mode == PaletteMode::categorical) {
    std::stable_sort(points.begin(), points.end(),
                     [](const auto& a, const auto& b) { return a.key < b.key; });
  }
  return points;
}

}  // namespace

std::uint32_t packed(const Rgba& c) {
  return c[0] | std::uint32_t{c[1]} << 8 | std::uint32_t{c[2]} << 16 | std::uint32_t{c[3]} << 24;
}

Result<PaletteTextures> PaletteTextures::create() {
  auto rows =
      gl::Texture::create_2d(GL_RGBA8, static_cast<int>(shader::kPaletteWidth), kRows, "palettes");
  if (!rows) return tl::unexpected(rows.error());
  auto points = STRATA_TRY(gl::Buffer::create(kFirstPoints * sizeof(shader::PalettePoint),
                                              gl::Buffer::Use::fixed, "palette points"));
  PaletteTextures textures;
  textures.rows_ = std::move(*rows);
  textures.points_ = std::move(points);
  return textures;
}

Result<void> PaletteTextures::make_room(std::span<const std::shared_ptr<const Palette>> palettes) {
  std::size_t points = 0;
  for (const auto& palette : palettes) points += palette->points.size();
  const std::size_t capacity = points_.size() / sizeof(shader::PalettePoint);
  if (next_row_ + palettes.size() <= kRows && next_point_ + points <= capacity) return {};
  entries_.clear();
  next_row_ = next_point_ = 0;
  if (points <= capacity) return {};
  auto larger = STRATA_TRY(gl::Buffer::create(std::bit_ceil(points) * sizeof(shader::PalettePoint),
                                              gl::Buffer::Use::fixed, "palette points"));
  points_ = std::move(larger);
  return {};
}

PaletteTextures::Entry PaletteTextures::find(const std::shared_ptr<const Palette>& palette,
                                             ValueType type) {
  const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) {
    return e.palette == palette && e.type == type;
  });
  if (known != entries_.end()) return *known;
  Entry entry{palette, type};
  if (palette->mode == PaletteMode::linear) {
    std::vector<Rgba> row(shader::kPaletteWidth);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const double t = static_cast<double>(i) / static_cast<double>(row.size() - 1);
      row[i] = color_of(*palette, palette->min + (palette->max - palette->min) * t);
    }
    entry.row = next_row_++;
    glTextureSubImage2D(rows_.id(), 0, 0, static_cast<GLint>(entry.row),
                        static_cast<GLsizei>(row.size()), 1, GL_RGBA, GL_UNSIGNED_BYTE, row.data());
  } else {
    const auto points = points_of(*palette, type);
    entry.points = next_point_;
    entry.point_count = static_cast<std::uint32_t>(points.size());
    entry.patterned = std::ranges::any_of(
        palette->points, [](const auto& p) { return p.pattern != Pattern::solid; });
    points_.upload_values(entry.points * sizeof(shader::PalettePoint),
                          std::span<const shader::PalettePoint>(points));
    next_point_ += entry.point_count;
  }
  entries_.push_back(entry);
  return entry;
}

void PaletteTextures::bind(GLuint texture_unit, GLuint points_binding) const {
  rows_.bind(texture_unit);
  points_.bind_storage(points_binding);
}

}  // namespace strata::render
