#include "net/upload.h"

#include <algorithm>
#include <cstring>
#include <fstream>

#include "core/mapped_file.h"
#include "core/uuid.h"
#include "jobs/import_job.h"

namespace strata::net {
namespace {

namespace fs = std::filesystem;

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

// Folders that the sender names are kept: files of one scan call each other by them. Nothing leads out of them.
std::string relative_filename(std::string_view name) {
  std::string path;
  for (std::string part; !name.empty();) {
    const auto end = std::min(name.find_first_of("/\\"), name.size());
    part = jobs::base_filename(name.substr(0, end));
    const bool names_a_folder = !part.empty() && part != "." && part != ".." && !part.ends_with(':');
    if (names_a_folder) path += (path.empty() ? "" : "/") + part;
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  return path;
}

Result<Upload> keep_part(std::string_view name, std::string_view content, const fs::path& folder) {
  Upload upload{folder / (to_string(random_uuid()) + ".part"), relative_filename(name)};
  std::ofstream out(upload.file, std::ios::binary);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  out.close();
  if (out) return upload;
  std::error_code ignored;
  fs::remove(upload.file, ignored);
  return fail(507, "Disk full", "The upload could not be stored on the server's disk.");
}

Result<void> take_parts(const Request& request, std::string_view body, const fs::path& folder, const char* accepted,
                        std::vector<Upload>& uploads) {
  auto malformed = [] {
    return fail(400, "Malformed form", "The multipart/form-data body does not follow its boundary.", "body");
  };
  const std::string boundary = "--" + parameter(request.header("content-type"), "boundary");
  if (boundary.size() < 3 || boundary.size() > 74) return malformed();
  const std::string separator = "\r\n" + boundary;
  if (!body.starts_with(boundary)) return malformed();
  std::size_t at = boundary.size();
  while (!body.substr(at).starts_with("--")) {
    if (body.substr(at, 2) != "\r\n") return malformed();
    const auto headers_end = find(body, "\r\n\r\n", at);
    if (headers_end == std::string_view::npos || headers_end - at > 8192) return malformed();
    const std::string_view headers = body.substr(at + 2, headers_end - at - 2);
    const auto content_begin = headers_end + 4;
    // The search starts at the blank line's own line break: an empty part ends right there.
    const auto content_end = find(body, separator, content_begin - 2);
    if (content_end == std::string_view::npos) return malformed();
    at = content_end + separator.size();
    const std::string name = parameter(headers, "filename");
    if (name.empty()) continue;  // a field of the form
    if (uploads.size() >= kMostUploadFiles)
      return fail(413, "Too many files",
                  "A form has at most " + std::to_string(kMostUploadFiles) + " files; send them as a zip.", "body");
    auto upload = keep_part(
        name,
        content_end > content_begin ? body.substr(content_begin, content_end - content_begin) : std::string_view(),
        folder);
    if (!upload) return tl::unexpected(upload.error());
    uploads.push_back(std::move(*upload));  // also one that is refused now: the caller removes what there is
    const Upload& last = uploads.back();
    const auto has_its_name = [&](const Upload& other) { return other.filename == last.filename; };
    if (std::any_of(uploads.begin(), uploads.end() - 1, has_its_name))
      return fail(422, "File sent twice", "The form holds two files named " + last.filename + ".", "body");
  }
  if (uploads.empty()) return fail(415, "No file in the form", accepted, "body");
  return {};
}

}  // namespace

Result<std::vector<Upload>> take_upload(const Request& request, const fs::path& folder, const char* accepted) {
  const auto mapped = MappedFile::open(request.body_file);
  if (!mapped || mapped->view().empty()) return fail(400, "Empty body", accepted, "body");
  const std::string type = to_lower(request.header("content-type"));
  std::vector<Upload> uploads;
  if (type.starts_with("multipart/form-data")) {
    if (auto taken = take_parts(request, mapped->view(), folder, accepted, uploads); !taken) {
      std::error_code ignored;
      for (const Upload& upload : uploads) fs::remove(upload.file, ignored);
      return tl::unexpected(taken.error());
    }
    return uploads;
  }
  if (type.starts_with("multipart/")) return fail(415, "Form not understood", accepted, "Content-Type");
  std::string name = jobs::base_filename(parameter(request.header("content-disposition"), "filename"));
  if (name.empty() && type.starts_with("application/zip")) name = "scan.zip";
  uploads.push_back({request.body_file, std::move(name)});
  return uploads;
}

}  // namespace strata::net
