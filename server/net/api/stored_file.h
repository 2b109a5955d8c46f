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

// Files that users upload and that the server stores and sends unchanged. They are attachments of
// records and files of tours.

// The properties that the server detects in an uploaded file.
struct InspectedFile {
  std::string name;                  // the file name without folders
  std::string media_type;            // detected from its bytes
  std::optional<int> width, height;  // only for readable images
};
InspectedFile inspect_file(const std::filesystem::path& file, const std::string& name);

// Returns the first bytes of a file. For an image, they contain all metadata before the pixels,
// such as color profiles.
std::vector<std::uint8_t> head_of(const std::filesystem::path& file);

struct StoredFile {
  std::string name, media_type;
  std::string sha256;  // hexadecimal
  std::uint64_t bytes = 0;
  bool in_place = false;  // browsers may display the file instead of downloading it
};

// Returns the response to a GET request. It contains the file, a range of its bytes, or a small
// JPEG of it (`thumbnail` in the query). No file can run scripts in the server's origin. Returns
// unsupported or invalid if no such thumbnail exists.
Result<Response> stored_file_response(const RouteContext& context, const Request& request,
                                      const StoredFile& file);

}  // namespace strata::net
