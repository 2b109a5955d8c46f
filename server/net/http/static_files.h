#pragma once

#include <filesystem>
#include <string_view>

#include "net/http/http_types.h"

namespace strata::net {

std::string_view media_type(const std::filesystem::path& file);

// The page's files. Only files inside the folder are served, links included; `/`, `/models/…`,
// `/projects/…` and `/kiosk/…` are the page itself, which finds its way by the address; `/docs` and
// `/api/v1/docs` are the page of the contract. Files under /assets/ carry a hash in their name and
// never change. Where the build has left `FILE.br` and `FILE.gz`, a client that takes them gets
// these.
class StaticFiles {
 public:
  explicit StaticFiles(std::filesystem::path folder);
  Response serve(const Request& request) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace strata::net
