#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "mesh/io/input_files.h"

namespace strata::mesh {

// What a file that could not be read as `kind` is by its first bytes, with what to do about it, as
// sentences for a person: archives, pictures, web pages in place of a download, meshes under
// another ending. Nothing: not known, or of that kind.
std::optional<std::string> other_nature(std::span<const std::uint8_t> bytes, InputKind kind);

}  // namespace strata::mesh
