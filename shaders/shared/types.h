#pragma once
// Common type names for the structs in this folder, which C++ and GLSL share. The structs have the
// same layout in std140, std430 and C++: members of 16 bytes first, then groups of four scalars.
#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace strata::shader {
using uint = std::uint32_t;
using glm::mat4;
using glm::vec4;
}  // namespace strata::shader
#define STRATA_SHARED_BEGIN namespace strata::shader {
#define STRATA_SHARED_END }
#else
#define STRATA_SHARED_BEGIN
#define STRATA_SHARED_END
#endif
