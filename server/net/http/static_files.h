#pragma once

#include <filesystem>
#include <string_view>

#include "net/http/http_types.h"

namespace strata::net {

std::string_view media_type(const std::filesystem::path& file);

// Serves the files of the web client. Serves only files inside the folder, after following links.
// `/`, `/models/…`, `/projects/…` and `/kiosk/…` are the page itself, which reads the address;
// `/docs` and `/api/v1/docs` are the page of the contract; `/guide/PAGE` is a page of the guide,
// without the extension of its file. Files under /assets/ and /guide/assets/ have a hash in their
// name and never change. A client that accepts it gets `FILE.br` or `FILE.gz` if the build made it.
class StaticFiles {
 public:
  explicit StaticFiles(std::filesystem::path folder);
  Response serve(const Request& request) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace strata::net
