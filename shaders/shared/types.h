#pragma once
// Shared by C++ and GLSL: common type names for the structs of this folder. Structs are laid out so
// that std140, std430 and C++ agree: members of 16 bytes first, then groups of four scalars.
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
