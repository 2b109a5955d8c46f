#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "gl/readback.h"
#include "render/memory/page_pool.h"
#include "render/memory/texel_width.h"

namespace strata::render {

// Packs pages for read-back in one dispatch a chunk (shaders/tile_read_pass.comp).
class TileReader {
 public:
  static constexpr std::size_t kMaxPages = 256;  // a read, ≤ 20 MiB

  static Result<TileReader> create(const std::filesystem::path& shader_dir,
                                   gl::ReadbackPool& readback);

  static std::size_t bytes_per_tile(const PagePool& pool);  // as it comes back
  // Room for reading up to `pages` pages at a time: what can fail of a read, so that it can be had
  // before what is read is changed.
  Result<gl::Readback> make_room(const PagePool& pool, std::size_t pages) const;
  // Starts reading pages, which come back in the order given. `room` must hold them.
  void begin(const PagePool& pool, std::span<const PageId> pages, gl::Readback& room);
  static TileData tile(const gl::Readback& readback, const PagePool& pool, std::size_t index);

 private:
  gl::ReadbackPool* readback_ = nullptr;
  ProgramPerWidth programs_;
  gl::Buffer pages_;
};

}  // namespace strata::render
