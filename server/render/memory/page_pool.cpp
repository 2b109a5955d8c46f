#include "render/memory/page_pool.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <numeric>
#include <string>

#include "render/memory/texel_width.h"
#include "render/memory/tile_bytes.h"
#include "shared/pages.h"

namespace strata::render {
namespace {

constexpr int kSliceSize = 2048;
constexpr unsigned kMaxSlicesPerChunk = 512;
constexpr std::uint32_t kCellsPerSlice = shader::kCellsPerSide * shader::kCellsPerSide;

struct Place {
  std::uint32_t chunk;
  int slice, x, y;
};

Place place_of(PageId page) {
  const auto cell = page & shader::kPageCellMask;
  return {page >> shader::kPageChunkShift,
          static_cast<int>((page >> shader::kPageCellBits) & shader::kPageSliceMask),
          static_cast<int>(cell % shader::kCellsPerSide) * kTileSize,
          static_cast<int>(cell / shader::kCellsPerSide) * kTileSize};
}

}  // namespace

Result<PageId> PagePool::allocate() {
  while (free_.empty() && !memory_.fits(chunk_bytes(1)) && free_some_ && free_some_()) {
  }
  if (free_.empty()) {
    STRATA_TRY(add_chunk());
  }
  const PageId page = free_.back();
  free_.pop_back();
  ++chunks_[page >> shader::kPageChunkShift].used_pages;
  return page;
}

void PagePool::free(PageId page) {
  free_.push_back(page);
  --chunks_[page >> shader::kPageChunkShift].used_pages;
}

bool PagePool::drop_empty_chunk() {
  const auto empty = std::find_if(chunks_.begin(), chunks_.end(),
                                  [](const Chunk& c) { return c.values && c.used_pages == 0; });
  if (empty == chunks_.end()) return false;
  const auto number = static_cast<std::uint32_t>(empty - chunks_.begin());
  std::erase_if(free_, [&](PageId page) { return page >> shader::kPageChunkShift == number; });
  *empty = {};
  return true;
}

void PagePool::clear(PageId page) {
  const Place p = place_of(page);
  const std::uint32_t zero = 0;
  glClearTexSubImage(values(p.chunk).id(), 0, p.x, p.y, p.slice, kTileSize, kTileSize, 1,
                     GL_RED_INTEGER, texel_component(texel_bytes_), &zero);
  glClearTexSubImage(valid(p.chunk).id(), 0, p.x, p.y, p.slice, kTileSize, kTileSize, 1,
                     GL_RED_INTEGER, GL_UNSIGNED_BYTE, &zero);
}

void PagePool::upload(PageId page, const TileData& data) {
  assert(data.values.size() == static_cast<std::size_t>(kTexelsPerTile * texel_bytes_));
  const Place p = place_of(page);
  TileFlags flags;
  flags_of(data.valid, flags);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage3D(values(p.chunk).id(), 0, p.x, p.y, p.slice, kTileSize, kTileSize, 1,
                      GL_RED_INTEGER, texel_component(texel_bytes_), data.values.data());
  glTextureSubImage3D(valid(p.chunk).id(), 0, p.x, p.y, p.slice, kTileSize, kTileSize, 1,
                      GL_RED_INTEGER, GL_UNSIGNED_BYTE, flags.data());
}

void PagePool::read(PageId page, TileData& data) const {
  assert(data.values.size() == static_cast<std::size_t>(kTexelsPerTile * texel_bytes_));
  const Place p = place_of(page);
  TileFlags flags;
  glGetTextureSubImage(values(p.chunk).id(), 0, p.x, p.y, p.slice, kTileSize, kTileSize, 1,
                       GL_RED_INTEGER, texel_component(texel_bytes_),
                       static_cast<GLsizei>(data.values.size()), data.values.data());
  glGetTextureSubImage(valid(p.chunk).id(), 0, p.x, p.y, p.slice, kTileSize, kTileSize, 1,
                       GL_RED_INTEGER, GL_UNSIGNED_BYTE, static_cast<GLsizei>(flags.size()),
                       flags.data());
  data.valid = mask_of(flags);
}

std::uint64_t PagePool::chunk_bytes(int slices) const {
  return std::uint64_t{kSliceSize} * kSliceSize *
         static_cast<unsigned>(slices * (texel_bytes_ + 1));
}

Result<void> PagePool::add_chunk() {
  const auto unused = std::find_if(chunks_.begin(), chunks_.end(),
                                   [](const Chunk& chunk) { return !chunk.values; });
  const auto number = static_cast<std::size_t>(unused - chunks_.begin());
  if (number >= kMaxChunks) {
    return fail(ErrorCode::out_of_memory, "GPU memory exhausted",
                "The server can use at most 16 texture chunks for each width of values.");
  }
  const int present =
      std::accumulate(chunks_.begin(), chunks_.end(), 0,
                      [](int sum, const Chunk& chunk) { return sum + chunk.values.layers(); });
  // The chunks get 1, 2, 4 … slices if no chunk was dropped.
  int slices = static_cast<int>(
      std::min(std::bit_floor(static_cast<unsigned>(present) + 1), kMaxSlicesPerChunk));
  auto chunk = make_chunk(number, slices);
  // If the budget is nearly used, fewer slices may still fit.
  while (!chunk && slices > 1) chunk = make_chunk(number, slices /= 2);
  if (!chunk) return tl::unexpected(chunk.error());
  if (number == chunks_.size()) chunks_.emplace_back();
  chunks_[number] = std::move(*chunk);
  // In reverse order, because the last free page is allocated first.
  for (auto i = static_cast<std::uint32_t>(slices) * kCellsPerSlice; i-- > 0;) {
    free_.push_back(static_cast<std::uint32_t>(number) << shader::kPageChunkShift | i);
  }
  return {};
}

Result<PagePool::Chunk> PagePool::make_chunk(std::size_t number, int slices) {
  auto share = STRATA_TRY(memory_.reserve(chunk_bytes(slices), "layer tiles"));
  const std::string name =
      "pages of " + std::to_string(texel_bytes_) + " bytes, chunk " + std::to_string(number);
  auto values =
      gl::Texture::create_array(texel_format(texel_bytes_), kSliceSize, kSliceSize, slices, name);
  if (!values) return tl::unexpected(values.error());
  auto valid = STRATA_TRY(
      gl::Texture::create_array(GL_R8UI, kSliceSize, kSliceSize, slices, name + ", valid"));
  return Chunk{std::move(*values), std::move(valid), std::move(share), 0};
}

}  // namespace strata::render
