#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "net/http/http_types.h"

namespace strata::net {

struct RouteContext;

// Files that people upload and that the server stores and sends unchanged: attachments of records,
// and files of tours.

// What the server finds out about an uploaded file.
struct InspectedFile {
  std::string name;                  // a file name without folders
  std::string media_type;            // determined from its bytes
  std::optional<int> width, height;  // of readable pictures
};
InspectedFile inspect_file(const std::filesystem::path& file, const std::string& name);

// The first bytes: they hold all metadata before a picture's pixels, such as color profiles.
std::vector<std::uint8_t> head_of(const std::filesystem::path& file);

struct StoredFile {
  std::string name, media_type;
  std::string sha256;  // hexadecimal
  std::uint64_t bytes = 0;
  bool in_place = false;  // browsers may show it, instead of offering a download
};

// Answers a GET: the file, a range of its bytes, or (`thumbnail` in the query) a small JPEG of it.
// No file can run scripts in the server's origin. unsupported, invalid: there is no such thumbnail.
Result<Response> stored_file_response(const RouteContext& context, const Request& request,
                                      const StoredFile& file);

}  // namespace strata::net
