#pragma once

#include "core/memory_ledger.h"

namespace strata::render {

// The budget of GPU memory. `reserve` is called on the GPU thread. It may evict data that can be
// restored: empty pages, depth buffers, layers with a mirror, and the buffers of views.
class GpuMemory : public MemoryLedger {
 public:
  explicit GpuMemory(std::uint64_t budget_bytes)
      : MemoryLedger("GPU memory", "--gpu-memory", budget_bytes) {}
};

}  // namespace strata::render
