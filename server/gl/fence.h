#pragma once

#include <epoxy/gl.h>

#include <cstdint>

namespace strata::gl {

// Marks a position in the command stream. Move-only; an empty fence counts as passed.
class Fence {
 public:
  Fence() = default;
  // Placed after every command issued so far, and flushed.
  static Fence place();
  Fence(Fence&& other) noexcept;
  Fence& operator=(Fence&& other) noexcept;
  ~Fence();

  explicit operator bool() const { return sync_ != nullptr; }
  // True after the GPU has passed it; waits at most `timeout_ns`. A lost context counts as passed.
  bool passed(std::uint64_t timeout_ns = 0);

 private:
  void reset();
  GLsync sync_ = nullptr;
};

}  // namespace strata::gl
