#include "render/memory/surface_map_textures.h"

#include <algorithm>
#include <bit>
#include <cstddef>

#include "shared/edit.h"
#include "shared/pages.h"

namespace strata::render {
namespace {

constexpr std::size_t kRow = shader::kPositionRow;
constexpr std::size_t kRowsPerSlice = 2048;
constexpr std::size_t kRowsPerUpload = 256;  // 4 MiB
constexpr std::size_t kBytesPerUpload = std::size_t{4} << 20;
constexpr std::size_t kNodeLevel = 2;

// These structs must have the layout that shaders/edit_pass.comp and edit_cull_pass.comp read.
static_assert(sizeof(mesh::SurfaceMap::PackedBox) == 6 * sizeof(float));
static_assert(sizeof(mesh::BoundingSphere) == 4 * sizeof(float));
static_assert(mesh::BlockTree::kChildren * mesh::BlockTree::kChildren == shader::kEditPartsPerNode);
static_assert(sizeof(mesh::BlockTree::Part) == sizeof(shader::EditPart) &&
              std::endian::native == std::endian::little);
static_assert(offsetof(mesh::BlockTree::Part, tile) == 4 &&
              offsetof(mesh::BlockTree::Part, place) == 6);

std::array<std::span<const std::byte>, 4> buffer_contents(const mesh::SurfaceMap& map) {
  const auto& levels = map.tree.levels;
  if (levels.empty()) return {std::as_bytes(std::span(map.packed_box)), {}, {}, {}};
  return {std::as_bytes(std::span(map.packed_box)),
          std::as_bytes(std::span(levels[std::min(kNodeLevel, levels.size() - 1)])),
          std::as_bytes(std::span(levels.front())), std::as_bytes(std::span(map.tree.parts))};
}

}  // namespace

Result<std::unique_ptr<SurfaceMapTextures>> SurfaceMapTextures::create(
    std::shared_ptr<const mesh::SurfaceMap> map, GpuMemory& memory) {
  auto textures = std::make_unique<SurfaceMapTextures>();
  const std::size_t texels = map->packed_position.size();
  textures->map_ = std::move(map);
  textures->total_rows_ = (texels + kRow - 1) / kRow;
  const std::size_t height = std::clamp<std::size_t>(textures->total_rows_, 1, kRowsPerSlice);
  const std::size_t layers =
      std::max<std::size_t>(1, (textures->total_rows_ + kRowsPerSlice - 1) / kRowsPerSlice);
  const auto contents = buffer_contents(*textures->map_);
  // GL buffers must not be empty.
  const auto room = [](std::size_t bytes) { return std::max<std::size_t>(bytes, 16); };
  const std::size_t touched_bytes =
      room(textures->map_->tree.parts.size() * sizeof(shader::TouchedPart));
  std::size_t bytes = kRow * height * layers * sizeof(std::uint64_t) + touched_bytes;
  for (const auto& content : contents) bytes += room(content.size());
  auto share = STRATA_TRY(memory.reserve(bytes, "a surface map"));
  auto positions =
      gl::Texture::create_array(GL_RG32UI, static_cast<int>(kRow), static_cast<int>(height),
                                static_cast<int>(layers), "surface positions");
  if (!positions) return tl::unexpected(positions.error());
  constexpr std::array kLabels = {"surface position boxes", "block tree nodes",
                                  "block tree spheres", "block tree parts"};
  for (std::size_t i = 0; i < contents.size(); ++i) {
    auto buffer = STRATA_TRY(
        gl::Buffer::create(room(contents[i].size()), gl::Buffer::Use::fixed, kLabels[i]));
    textures->buffers_[i] = {std::move(buffer), contents[i]};
  }
  auto touched =
      STRATA_TRY(gl::Buffer::create(touched_bytes, gl::Buffer::Use::fixed, "touched parts"));
  textures->touched_parts_ = std::move(touched);
  textures->share_ = std::move(share);
  textures->positions_ = std::move(*positions);
  return textures;
}

std::unique_ptr<SurfaceMapTextures> SurfaceMapTextures::on_cpu(
    std::shared_ptr<const mesh::SurfaceMap> map) {
  auto textures = std::make_unique<SurfaceMapTextures>();
  textures->map_ = std::move(map);
  return textures;
}

bool SurfaceMapTextures::upload_slice() {
  if (complete()) return true;
  if (upload_buffers()) upload_rows();
  return complete();
}

// Returns true if all buffers were already uploaded.
bool SurfaceMapTextures::upload_buffers() {
  while (next_buffer_ < buffers_.size() &&
         uploaded_bytes_ == buffers_[next_buffer_].content.size()) {
    ++next_buffer_;
    uploaded_bytes_ = 0;
  }
  if (next_buffer_ == buffers_.size()) return true;
  auto& [buffer, content] = buffers_[next_buffer_];
  const auto part =
      content.subspan(uploaded_bytes_, std::min(kBytesPerUpload, content.size() - uploaded_bytes_));
  buffer.upload(uploaded_bytes_, part);
  uploaded_bytes_ += part.size();
  return false;
}

void SurfaceMapTextures::upload_rows() {
  const std::size_t row = uploaded_rows_ % kRowsPerSlice, layer = uploaded_rows_ / kRowsPerSlice;
  const std::size_t rows =
      std::min({kRowsPerUpload, kRowsPerSlice - row, total_rows_ - uploaded_rows_});
  if (rows == 0) return;
  const auto& texels = map_->packed_position;
  const std::size_t first = uploaded_rows_ * kRow;
  const std::size_t whole_rows = std::min(rows, (texels.size() - first) / kRow);
  const auto upload = [&](std::size_t width, std::size_t height, std::size_t y,
                          const std::uint64_t* data) {
    glTextureSubImage3D(positions_.id(), 0, 0, static_cast<GLint>(y), static_cast<GLint>(layer),
                        static_cast<GLsizei>(width), static_cast<GLsizei>(height), 1, GL_RG_INTEGER,
                        GL_UNSIGNED_INT, data);
  };
  if (whole_rows > 0) upload(kRow, whole_rows, row, texels.data() + first);
  if (whole_rows < rows) {  // the last row is not full
    const std::size_t start = first + whole_rows * kRow;
    upload(texels.size() - start, 1, row + whole_rows, texels.data() + start);
  }
  uploaded_rows_ += rows;
}

}  // namespace strata::render
