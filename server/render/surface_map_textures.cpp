#include "render/surface_map_textures.h"

#include <algorithm>

#include "shared/pages.h"

namespace strata::render {
namespace {

constexpr std::size_t kRow = shader::kPositionRow;
constexpr std::size_t kRowsPerSlice = 2048;
constexpr std::size_t kRowsPerUpload = 256;  // 4 MiB
constexpr std::size_t kBoxesPerUpload = (4u << 20) / sizeof(mesh::SurfaceMap::PackedBox);
static_assert(sizeof(mesh::SurfaceMap::PackedBox) == 24, "six floats, as shaders/edit_pass.comp reads them");

}  // namespace

Result<std::unique_ptr<SurfaceMapTextures>> SurfaceMapTextures::create(std::shared_ptr<const mesh::SurfaceMap> map,
                                                                       GpuMemory& memory) {
  auto textures = std::make_unique<SurfaceMapTextures>();
  const std::size_t texels = map->packed_position.size();
  textures->map_ = std::move(map);
  textures->total_rows_ = (texels + kRow - 1) / kRow;
  const std::size_t height = std::clamp<std::size_t>(textures->total_rows_, 1, kRowsPerSlice);
  const std::size_t layers = std::max<std::size_t>(1, (textures->total_rows_ + kRowsPerSlice - 1) / kRowsPerSlice);
  const std::size_t box_bytes =
      std::max<std::size_t>(1, textures->map_->packed_box.size()) * sizeof(mesh::SurfaceMap::PackedBox);
  auto share = memory.reserve(kRow * height * layers * sizeof(std::uint64_t) + box_bytes, "a surface map");
  if (!share) return tl::unexpected(share.error());
  auto positions = gl::Texture::create_array(GL_RG32UI, static_cast<int>(kRow), static_cast<int>(height),
                                             static_cast<int>(layers), "surface positions");
  if (!positions) return tl::unexpected(positions.error());
  auto boxes = gl::Buffer::create(box_bytes, gl::Buffer::Use::fixed, "surface position boxes");
  if (!boxes) return tl::unexpected(boxes.error());
  textures->boxes_ = std::move(*boxes);
  textures->share_ = std::move(*share);
  textures->positions_ = std::move(*positions);
  return textures;
}

std::unique_ptr<SurfaceMapTextures> SurfaceMapTextures::on_cpu(std::shared_ptr<const mesh::SurfaceMap> map) {
  auto textures = std::make_unique<SurfaceMapTextures>();
  textures->map_ = std::move(map);
  return textures;
}

bool SurfaceMapTextures::upload_slice() {
  if (complete()) return true;
  if (const std::size_t left = map_->packed_box.size() - uploaded_boxes_; left > 0) {
    const std::size_t count = std::min(left, kBoxesPerUpload);
    boxes_.upload_values(uploaded_boxes_ * sizeof(mesh::SurfaceMap::PackedBox),
                         std::span(map_->packed_box).subspan(uploaded_boxes_, count));
    uploaded_boxes_ += count;
    return complete();
  }
  const std::size_t row = uploaded_rows_ % kRowsPerSlice, layer = uploaded_rows_ / kRowsPerSlice;
  const std::size_t rows = std::min({kRowsPerUpload, kRowsPerSlice - row, total_rows_ - uploaded_rows_});
  if (rows == 0) return true;
  const auto& texels = map_->packed_position;
  const std::size_t first = uploaded_rows_ * kRow;
  const std::size_t whole_rows = std::min(rows, (texels.size() - first) / kRow);
  const auto upload = [&](std::size_t width, std::size_t height, std::size_t y, const std::uint64_t* data) {
    glTextureSubImage3D(positions_.id(), 0, 0, static_cast<GLint>(y), static_cast<GLint>(layer),
                        static_cast<GLsizei>(width), static_cast<GLsizei>(height), 1, GL_RG_INTEGER, GL_UNSIGNED_INT,
                        data);
  };
  if (whole_rows > 0) upload(kRow, whole_rows, row, texels.data() + first);
  if (whole_rows < rows) {  // the last row is not full
    const std::size_t start = first + whole_rows * kRow;
    upload(texels.size() - start, 1, row + whole_rows, texels.data() + start);
  }
  uploaded_rows_ += rows;
  return complete();
}

}  // namespace strata::render
