#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "gl/readback.h"
#include "render/memory/page_pool.h"
#include "render/memory/texel_width.h"

namespace strata::render {

// Packs pages for read-back, with one dispatch for each chunk (shaders/tile_read_pass.comp).
class TileReader {
 public:
  static constexpr std::size_t kMaxPages = 256;  // pages per read, at most 20 MiB

  static Result<TileReader> create(const std::filesystem::path& shader_dir,
                                   gl::ReadbackPool& readback);

  static std::size_t bytes_per_tile(const PagePool& pool);  // size of a tile in the read-back
  // Allocates memory to read up to `pages` pages at a time. This is the only step of a read that
  // can fail, so call it before the pages are changed.
  Result<gl::Readback> make_room(const PagePool& pool, std::size_t pages) const;
  // Starts to read pages, which keep their order. `room` must be large enough.
  void begin(const PagePool& pool, std::span<const PageId> pages, gl::Readback& room);
  static TileData tile(const gl::Readback& readback, const PagePool& pool, std::size_t index);

 private:
  gl::ReadbackPool* readback_ = nullptr;
  ProgramPerWidth programs_;
  gl::Buffer pages_;
};

}  // namespace strata::render
