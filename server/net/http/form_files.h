#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata::net {

constexpr std::size_t kMaxFormFiles = 256;

struct FormFile {
  // The sender's file name with its folders. Does not contain folders outside the current one.
  // Empty if nothing remains of the name.
  std::string filename;
  std::string_view content;  // a part of the body
};

// Returns the files of a multipart/form-data body (RFC 7578) in their order. Ignores fields without
// a `filename`. Refuses a body that does not match the boundary in `content_type` (400), more than
// kMaxFormFiles files (413), and two files with the same name (422). Calls `passed` with each
// searched part of the body, which is at most a few megabytes long.
Result<std::vector<FormFile>> files_of_form(
    std::string_view content_type, std::string_view body,
    const std::function<void(std::string_view)>& passed = {});

// Returns the value of `name="…"` or `name=…` after the first semicolon of a header such as
// Content-Disposition. Returns an empty text if it is absent. `name` must be in lower case. A
// backslash is not an escape character because browsers send file names unchanged, with %22 for a
// quotation mark.
std::string header_parameter(std::string_view header, std::string_view name);

}  // namespace strata::net
