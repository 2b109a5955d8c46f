#include "net/upload.h"

#include <cstring>
#include <fstream>

#include "core/mapped_file.h"
#include "core/uuid.h"
#include "jobs/import_job.h"

namespace strata::net {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAccepted =
    "Send one PLY or OBJ file as the body, or as the only file of a multipart/form-data form.";

// std::string_view::find is too slow for gigabytes; memmem is vectorised.
std::size_t find(std::string_view text, std::string_view what, std::size_t from) {
  if (from > text.size()) return std::string_view::npos;
  const void* found = ::memmem(text.data() + from, text.size() - from, what.data(), what.size());
  return found ? static_cast<std::size_t>(static_cast<const char*>(found) - text.data()) : std::string_view::npos;
}

// Value of `name="…"` or `name=…` in a header such as Content-Disposition.
std::string parameter(std::string_view header, std::string_view name) {
  const std::string lower = to_lower(header);
  for (std::size_t at = lower.find(name); at != std::string::npos; at = lower.find(name, at + 1)) {
    const bool starts = at > 0 && (lower[at - 1] == ';' || lower[at - 1] == ' ');
    std::size_t value = at + name.size();
    if (!starts || value >= header.size() || header[value] != '=') continue;
    ++value;
    if (value < header.size() && header[value] == '"') {
      const auto end = header.find('"', value + 1);
      return std::string(header.substr(value + 1, end == std::string_view::npos ? end : end - value - 1));
    }
    return std::string(header.substr(value, std::min(header.find(';', value), header.size()) - value));
  }
  return {};
}

bool is_archive(std::string_view start) { return start.starts_with("PK\x03\x04") || start.starts_with("PK\x05\x06"); }

tl::unexpected<Problem> archive_refused() {
  return fail(415, "Archives are not taken", std::string("Unpack it first. ") + kAccepted, "body");
}

Result<Upload> take_part(const Request& request, std::string_view body, const fs::path& folder) {
  auto malformed = [] {
    return fail(400, "Malformed form", "The multipart/form-data body does not follow its boundary.", "body");
  };
  const std::string boundary = "--" + parameter(request.header("content-type"), "boundary");
  if (boundary.size() < 3 || boundary.size() > 74) return malformed();
  const std::string separator = "\r\n" + boundary;
  if (!body.starts_with(boundary)) return malformed();
  Upload upload;
  std::string_view content;
  std::size_t at = boundary.size();
  bool found = false;
  while (!body.substr(at).starts_with("--")) {
    if (body.substr(at, 2) != "\r\n") return malformed();
    const auto headers_end = find(body, "\r\n\r\n", at);
    if (headers_end == std::string_view::npos || headers_end - at > 8192) return malformed();
    const std::string_view headers = body.substr(at + 2, headers_end - at - 2);
    const auto content_begin = headers_end + 4;
    // The search starts at the blank line's own line break: an empty part ends right there.
    const auto content_end = find(body, separator, content_begin - 2);
    if (content_end == std::string_view::npos) return malformed();
    const std::string name = parameter(headers, "filename");
    if (!name.empty()) {
      if (found) return fail(415, "More than one file", kAccepted, "body");
      found = true;
      upload.filename = jobs::base_filename(name);
      content =
          content_end > content_begin ? body.substr(content_begin, content_end - content_begin) : std::string_view();
    }
    at = content_end + separator.size();
  }
  if (!found) return fail(415, "No file in the form", kAccepted, "body");
  if (is_archive(content)) return archive_refused();
  upload.file = folder / (to_string(random_uuid()) + ".part");
  std::ofstream out(upload.file, std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (!out) {
    std::error_code ignored;
    fs::remove(upload.file, ignored);
    return fail(507, "Disk full", "The upload could not be stored on the server's disk.");
  }
  return upload;
}

}  // namespace

Result<Upload> take_upload(const Request& request, const fs::path& folder) {
  const auto mapped = MappedFile::open(request.body_file);
  if (!mapped || mapped->view().empty()) return fail(400, "Empty body", kAccepted, "body");
  const std::string type = to_lower(request.header("content-type"));
  if (type.starts_with("multipart/form-data")) return take_part(request, mapped->view(), folder);
  if (type.starts_with("multipart/")) return fail(415, "Form not understood", kAccepted, "Content-Type");
  if (is_archive(mapped->view())) return archive_refused();
  return Upload{request.body_file, jobs::base_filename(parameter(request.header("content-disposition"), "filename"))};
}

}  // namespace strata::net
