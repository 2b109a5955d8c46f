#include "gl/egl_context.h"

#include <epoxy/gl.h>

#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace strata::gl {
namespace {

struct Candidate {
  EGLDisplay display;
  std::string name;
};

bool has_extension(const char* list, std::string_view name) {
  if (!list) return false;
  const std::string padded = " " + std::string(list) + " ";
  return padded.find(" " + std::string(name) + " ") != std::string::npos;
}

// Calls the EXT function, because libepoxy cannot resolve the core function before a display
// exists.
EGLDisplay platform_display(EGLenum platform, void* native) {
  return eglGetPlatformDisplayEXT(platform, native, nullptr);
}

std::vector<EGLDeviceEXT> query_devices(const char* client_extensions) {
  if (!has_extension(client_extensions, "EGL_EXT_platform_device") ||
      (!has_extension(client_extensions, "EGL_EXT_device_enumeration") &&
       !has_extension(client_extensions, "EGL_EXT_device_base"))) {
    return {};
  }
  std::array<EGLDeviceEXT, 32> devices{};
  EGLint count = 0;
  if (!eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count)) return {};
  return {devices.begin(), devices.begin() + count};
}

bool is_software(EGLDeviceEXT device) {
  return has_extension(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
}

std::vector<Candidate> candidates() {
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const auto devices = query_devices(extensions);
  std::vector<Candidate> found;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (is_software(devices[i])) continue;
    found.push_back({platform_display(EGL_PLATFORM_DEVICE_EXT, devices[i]),
                     "hardware device " + std::to_string(i)});
  }
  if (has_extension(extensions, "EGL_MESA_platform_surfaceless")) {
    found.push_back(
        {platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY), "surfaceless"});
  }
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (!is_software(devices[i])) continue;
    found.push_back({platform_display(EGL_PLATFORM_DEVICE_EXT, devices[i]),
                     "software device " + std::to_string(i)});
  }
  return found;
}

std::string hex(EGLint error) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "0x%04x", static_cast<unsigned>(error));
  return text.data();
}

EGLContext create_context(EGLDisplay display, const EglOptions& options, bool robust) {
  // A context without surfaces needs no configuration if the display supports such contexts.
  EGLConfig config = EGL_NO_CONFIG_KHR;
  if (!has_extension(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_no_config_context")) {
    const std::array<EGLint, 5> config_attributes{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                                  EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_NONE};
    EGLint count = 0;
    if (!eglChooseConfig(display, config_attributes.data(), &config, 1, &count) || count == 0)
      return EGL_NO_CONTEXT;
  }
  std::vector<EGLint> attributes{
      EGL_CONTEXT_MAJOR_VERSION,       4,
      EGL_CONTEXT_MINOR_VERSION,       5,
      EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
  if (options.debug) attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE});
  if (robust) {
    attributes.insert(attributes.end(),
                      {EGL_CONTEXT_OPENGL_ROBUST_ACCESS, EGL_TRUE,
                       EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
  }
  attributes.push_back(EGL_NONE);
  return eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
}

}  // namespace

Result<EglContext> EglContext::create(const EglOptions& options) {
  std::string tried;
  for (const Candidate& candidate : candidates()) {
    const auto refuse = [&](const char* call) {
      tried += (tried.empty() ? "" : "; ") + candidate.name + ": " + call + " failed with " +
               hex(eglGetError());
    };
    EGLint major = 0, minor = 0;
    if (candidate.display == EGL_NO_DISPLAY || !eglInitialize(candidate.display, &major, &minor)) {
      refuse("eglInitialize");
      continue;
    }
    if (!eglBindAPI(EGL_OPENGL_API)) {
      refuse("eglBindAPI(OpenGL)");
      continue;
    }
    EglContext context;
    context.display_ = candidate.display;
    context.platform_ = candidate.name;
    context.context_ = create_context(candidate.display, options, true);
    context.robust_ = context.context_ != EGL_NO_CONTEXT;
    if (!context.robust_) context.context_ = create_context(candidate.display, options, false);
    if (context.context_ == EGL_NO_CONTEXT) {
      refuse("eglCreateContext(OpenGL 4.5 core)");
      continue;
    }
    if (!eglMakeCurrent(candidate.display, EGL_NO_SURFACE, EGL_NO_SURFACE, context.context_)) {
      refuse("eglMakeCurrent without a surface");
      continue;
    }
    return context;
  }
  return fail(
      ErrorCode::unavailable, "No GPU context",
      "The server could not create an OpenGL 4.5 context. It tried: " +
          (tried.empty() ? "no EGL platform was found" : tried) +
          ". Install a driver (Debian: libegl1 libegl-mesa0 libgl1-mesa-dri), and give this user "
          "access to /dev/dri/renderD* or /dev/nvidia*.");
}

EglContext::EglContext(EglContext&& other) noexcept
    : display_(other.display_),
      context_(std::exchange(other.context_, EGL_NO_CONTEXT)),
      platform_(std::move(other.platform_)),
      robust_(other.robust_),
      lost_(other.lost_) {}

EglContext& EglContext::operator=(EglContext&& other) noexcept {
  if (this != &other) {
    destroy();
    display_ = other.display_;
    context_ = std::exchange(other.context_, EGL_NO_CONTEXT);
    platform_ = std::move(other.platform_);
    robust_ = other.robust_;
    lost_ = other.lost_;
  }
  return *this;
}

EglContext::~EglContext() { destroy(); }

// Does not terminate the display, because all contexts of the process share it.
void EglContext::destroy() {
  if (context_ == EGL_NO_CONTEXT) return;
  if (eglGetCurrentContext() == context_)
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, std::exchange(context_, EGL_NO_CONTEXT));
}

// Keeps the result, because GL may report a reset only once.
bool EglContext::lost() {
  lost_ = lost_ || (robust_ && glGetGraphicsResetStatus() != GL_NO_ERROR);
  return lost_;
}

}  // namespace strata::gl
