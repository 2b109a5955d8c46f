#include "gl/fence.h"

#include <utility>

namespace strata::gl {

Fence Fence::place() {
  Fence fence;
  fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
  return fence;
}

Fence::Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}

Fence& Fence::operator=(Fence&& other) noexcept {
  if (this != &other) {
    reset();
    sync_ = std::exchange(other.sync_, nullptr);
  }
  return *this;
}

Fence::~Fence() { reset(); }

void Fence::reset() {
  if (sync_) glDeleteSync(std::exchange(sync_, nullptr));
}

bool Fence::passed(std::uint64_t timeout_ns) {
  if (!sync_) return true;
  if (glClientWaitSync(sync_, 0, timeout_ns) == GL_TIMEOUT_EXPIRED) return false;
  reset();
  return true;
}

}  // namespace strata::gl
