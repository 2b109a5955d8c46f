#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata::net {

constexpr std::size_t kMaxFormFiles = 256;

struct FormFile {
  // As the sender calls it, with the folders it names, but none that leads out of them; empty where
  // nothing else is left.
  std::string filename;
  std::string_view content;  // within the body
};

// The files of a multipart/form-data body (RFC 7578) in their order; its other fields, without a
// `filename`, are passed over. Refused: a body that does not follow the boundary of `content_type`
// (400), more than kMaxFormFiles files (413), two files of one name (422). `passed` is told each
// part of the body, of some megabytes at most, that was looked through.
Result<std::vector<FormFile>> files_of_form(
    std::string_view content_type, std::string_view body,
    const std::function<void(std::string_view)>& passed = {});

// Value of `name="…"` or `name=…` behind the first semicolon of a header such as
// Content-Disposition; empty when it is not there. `name` is in lower case. A backslash is no
// escape: browsers send names of files as they are, with %22 for a quote.
std::string header_parameter(std::string_view header, std::string_view name);

}  // namespace strata::net
