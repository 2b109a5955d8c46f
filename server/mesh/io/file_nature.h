#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "mesh/io/input_files.h"

namespace strata::mesh {

// For a file that could not be read as `kind`: its format by its first bytes and advice, as
// sentences for a person. Recognizes archives, pictures, web pages in place of a download, and
// meshes with the ending of another format. Nothing for an unknown format, or for `kind` itself.
std::optional<std::string> other_nature(std::span<const std::uint8_t> bytes, InputKind kind);

}  // namespace strata::mesh
