#include "gl/debug_messages.h"

#include <epoxy/gl.h>

#include <string>

#include "core/log.h"

namespace strata::gl {
namespace {

void GLAPIENTRY on_message(GLenum, GLenum type, GLuint id, GLenum severity, GLsizei length,
                           const GLchar* message, const void* user) {
  if (type != GL_DEBUG_TYPE_ERROR && type != GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR &&
      severity != GL_DEBUG_SEVERITY_HIGH)
    return;
  // A failed allocation is not a programming error. check_memory reports it to its caller.
  if (id == GL_OUT_OF_MEMORY) return;
  auto* messages = static_cast<DebugMessages*>(const_cast<void*>(user));
  messages->count_error();
  const std::size_t size =
      length < 0 ? std::string_view(message).size() : static_cast<std::size_t>(length);
  log::error("GL: " + std::string(message, size));
}

}  // namespace

void DebugMessages::install() {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(&on_message, this);
}

Result<void> check_memory(std::string_view what, std::size_t bytes) {
  bool out_of_memory = false;
  for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError()) {
    if (error == GL_CONTEXT_LOST) break;
    out_of_memory = out_of_memory || error == GL_OUT_OF_MEMORY;
  }
  if (!out_of_memory) return {};
  return fail(ErrorCode::out_of_memory, "GPU out of memory",
              "The graphics driver could not allocate memory for '" + std::string(what) + "' (" +
                  std::to_string(bytes >> 20) +
                  " MiB). Close models or layers, or lower --gpu-memory.");
}

}  // namespace strata::gl
