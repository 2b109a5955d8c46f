#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "net/http/http_types.h"

namespace strata::net {

struct Upload {
  std::filesystem::path file;
  // as the sender calls it, with the folders it names; empty when it did not say
  std::string filename;
};

constexpr const char* kScanUpload =
    "Send the scan as the body (PLY, OBJ, STL, glTF, GLB, or a zip of one scan with its textures), or the mesh and its "
    "material and picture files together in a multipart/form-data form.";

// The files in a request whose body is in a file: the body itself, or those of a
// multipart/form-data body (net/http/form_files; each cut out into a file of its own in `folder`;
// none is left there after an Error). `accepted` is what a body without a file is told to be.
Result<std::vector<Upload>> take_upload(const Request& request, const std::filesystem::path& folder,
                                        const char* accepted = kScanUpload);

}  // namespace strata::net
