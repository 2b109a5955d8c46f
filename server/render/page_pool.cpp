#include "render/page_pool.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "shared/pages.h"

namespace strata::render {
namespace {

constexpr int kSliceSize = 2048;
constexpr std::size_t kMaxChunks = 16;   // 4 bits in a shade layer's units
constexpr int kMaxSlicesPerChunk = 512;
constexpr std::uint32_t kCellsPerSlice = shader::kCellsPerSide * shader::kCellsPerSide;

struct Place {
  int chunk, slice, x, y;
};

Place place_of(PageId page) {
  const auto cell = page & shader::kPageCellMask;
  return {static_cast<int>(page >> shader::kPageChunkShift),
          static_cast<int>((page >> shader::kPageCellBits) & shader::kPageSliceMask),
          static_cast<int>(cell % shader::kCellsPerSide) * kTileSize, static_cast<int>(cell / shader::kCellsPerSide) * kTileSize};
}

}  // namespace

GLenum texel_format(int texel_bytes) { return texel_bytes == 1 ? GL_R8UI : texel_bytes == 2 ? GL_R16UI : GL_R32UI; }

GLenum texel_component(int texel_bytes) {
  return texel_bytes == 1 ? GL_UNSIGNED_BYTE : texel_bytes == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
}

std::string image_format_define(int texel_bytes) {
  return std::string("TEXEL_FORMAT ") + (texel_bytes == 1 ? "r8ui" : texel_bytes == 2 ? "r16ui" : "r32ui");
}

Result<PageId> PagePool::allocate() {
  if (free_.empty()) {
    if (auto added = add_chunk(); !added) return tl::unexpected(added.error());
  }
  const PageId page = free_.back();
  free_.pop_back();
  clear(page);
  return page;
}

void PagePool::free(PageId page) { free_.push_back(page); }

void PagePool::clear(PageId page) {
  const Place p = place_of(page);
  const std::uint32_t zero = 0;
  glClearTexSubImage(values(p.chunk).id(), 0, p.x, p.y, p.slice, kTileSize, kTileSize, 1, GL_RED_INTEGER,
                     texel_component(texel_bytes_), &zero);
  glClearTexSubImage(valid(p.chunk).id(), 0, p.x, p.y, p.slice, kTileSize, kTileSize, 1, GL_RED_INTEGER, GL_UNSIGNED_BYTE,
                     &zero);
}

void PagePool::upload(PageId page, const TileData& data) {
  assert(data.values.size() == static_cast<std::size_t>(kTexelsPerTile * texel_bytes_));
  const Place p = place_of(page);
  std::array<std::uint8_t, kTexelsPerTile> flags;
  for (int i = 0; i < kTexelsPerTile; ++i) flags[static_cast<std::size_t>(i)] = data.valid.test(i) ? 1 : 0;
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage3D(values(p.chunk).id(), 0, p.x, p.y, p.slice, kTileSize, kTileSize, 1, GL_RED_INTEGER,
                      texel_component(texel_bytes_), data.values.data());
  glTextureSubImage3D(valid(p.chunk).id(), 0, p.x, p.y, p.slice, kTileSize, kTileSize, 1, GL_RED_INTEGER,
                      GL_UNSIGNED_BYTE, flags.data());
}

Result<void> PagePool::add_chunk() {
  if (chunks_.size() >= kMaxChunks) {
    return fail(503, "GPU memory used up", "No more than 16 texture chunks of one value width can be used.");
  }
  const int slices = chunks_.empty() ? 1 : std::min(chunks_.back().values.layers() * 2, kMaxSlicesPerChunk);
  auto added = add_chunk_of(slices);
  // Near the budget a single slice may still fit.
  if (!added && slices > 1) added = add_chunk_of(1);
  return added;
}

Result<void> PagePool::add_chunk_of(int slices) {
  const std::uint64_t bytes = std::uint64_t{kSliceSize} * kSliceSize * static_cast<unsigned>(slices * (texel_bytes_ + 1));
  auto share = memory_.reserve(bytes, "layer tiles");
  if (!share) return tl::unexpected(share.error());
  const std::string name = "pages of " + std::to_string(texel_bytes_) + " bytes, chunk " + std::to_string(chunks_.size());
  auto values = gl::Texture::create_array(texel_format(texel_bytes_), kSliceSize, kSliceSize, slices, name);
  if (!values) return tl::unexpected(values.error());
  auto valid = gl::Texture::create_array(GL_R8UI, kSliceSize, kSliceSize, slices, name + ", valid");
  if (!valid) return tl::unexpected(valid.error());
  const auto chunk = static_cast<std::uint32_t>(chunks_.size());
  chunks_.push_back({std::move(*values), std::move(*valid), std::move(*share)});
  // In reverse, so that pages are taken in ascending order.
  for (auto i = static_cast<std::uint32_t>(slices) * kCellsPerSlice; i-- > 0;) {
    free_.push_back(chunk << shader::kPageChunkShift | i);
  }
  return {};
}

}  // namespace strata::render
