#pragma once

#include <epoxy/egl.h>

#include <string>

#include "core/error.h"

namespace strata::gl {

struct EglOptions {
  bool debug = false;  // whether to create a KHR_debug context
};

// A GL 4.5 core context without a window. It is current on the thread that creates it, and the same
// thread must destroy it. Tries hardware devices first, then Mesa's surfaceless platform, and then
// software devices. Requests robust access and reset notification if they are available. Move-only.
class EglContext {
 public:
  // The Error lists each tried platform and the reason for its failure.
  static Result<EglContext> create(const EglOptions& options);

  EglContext() = default;
  EglContext(EglContext&& other) noexcept;
  EglContext& operator=(EglContext&& other) noexcept;
  ~EglContext();

  explicit operator bool() const { return context_ != EGL_NO_CONTEXT; }
  const std::string& platform() const { return platform_; }
  // Returns true after a reset of the device, when all GL objects are lost.
  bool lost();

 private:
  void destroy();

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  std::string platform_;
  bool robust_ = false;
  bool lost_ = false;
};

}  // namespace strata::gl
