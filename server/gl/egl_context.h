#pragma once

#include <epoxy/egl.h>

#include <string>

#include "core/error.h"

namespace strata::gl {

struct EglOptions {
  bool debug = false;  // KHR_debug context
};

// A GL 4.5 core context without any window, current on the thread that created it until destroyed
// there. A hardware device is taken where EGL offers one; then Mesa's surfaceless platform; then
// any device (software). Robust access and reset notification are asked for where they are offered.
// Move-only.
class EglContext {
 public:
  // The error lists every platform that was tried and why it failed.
  static Result<EglContext> create(const EglOptions& options);

  EglContext() = default;
  EglContext(EglContext&& other) noexcept;
  EglContext& operator=(EglContext&& other) noexcept;
  ~EglContext();

  explicit operator bool() const { return context_ != EGL_NO_CONTEXT; }
  const std::string& platform() const { return platform_; }
  // True from a reset of the device on: every GL object is gone.
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
