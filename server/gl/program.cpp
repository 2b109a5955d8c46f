#include "gl/program.h"

#include "gl/shader_source.h"

namespace strata::gl {
namespace {

constexpr const char* kTitle = "Shader cannot be built";

struct ShaderTraits {
  static constexpr GLenum kIdentifier = GL_SHADER;
  static void destroy(GLuint id) { glDeleteShader(id); }
};
using Shader = Object<ShaderTraits>;

GLenum stage_of(const std::filesystem::path& file) {
  if (file.extension() == ".vert") return GL_VERTEX_SHADER;
  if (file.extension() == ".frag") return GL_FRAGMENT_SHADER;
  if (file.extension() == ".comp") return GL_COMPUTE_SHADER;
  return GL_NONE;
}

template <class Get, class Log>
std::string log_of(GLuint id, Get get, Log log) {
  GLint length = 0;
  get(id, GL_INFO_LOG_LENGTH, &length);
  std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
  log(id, length, nullptr, text.data());
  return text;
}

Result<Shader> compile(const std::filesystem::path& directory, const std::string& file,
                       const std::vector<std::string>& defines) {
  const GLenum stage = stage_of(file);
  if (stage == GL_NONE)
    return fail(ErrorCode::internal, kTitle,
                file + ": the file name must end in .vert, .frag or .comp.");
  auto text = STRATA_TRY(load_shader(directory, file, defines));
  Shader shader(glCreateShader(stage));
  const char* source = text.c_str();
  glShaderSource(shader.id(), 1, &source, nullptr);
  glCompileShader(shader.id());
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
  if (!compiled)
    return fail(ErrorCode::internal, kTitle,
                file + ": " + log_of(shader.id(), glGetShaderiv, glGetShaderInfoLog));
  shader.label(file);
  return shader;
}

}  // namespace

Result<Program> Program::load(const std::filesystem::path& directory,
                              const std::vector<std::string>& files,
                              const std::vector<std::string>& defines) {
  Program program;
  program.object_ = Object<Traits>(glCreateProgram());
  std::vector<Shader> shaders;
  std::string name;
  for (const std::string& file : files) {
    auto shader = STRATA_TRY(compile(directory, file, defines));
    glAttachShader(program.id(), shader.id());
    shaders.push_back(std::move(shader));
    name += (name.empty() ? "" : "+") + file;
  }
  glLinkProgram(program.id());
  GLint linked = GL_FALSE;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
  if (!linked)
    return fail(ErrorCode::internal, kTitle,
                name + ": " + log_of(program.id(), glGetProgramiv, glGetProgramInfoLog));
  for (const Shader& shader : shaders) glDetachShader(program.id(), shader.id());
  program.object_.label(name);
  return program;
}

}  // namespace strata::gl
