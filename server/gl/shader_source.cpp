#include "gl/shader_source.h"

#include <fstream>
#include <set>
#include <sstream>

namespace strata::gl {
namespace {

constexpr const char* kTitle = "Shader cannot be built";

// Appends the text of `file`, and replaces each include by the included file. `#line` directives
// keep the line numbers of the files.
Result<void> append(const std::filesystem::path& directory, const std::string& file,
                    std::set<std::string>& seen, std::string& text) {
  if (file.find("..") != std::string::npos)
    return fail(ErrorCode::internal, kTitle, "'" + file + "' is outside the shader folder.");
  std::ifstream stream(directory / file);
  if (!stream) {
    return fail(ErrorCode::internal, kTitle,
                "'" + (directory / file).string() +
                    "' cannot be read. Check the path of the shader folder.");
  }
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    constexpr std::string_view kInclude = "#include \"";
    if (!line.starts_with(kInclude)) {
      // Removes the pragma, which is for C++. Each file is included only once even without it.
      text += line.starts_with("#pragma once") ? "\n" : line + "\n";
      continue;
    }
    const auto end = line.find('"', kInclude.size());
    if (end == std::string::npos)
      return fail(ErrorCode::internal, kTitle,
                  file + ": unfinished #include in line " + std::to_string(number));
    const std::string name = line.substr(kInclude.size(), end - kInclude.size());
    if (seen.insert(name).second) {
      text += "#line 1 " + std::to_string(seen.size()) + "\n";
      STRATA_TRY(append(directory, name, seen, text));
    }
    text += "#line " + std::to_string(number + 1) + " 0\n";
  }
  return {};
}

}  // namespace

Result<std::string> load_shader(const std::filesystem::path& directory, const std::string& file,
                                const std::vector<std::string>& defines) {
  std::string text;
  std::set<std::string> seen;
  STRATA_TRY(append(directory, file, seen, text));
  if (!text.starts_with("#version"))
    return fail(ErrorCode::internal, kTitle, file + ": the first line must be #version.");
  std::string head;
  for (const std::string& define : defines) head += "#define " + define + "\n";
  const auto after_version = text.find('\n') + 1;
  text.insert(after_version, head + "#line 2 0\n");
  return text;
}

}  // namespace strata::gl
