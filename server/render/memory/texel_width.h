#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "gl/program.h"

namespace strata::render {

// Values are stored as bits in pools with 1, 2 and 4 bytes per texel. Each program that reads or
// writes values is built for each width.

// Return the GL names for a texel width.
GLenum texel_format(int texel_bytes);
GLenum texel_component(int texel_bytes);

// The programs of one shader file, one for each width.
class ProgramPerWidth {
 public:
  // `define_of` returns the preprocessor definition for a width. All programs get `others`.
  template <class DefineOf>
  static Result<ProgramPerWidth> load(const std::filesystem::path& shader_dir,
                                      const std::string& file, DefineOf define_of,
                                      const std::vector<std::string>& others = {}) {
    ProgramPerWidth programs;
    for (const int texel_bytes : {1, 2, 4}) {
      std::vector<std::string> defines = others;
      defines.push_back(define_of(texel_bytes));
      auto program = STRATA_TRY(gl::Program::load(shader_dir, {file}, defines));
      programs.programs_[index(texel_bytes)] = std::move(program);
    }
    return programs;
  }
  const gl::Program& of(int texel_bytes) const { return programs_[index(texel_bytes)]; }

 private:
  static std::size_t index(int texel_bytes) { return static_cast<std::size_t>(texel_bytes) / 2; }
  std::array<gl::Program, 3> programs_;
};

}  // namespace strata::render
