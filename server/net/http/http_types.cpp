#include "net/http/http_types.h"

#include "core/text/percent.h"
#include "core/text/utf8.h"
#include "protocol/parse.h"
#include "protocol/problem.h"

#include <algorithm>
#include <atomic>
#include <charconv>

namespace strata::net {
std::string_view name(Method method) {
  static constexpr std::string_view kNames[] = {"GET",   "HEAD",   "POST",    "PUT",
                                                "PATCH", "DELETE", "OPTIONS", "?"};
  return kNames[static_cast<int>(method)];
}

std::string_view Request::header(std::string_view lower_case_name) const {
  for (const auto& [key, value] : headers)
    if (key == lower_case_name) return value;
  return {};
}

std::string Request::path_for_log() const {
  const bool is_secret = !segments.empty() && segments.front() == "kiosk";
  return is_secret ? "/kiosk/…" : path;
}

std::string Request::query_or(const std::string& key, const std::string& fallback) const {
  auto found = query.find(key);
  return found == query.end() ? fallback : found->second;
}

Response& Response::with(std::string header_name, std::string value) {
  headers.emplace_back(std::move(header_name), std::move(value));
  return *this;
}

std::string_view Response::header(std::string_view header_name) const {
  for (const auto& [key, value] : headers)
    if (key == header_name) return value;
  return {};
}

Response json_response(const nlohmann::json& json, int status) {
  Response response;
  response.status = status;
  response.with("Content-Type", "application/json");
  // Replaces invalid UTF-8 in names from users and files instead of throwing an exception.
  response.body = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  return response;
}

Response bytes_response(std::vector<std::uint8_t> bytes, std::string content_type) {
  Response response;
  response.with("Content-Type", std::move(content_type));
  response.bytes = std::move(bytes);
  return response;
}

Response text_response(std::string text, std::string content_type) {
  Response response;
  response.with("Content-Type", std::move(content_type));
  response.body = std::move(text);
  return response;
}

Response file_response(std::shared_ptr<const TemporaryFile> file) {
  Response response;
  response.with("Content-Type", file->media_type);
  name_download(response, file->name);
  if (file->triangles) response.with("Strata-Triangles", std::to_string(*file->triangles));
  response.file = file->path;
  response.held = std::move(file);
  return response;
}

Response empty_response(int status) {
  Response response;
  response.status = status;
  return response;
}

Response problem_response(const Error& problem) {
  Response response =
      json_response(protocol::problem_body(problem), protocol::http_status(problem.code));
  response.headers = {{"Content-Type", "application/problem+json"}};
  if (!problem.location.empty()) response.with("Location", problem.location);
  response.problem = problem.code;
  if (response.status == 401) response.with("WWW-Authenticate", "Bearer realm=\"strata\"");
  if (response.status == 429 || response.status == 503) response.with("Retry-After", "1");
  return response;
}

std::string_view reason_phrase(int status) {
  switch (status) {
    case 200: return "OK";
    case 201: return "Created";
    case 202: return "Accepted";
    case 204: return "No Content";
    case 206: return "Partial Content";
    case 303: return "See Other";
    case 304: return "Not Modified";
    case 307: return "Temporary Redirect";
    case 308: return "Permanent Redirect";
    case 400: return "Bad Request";
    case 401: return "Unauthorized";
    case 403: return "Forbidden";
    case 404: return "Not Found";
    case 405: return "Method Not Allowed";
    case 406: return "Not Acceptable";
    case 408: return "Request Timeout";
    case 409: return "Conflict";
    case 412: return "Precondition Failed";
    case 413: return "Content Too Large";
    case 415: return "Unsupported Media Type";
    case 416: return "Range Not Satisfiable";
    case 421: return "Misdirected Request";
    case 422: return "Unprocessable Content";
    case 426: return "Upgrade Required";
    case 428: return "Precondition Required";
    case 429: return "Too Many Requests";
    case 431: return "Request Header Fields Too Large";
    case 499: return "Cancelled";
    case 500: return "Internal Server Error";
    case 501: return "Not Implemented";
    case 503: return "Service Unavailable";
    case 507: return "Insufficient Storage";
    default: return status < 400 ? "OK" : status < 500 ? "Refused" : "Failed";
  }
}

struct Respond::State {
  explicit State(std::function<void(Response)> function) : send(std::move(function)) {}
  ~State() {
    if (!answered)
      send(problem_response({ErrorCode::unavailable,
                             "Request dropped",
                             "The server stopped before it could answer. Try again.",
                             {}}));
  }
  std::function<void(Response)> send;
  std::atomic<bool> answered{false};
};

Respond::Respond(std::function<void(Response)> send)
    : state_(std::make_shared<State>(std::move(send))) {}

void Respond::operator()(Response response) const {
  if (!state_->answered.exchange(true)) state_->send(std::move(response));
}

void name_download(Response& response, const std::string& filename) {
  std::string value = "attachment; filename*=UTF-8''";
  response.with("Content-Disposition", value.append(percent_encode(filename)));
}

namespace {

// Decodes the text like a form field, where a plus means a space.
std::optional<std::string> query_text(std::string_view text) {
  std::string spaced(text);
  std::ranges::replace(spaced, '+', ' ');
  return percent_decode(spaced);
}

}  // namespace

Result<void> parse_target(std::string_view target, Request& request) {
  auto wrong = [](std::string detail) {
    return fail(ErrorCode::malformed, "Malformed address", std::move(detail));
  };
  // Removes the mark, because a repeated request (Idempotency-Key) may arrive without it.
  if (target.ends_with(kMovedMark)) {
    const std::string_view rest = target.substr(0, target.size() - kMovedMark.size());
    request.was_moved = rest.ends_with('?') || rest.ends_with('&');
    if (request.was_moved) target = rest.substr(0, rest.size() - 1);
  }
  request.target = target;
  if (target.empty() || target[0] != '/')
    return wrong("The path of a request must begin with a slash.");
  const auto question = target.find('?');
  const std::string_view path = target.substr(0, question);
  for (std::size_t begin = 1; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    auto segment = percent_decode(path.substr(begin, end - begin));
    if (!segment) return wrong("The path contains an invalid percent escape.");
    request.segments.push_back(std::move(*segment));
    begin = end + 1;
  }
  auto decoded = percent_decode(path);
  if (!decoded) return wrong("The path contains an invalid percent escape.");
  if (!is_utf8(*decoded)) return wrong("The path is not UTF-8.");
  request.path = std::move(*decoded);
  if (question == std::string_view::npos) return {};
  const std::string_view query = target.substr(question + 1);
  for (std::size_t begin = 0; begin < query.size();) {
    const std::size_t end = std::min(query.find('&', begin), query.size());
    const std::string_view pair = query.substr(begin, end - begin);
    begin = end + 1;
    if (pair.empty()) continue;
    const auto equals = pair.find('=');
    auto key = query_text(pair.substr(0, equals));
    auto value =
        query_text(equals == std::string_view::npos ? std::string_view() : pair.substr(equals + 1));
    if (!key || !value) return wrong("The query contains an invalid percent escape.");
    if (!is_utf8(*key) || !is_utf8(*value)) return wrong("The query is not UTF-8.");
    if (!request.query.emplace(*key, std::move(*value)).second)
      return fail(ErrorCode::malformed, "Duplicate query parameter",
                  "Send '" + *key + "' only once.", *key);
  }
  // `as` is not a parameter of the route. It selects the cookie.
  if (const auto as = request.query.find("as");
      as != request.query.end() && as->second == "kiosk") {
    request.as_kiosk = true;
    request.query.erase(as);
  }
  return {};
}

Result<std::string> requested_language(const Request& request) {
  constexpr std::size_t kMaxLength = 35;  // long enough for BCP 47
  std::string language = to_lower(request.query_or("lang", {}));
  if (language.size() > kMaxLength)
    return fail(ErrorCode::invalid, "Invalid language",
                "`lang` must be a language tag of at most 35 characters, such as `es` or `de-AT`.",
                "lang");
  return language;
}

}  // namespace strata::net
