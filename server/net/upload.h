#pragma once

#include <filesystem>
#include <string>

#include "net/http_types.h"

namespace strata::net {

struct Upload {
  std::filesystem::path file;
  std::string filename;  // as the sender calls it, without folders; empty when it did not say
};

// The file in a request whose body is in a file: the body itself, or the one file of a multipart/form-data body (cut out into a
// file of its own in `folder`). Archives and several files are refused with what is accepted.
Result<Upload> take_upload(const Request& request, const std::filesystem::path& folder);

}  // namespace strata::net
