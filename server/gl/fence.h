#pragma once

#include <epoxy/gl.h>

#include <cstdint>

namespace strata::gl {

// Marks a position in the command stream. An empty fence is treated as passed. Move-only.
class Fence {
 public:
  Fence() = default;
  // Places a fence after all commands issued so far, and flushes.
  static Fence place();
  Fence(Fence&& other) noexcept;
  Fence& operator=(Fence&& other) noexcept;
  ~Fence();

  explicit operator bool() const { return sync_ != nullptr; }
  // Waits at most `timeout_ns`. Returns true if the GPU has passed the fence or the context is
  // lost.
  bool passed(std::uint64_t timeout_ns = 0);

 private:
  void reset();
  GLsync sync_ = nullptr;
};

}  // namespace strata::gl
