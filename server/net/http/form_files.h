#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata::net {

constexpr std::size_t kMaxFormFiles = 256;

struct FormFile {
  // The sender's name, with its folders except those that lead out of the current one; empty if
  // nothing else remains.
  std::string filename;
  std::string_view content;  // within the body
};

// Returns the files of a multipart/form-data body (RFC 7578) in their order; ignores fields without
// a `filename`. Refuses a body that does not follow the boundary of `content_type` (400), more than
// kMaxFormFiles files (413) and two files with one name (422). Calls `passed` with each searched
// part of the body, some megabytes at most.
Result<std::vector<FormFile>> files_of_form(
    std::string_view content_type, std::string_view body,
    const std::function<void(std::string_view)>& passed = {});

// Returns the value of `name="…"` or `name=…` after the first semicolon of a header such as
// Content-Disposition; empty if it is absent. `name` is in lower case. A backslash is not an
// escape: browsers send file names unchanged, with %22 for a quote.
std::string header_parameter(std::string_view header, std::string_view name);

}  // namespace strata::net
