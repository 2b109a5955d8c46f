#pragma once

#include <epoxy/egl.h>

#include <string>

#include "core/error.h"

namespace strata::gl {

struct EglOptions {
  bool debug = false;  // KHR_debug context
};

// A GL 4.5 core context without a window, current on the thread that creates it, which must also
// destroy it. Uses a hardware device if EGL offers one; then Mesa's surfaceless platform; then any
// device (software). Robust access and reset notification are requested if available. Move-only.
class EglContext {
 public:
  // The error lists every platform tried and the reason of its failure.
  static Result<EglContext> create(const EglOptions& options);

  EglContext() = default;
  EglContext(EglContext&& other) noexcept;
  EglContext& operator=(EglContext&& other) noexcept;
  ~EglContext();

  explicit operator bool() const { return context_ != EGL_NO_CONTEXT; }
  const std::string& platform() const { return platform_; }
  // True after a reset of the device: all GL objects are lost.
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
