#include "net/http/form_files.h"

#include <algorithm>
#include <cstring>

#include "core/text/ascii.h"
#include "core/text/filename.h"
#include "net/http/http_types.h"

namespace strata::net {
namespace {

constexpr std::size_t kMaxBoundaryLength = 70;  // maximum of RFC 2046
constexpr std::size_t kMaxPartHead = 8192;

constexpr std::size_t kWindowBytes = 4u << 20;

// Uses memmem, which is vectorized, because std::string_view::find is too slow for gigabytes. Calls
// `passed` with the searched part, window by window.
std::size_t find(std::string_view text, std::string_view what, std::size_t from,
                 const std::function<void(std::string_view)>& passed) {
  while (from < text.size()) {
    const std::string_view window = text.substr(from, kWindowBytes + what.size() - 1);
    const void* found = ::memmem(window.data(), window.size(), what.data(), what.size());
    if (found) return static_cast<std::size_t>(static_cast<const char*>(found) - text.data());
    if (passed) passed(window);
    from += kWindowBytes;
  }
  return std::string_view::npos;
}

// Returns the value of a header from the head of a part. Returns an empty text if it is absent.
std::string_view header_of(std::string_view head, std::string_view name) {
  while (!head.empty()) {
    const auto end = std::min(head.find("\r\n"), head.size());
    const std::string_view line = head.substr(0, end);
    head.remove_prefix(std::min(end + 2, head.size()));
    const auto colon = line.find(':');
    if (colon != std::string_view::npos && to_lower(trimmed(line.substr(0, colon))) == name)
      return trimmed(line.substr(colon + 1));
  }
  return {};
}

}  // namespace

std::string header_parameter(std::string_view header, std::string_view name) {
  for (;;) {
    const auto semicolon = header.find(';');
    if (semicolon == std::string_view::npos) return {};
    header.remove_prefix(semicolon + 1);
    const auto key_end = header.find_first_of("=;");
    if (key_end == std::string_view::npos) return {};
    const std::string key = to_lower(trimmed(header.substr(0, key_end)));
    header.remove_prefix(key_end);
    if (header.front() == ';') continue;
    header = header.substr(std::min(header.find_first_not_of(" \t", 1), header.size()));
    std::string_view value = trimmed(header.substr(0, header.find(';')));
    if (header.starts_with('"')) {
      const auto close = std::min(header.find('"', 1), header.size());
      value = header.substr(1, close - 1);
      header.remove_prefix(close);
    }
    if (key == name) return std::string(value);
  }
}

Result<std::vector<FormFile>> files_of_form(std::string_view content_type, std::string_view body,
                                            const std::function<void(std::string_view)>& passed) {
  const auto malformed = [] {
    return fail(ErrorCode::malformed, "Malformed form",
                "The multipart/form-data body does not match its boundary.", "body");
  };
  const std::string boundary = header_parameter(content_type, "boundary");
  if (boundary.empty() || boundary.size() > kMaxBoundaryLength) return malformed();
  const std::string separator = "\r\n--" + boundary;
  if (!body.starts_with(separator.substr(2))) return malformed();
  std::vector<FormFile> files;
  std::size_t at = separator.size() - 2;
  while (!body.substr(at).starts_with("--")) {
    if (body.substr(at, 2) != "\r\n") return malformed();
    // Both searches start at the preceding line break because the head or the content may be empty.
    const auto head_end = find(body, "\r\n\r\n", at, passed);
    if (head_end == std::string_view::npos || head_end - at > kMaxPartHead) return malformed();
    const auto content_begin = head_end + 4;
    const auto content_end = find(body, separator, content_begin - 2, passed);
    if (content_end == std::string_view::npos) return malformed();
    const std::string_view head = body.substr(at, head_end - at);
    at = content_end + separator.size();
    const std::string name = header_parameter(header_of(head, "content-disposition"), "filename");
    if (name.empty()) continue;  // the field contains no file
    if (files.size() >= kMaxFormFiles)
      return fail(ErrorCode::too_large, "Too many files",
                  "A form can have at most " + std::to_string(kMaxFormFiles) +
                      " files. Send the files as a zip file.",
                  "body");
    // For an empty content, content_end is less than content_begin because the separator shares its
    // line break with the blank line.
    FormFile file{relative_filename(name),
                  body.substr(content_begin, std::max(content_end, content_begin) - content_begin)};
    if (std::any_of(files.begin(), files.end(),
                    [&](const auto& other) { return other.filename == file.filename; }))
      return fail(ErrorCode::invalid, "Duplicate file",
                  "The form contains two files with the name " + file.filename + ".", "body");
    files.push_back(std::move(file));
  }
  return files;
}

}  // namespace strata::net
