#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "mesh/io/input_files.h"

namespace strata::mesh {

// Describes a file that could not be read as `kind`. Returns its format, as determined from its
// first bytes, and advice for the user, as sentences. Recognizes archives, images, web pages saved
// instead of a download, and meshes with the extension of another format. Returns nothing for an
// unknown format or for `kind` itself.
std::optional<std::string> other_nature(std::span<const std::uint8_t> bytes, InputKind kind);

}  // namespace strata::mesh
