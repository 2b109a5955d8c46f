#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <vector>

#include "gl/program.h"
#include "gl/readback.h"
#include "render/page_pool.h"
#include "render/stream_buffer.h"

namespace strata::render {

// Packs pages for read-back in one dispatch a chunk (shaders/tile_read_pass.comp).
class TileReader {
 public:
  static constexpr std::size_t kMaxPages = 256;  // a read, ≤ 20 MiB

  static Result<TileReader> create(const std::filesystem::path& shader_dir, gl::ReadbackPool& readback);

  // Starts reading up to kMaxPages pages; they come back in the order given.
  Result<gl::Readback> begin(const PagePool& pool, std::span<const PageId> pages);
  static TileData tile(const gl::Readback& readback, const PagePool& pool, std::size_t index);

 private:
  gl::ReadbackPool* readback_ = nullptr;
  std::array<gl::Program, 3> programs_;
  StreamBuffer pages_{"tile read pages"};
};

}  // namespace strata::render
