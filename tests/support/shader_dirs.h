#pragma once

#include <cstdlib>
#include <filesystem>

#include "strata_dirs.h"

namespace strata::test {

// Returns the folder of the shaders for tests and benchmarks: in the source tree, or in a bundle
// (STRATA_SHADERS, STRATA_PEER_SHADERS). With a bundle, the same programs run on a machine that has
// only a driver.
inline std::filesystem::path shader_dir() {
  const char* bundled = std::getenv("STRATA_SHADERS");
  return bundled ? bundled : STRATA_SHADER_DIR;
}

inline std::filesystem::path peer_shader_dir() {
  const char* bundled = std::getenv("STRATA_PEER_SHADERS");
  return bundled ? bundled : STRATA_SOURCE_DIR "/tests/bench/peers/shaders";
}

}  // namespace strata::test
