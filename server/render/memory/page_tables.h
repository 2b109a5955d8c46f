#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "gl/buffer.h"
#include "render/memory/gpu_memory.h"
#include "render/memory/page_pool.h"

namespace strata::render {

// The page tables of all layers in one storage buffer, so a dispatch over many layers binds only
// one buffer. An entry is a page id or kNoPage. Changes stay on the CPU until `flush`.
class PageTables {
 public:
  explicit PageTables(GpuMemory& memory) : memory_(memory) {}

  // Allocates `count` entries with the value kNoPage. Returns the index of the first one.
  Result<std::uint32_t> allocate(std::uint32_t count);
  void free(std::uint32_t offset, std::uint32_t count);
  PageId at(std::uint32_t index) const { return entries_[index]; }
  void set(std::uint32_t index, PageId page);
  // Uploads the changes. Returns the Error `out_of_memory` if the buffer cannot grow.
  Result<void> flush();
  void bind(GLuint binding) const { buffer_.bind_storage(binding); }

 private:
  GpuMemory& memory_;
  std::vector<PageId> entries_;
  std::multimap<std::uint32_t, std::uint32_t> free_;  // count → offset
  std::vector<std::uint32_t> changed_;
  gl::Buffer buffer_;
  GpuMemory::Share share_;
};

}  // namespace strata::render
