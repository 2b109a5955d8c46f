// Fuzzes a multipart form. The first line is the Content-Type, the rest is the body.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/text/utf8.h"
#include "net/http/form_files.h"

namespace {

using strata::net::FormFile;

void demand(bool holds) {
  if (!holds) std::abort();
}

void check_filename(std::string_view name) {
  demand(strata::is_utf8(name) && !name.starts_with('/') &&
         name.find('\\') == std::string_view::npos);
  for (std::size_t begin = 0; begin < name.size();) {
    const auto end = std::min(name.find('/', begin), name.size());
    const auto part = name.substr(begin, end - begin);
    demand(!part.empty() && part != "." && part != "..");
    begin = end + 1;
  }
}

// Checks that a new form with the same files is read unchanged.
void check_again(const std::vector<FormFile>& files) {
  static constexpr std::string_view kBoundary = "--a boundary that no content holds";
  std::string body;
  for (const auto& file : files) {
    const bool can_be_sent = !file.filename.empty() &&
                             file.filename.find('"') == std::string::npos &&
                             file.content.find(kBoundary) == std::string_view::npos;
    if (!can_be_sent) return;
    body.append(kBoundary).append("\r\nContent-Disposition: form-data; name=\"f\"; filename=\"");
    body.append(file.filename).append("\"\r\n\r\n").append(file.content).append("\r\n");
  }
  body.append(kBoundary).append("--\r\n");
  const auto again = strata::net::files_of_form(
      "multipart/form-data; boundary=\"" + std::string(kBoundary.substr(2)) + "\"", body);
  demand(again.has_value() && again->size() == files.size());
  for (std::size_t i = 0; i < files.size(); ++i)
    demand((*again)[i].filename == files[i].filename && (*again)[i].content == files[i].content);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto line_end = std::min(text.find('\n'), text.size());
  const std::string_view type = text.substr(0, line_end),
                         body = text.substr(std::min(line_end + 1, size));
  const auto files = strata::net::files_of_form(type, body);
  if (!files) {
    demand(!is_server_failure(files.error().code));
    return 0;
  }
  demand(files->size() <= strata::net::kMaxFormFiles);
  const std::string separator = "\r\n--" + strata::net::header_parameter(type, "boundary");
  for (const auto& file : *files) {
    check_filename(file.filename);
    demand(file.content.data() >= body.data() &&
           file.content.data() + file.content.size() <= body.data() + body.size());
    demand(file.content.find(separator) == std::string_view::npos);
  }
  check_again(*files);
  return 0;
}
