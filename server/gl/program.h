#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "gl/object.h"

namespace strata::gl {

// A linked program from shader files. The extension of a file determines its stage (.vert,
// .frag, .comp). Move-only.
class Program {
 public:
  Program() = default;
  // The Error contains the file name and the message of the compiler.
  static Result<Program> load(const std::filesystem::path& directory,
                              const std::vector<std::string>& files,
                              const std::vector<std::string>& defines = {});

  GLuint id() const { return object_.id(); }
  explicit operator bool() const { return static_cast<bool>(object_); }
  void use() const { glUseProgram(id()); }
  void set(GLint location, GLuint value) const { glProgramUniform1ui(id(), location, value); }
  void set(GLint location, GLint x, GLint y) const { glProgramUniform2i(id(), location, x, y); }

 private:
  struct Traits {
    static constexpr GLenum kIdentifier = GL_PROGRAM;
    static void destroy(GLuint id) { glDeleteProgram(id); }
  };
  Object<Traits> object_;
};

}  // namespace strata::gl
