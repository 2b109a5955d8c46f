#pragma once

#include <filesystem>
#include <string_view>

#include "net/http/http_types.h"

namespace strata::net {

std::string_view media_type(const std::filesystem::path& file);

// Serves the files of the web client. Serves only files inside the folder, also after following
// links. `/`, `/models/…`, `/projects/…` and `/kiosk/…` return the page of the application, which
// evaluates the address. `/docs` and `/api/v1/docs` return the documentation of the API.
// `/guide/PAGE` returns a page of the guide. Its address has no file extension. The names of files
// under /assets/ and /guide/assets/ contain a hash, so these files never change. Sends `FILE.br` or
// `FILE.gz` if it exists and the client accepts it.
class StaticFiles {
 public:
  explicit StaticFiles(std::filesystem::path folder);
  Response serve(const Request& request) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace strata::net
