#include "net/http/static_files.h"

#include <algorithm>
#include <map>

#include "net/http/compression.h"
#include "net/http/entity_tags.h"

namespace strata::net {
namespace {

namespace fs = std::filesystem;

// Returns the document that evaluates the address in the browser. Returns an empty text if there is
// no such document.
std::string_view document_of(const Request& request) {
  if (request.path == "/") return "index.html";
  if (request.path == "/docs" || request.path == "/api/v1/docs") return "docs.html";
  const std::string& first = request.segments.front();
  const bool is_app =
      first == "models" || first == "projects" || first == "join" || first == "kiosk";
  return is_app ? "index.html" : "";
}

// Returns the file of a page of the guide. Its address is the path of the file without the
// extension.
fs::path guide_page(const fs::path& address) {
  fs::path page = address;
  page += ".html";
  std::error_code error;
  return fs::is_regular_file(page, error) ? page : address / "index.html";
}

bool is_safe(const std::string& segment) {
  return segment != "." && segment != ".." && segment.find_first_of("/\\") == std::string::npos &&
         !segment.starts_with('.');
}

bool is_inside(const fs::path& file, const fs::path& folder) {
  auto [end_of_folder, at] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end_of_folder == folder.end() && at != file.end();
}

// Uses the size and the modification time to identify a version because a build replaces whole
// files.
std::string etag_of(const fs::path& file) {
  std::error_code error;
  const auto size = fs::file_size(file, error);
  const auto time = fs::last_write_time(file, error).time_since_epoch().count();
  return "\"" + std::to_string(size) + "-" + std::to_string(time) + "\"";
}

fs::path coded(const fs::path& file, Coding coding) {
  return file.string() + (coding == Coding::gzip ? ".gz" : ".br");
}

}  // namespace

std::string_view media_type(const fs::path& file) {
  static const std::map<std::string, std::string_view, std::less<>> types = {
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".webmanifest", "application/manifest+json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".jpeg", "image/jpeg"},
      {".webp", "image/webp"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".wasm", "application/wasm"},
      {".pdf", "application/pdf"},
      {".docx", "application/vnd.openxmlformats-officedocument.wordprocessingml.document"},
      {".txt", "text/plain; charset=utf-8"}};
  auto found = types.find(to_lower(file.extension().string()));
  return found == types.end() ? "application/octet-stream" : found->second;
}

StaticFiles::StaticFiles(fs::path folder) {
  std::error_code error;
  folder_ = fs::weakly_canonical(folder, error);
  if (error) folder_ = std::move(folder);
  if (!folder_.has_filename()) folder_ = folder_.parent_path();
}

Response StaticFiles::serve(const Request& request) const {
  const Error missing{
      ErrorCode::not_found, "Not found", "The server has nothing at " + request.path + ".", {}};
  fs::path file = folder_;
  for (const auto& segment : request.segments) {
    if (segment.empty()) continue;
    if (!is_safe(segment)) return problem_response(missing);
    file /= segment;
  }
  std::error_code error;
  const bool is_guide = !request.segments.empty() && request.segments.front() == "guide";
  bool is_missing_page = false;
  if (is_guide && !fs::is_regular_file(file, error)) {
    file = guide_page(file);
    is_missing_page = !fs::is_regular_file(file, error);
    if (is_missing_page) file = folder_ / "guide" / "404.html";
    if (!fs::is_regular_file(file, error)) return problem_response(missing);
  } else if (file == folder_ || !fs::is_regular_file(file, error)) {
    const std::string_view document = document_of(request);
    if (document.empty()) return problem_response(missing);
    file = folder_ / document;
    if (!fs::is_regular_file(file, error))
      return problem_response(
          {ErrorCode::unavailable,
           "Page not built",
           "This installation does not contain the web page; only the API works. Build "
           "web-client and start the server again.",
           {}});
  }
  file = fs::canonical(file, error);
  if (error || !is_inside(file, folder_)) return problem_response(missing);

  // The build creates compressed copies if they save bytes: `main-….js.br`, `main-….js.gz`.
  fs::path sent = file;
  const auto coding = accepted_coding(request.header("accept-encoding"));
  const bool has_codings = fs::is_regular_file(coded(file, Coding::gzip), error);
  if (coding && fs::is_regular_file(coded(file, *coding), error)) sent = coded(file, *coding);
  std::string etag = etag_of(file);
  const bool unchanging = request.segments.size() > 1 && !is_missing_page &&
                          request.segments[is_guide ? 1 : 0] == "assets";
  Response response;
  if (!is_missing_page && names_tag(request.header("if-none-match"), etag)) {
    response = empty_response(304);
  } else {
    response.with("Content-Type", std::string(media_type(file)));
    response.file = sent;
    if (sent != file) {
      response.with("Content-Encoding", std::string(name(*coding)));
      etag.insert(etag.size() - 1, "-" + std::string(name(*coding)));
    }
  }
  if (has_codings) response.with("Vary", "Accept-Encoding");
  if (is_missing_page) response.status = 404;
  response.with("ETag", etag);
  response.with("Cache-Control", unchanging ? "public, max-age=31536000, immutable" : "no-cache");
  return response;
}

}  // namespace strata::net
