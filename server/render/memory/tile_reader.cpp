#include "render/memory/tile_reader.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "shared/pages.h"

namespace strata::render {
namespace {

constexpr GLuint kRunsPerTile = 512, kRunsPerGroup = 64;
constexpr std::size_t kMaskBytes = kMaskWords * sizeof(std::uint64_t);

}  // namespace

std::size_t TileReader::bytes_per_tile(const PagePool& pool) {
  return kMaskBytes + static_cast<std::size_t>(kTexelsPerTile * pool.texel_bytes());
}

Result<TileReader> TileReader::create(const std::filesystem::path& shader_dir,
                                      gl::ReadbackPool& readback) {
  TileReader reader;
  reader.readback_ = &readback;
  auto programs =
      STRATA_TRY(ProgramPerWidth::load(shader_dir, "tile_read_pass.comp", [](int texel_bytes) {
        return "TEXEL_BYTES " + std::to_string(texel_bytes);
      }));
  reader.programs_ = std::move(programs);
  auto pages =
      gl::Buffer::create(kMaxPages * sizeof(PageId), gl::Buffer::Use::fixed, "tile read pages");
  if (!pages) return tl::unexpected(pages.error());
  reader.pages_ = std::move(*pages);
  return reader;
}

Result<gl::Readback> TileReader::make_room(const PagePool& pool, std::size_t pages) const {
  return readback_->begin(std::min(pages, kMaxPages) * bytes_per_tile(pool));
}

void TileReader::begin(const PagePool& pool, std::span<const PageId> pages, gl::Readback& room) {
  assert(pages.size() * bytes_per_tile(pool) <= room.size());
  pages_.upload_values(0, pages);
  const gl::Program& program = programs_.of(pool.texel_bytes());
  program.use();
  pages_.bind_storage(0);
  room.buffer().bind_storage(1);
  // One dispatch reads consecutive pages of one chunk.
  for (std::size_t first = 0; first < pages.size();) {
    const auto chunk = pages[first] >> shader::kPageChunkShift;
    std::size_t last = first;
    while (last < pages.size() && pages[last] >> shader::kPageChunkShift == chunk) ++last;
    pool.values(chunk).bind(0);
    pool.valid(chunk).bind(1);
    program.set(0, static_cast<GLuint>(first));
    glDispatchCompute(kRunsPerTile / kRunsPerGroup, static_cast<GLuint>(last - first), 1);
    first = last;
  }
  room.submit();
}

TileData TileReader::tile(const gl::Readback& readback, const PagePool& pool, std::size_t index) {
  const std::byte* source = readback.data().data() + index * bytes_per_tile(pool);
  TileData tile;
  std::memcpy(tile.valid.words.data(), source, kMaskBytes);
  tile.values.resize(static_cast<std::size_t>(kTexelsPerTile * pool.texel_bytes()));
  std::memcpy(tile.values.data(), source + kMaskBytes, tile.values.size());
  return tile;
}

}  // namespace strata::render
