#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "gl/readback.h"
#include "render/memory/page_pool.h"
#include "render/memory/texel_width.h"

namespace strata::render {

// Packs pages for read-back in one dispatch for each chunk (shaders/tile_read_pass.comp).
class TileReader {
 public:
  static constexpr std::size_t kMaxPages = 256;  // a read, ≤ 20 MiB

  static Result<TileReader> create(const std::filesystem::path& shader_dir,
                                   gl::ReadbackPool& readback);

  static std::size_t bytes_per_tile(const PagePool& pool);  // size of a tile read back
  // Allocates memory for reading up to `pages` pages at a time: the only step of a read that can
  // fail, so that it can precede a change of the pages.
  Result<gl::Readback> make_room(const PagePool& pool, std::size_t pages) const;
  // Starts reading pages, which are returned in the given order. `room` must be large enough.
  void begin(const PagePool& pool, std::span<const PageId> pages, gl::Readback& room);
  static TileData tile(const gl::Readback& readback, const PagePool& pool, std::size_t index);

 private:
  gl::ReadbackPool* readback_ = nullptr;
  ProgramPerWidth programs_;
  gl::Buffer pages_;
};

}  // namespace strata::render
