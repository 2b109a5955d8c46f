#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "core/temporary_file.h"
#include "core/text/ascii.h"
#include "core/text/number_text.h"
#include "core/trace.h"
#include "domain/people/role.h"

namespace strata::net {

// The HTTP types that the routes use. They include no socket library, so routes compile fast and
// tests do not need a socket.

enum class Method { get, head, post, put, patch, remove, options, unknown };
std::string_view name(Method method);

// The ids of a kiosk and of its content.
struct KioskPass {
  KioskId id = 0;
  ModelId model = 0;
  NamedPartId tour = 0;
};

// The sender of a request. `role` is the role in the addressed project. `by_cookie` is true if the
// browser added the secret automatically. The server then checks the origin of changes.
struct Principal {
  std::string user;
  Role role = Role::viewer;
  bool by_cookie = false;
  bool is_script = false;  // authenticated by a token for scripts
  TokenId secret = 0;      // id of the session or token; 0: the owner's token
  Roles roles{};
  std::optional<KioskPass> kiosk{};  // set for a kiosk, which is not a user

  bool sees(ProjectId project) const { return roles.in(project) >= Role::viewer; }
};

using Headers = std::vector<std::pair<std::string, std::string>>;

struct Request {
  Method method = Method::get;
  std::string target;                         // the address from the client, without kMovedMark
  std::string path;                           // decoded, without the query
  std::vector<std::string> segments;          // the decoded parts of the path
  std::map<std::string, std::string> query;   // decoded
  std::map<std::string, std::string> params;  // values of the parameters in the route's pattern
  Headers headers;                            // names in lower case
  std::string body;                           // the body in memory
  // The file with the body, if the body is not in memory. It is deleted after the response unless a
  // handler moves it.
  std::filesystem::path body_file;
  std::uint64_t body_bytes = 0;
  std::optional<Principal> principal;
  std::string peer;     // address of the client
  bool by_tls = false;  // the connection uses TLS
  // The original If-None-Match. `headers` contains it without codings (net/http/compression.h).
  std::string known_tags{};
  // The query contains `as=kiosk`. The kiosk's cookie is then the only valid one. Without
  // `as=kiosk`, that cookie is ignored.
  bool as_kiosk = false;
  // Another node redirected the request to this node, and `target` ended with kMovedMark.
  bool was_moved = false;
  TraceContext trace{};  // the span is this server's

  std::string_view header(std::string_view lower_case_name) const;  // empty if absent
  // Returns the path for the log. The address of a kiosk contains its secret, which is left out.
  std::string path_for_log() const;
  const std::string& param(const std::string& name) const { return params.at(name); }
  std::string query_or(const std::string& name, const std::string& fallback) const;
  // Only for routes that require a principal.
  const std::string& user() const { return principal->user; }
  Role role() const { return principal->role; }                         // only for such routes
  Author author() const { return {principal->user, principal->role}; }  // only for such routes
};

struct Response {
  int status = 200;
  Headers headers;
  std::string body;
  std::vector<std::uint8_t> bytes;   // sent instead of `body`, if not empty
  std::filesystem::path file;        // sent instead of `body`, if not empty
  std::shared_ptr<const void> held;  // released when the response has been sent
  // Bytes that are produced while they are sent, instead of `body`. `write` runs on a worker and
  // must stop when the sink returns false. It returns whether it wrote all bytes. If not, the
  // server closes the connection, so the client detects the failure.
  using Sink = std::function<bool(std::span<const std::uint8_t>)>;
  struct Stream {
    std::optional<std::uint64_t> length;  // empty: not known before the end
    std::function<bool(const Sink&)> write;
  };
  std::optional<Stream> stream;
  // Server-sent events (HTML, section 9.2) until the client disconnects. A worker calls `next`
  // about once a second. The stream ends when `next` returns nothing. The client reconnects
  // automatically.
  struct Events {
    std::function<std::optional<std::string>()> next;
  };
  std::optional<Events> events;
  std::optional<ErrorCode> problem{};  // set by `problem_response`, for the metrics

  Response& with(std::string header_name, std::string value);
  std::string_view header(std::string_view name) const;  // `name` as in `with`; empty if absent
};

Response json_response(const nlohmann::json& json, int status = 200);
Response bytes_response(std::vector<std::uint8_t> bytes, std::string content_type);
Response text_response(std::string text, std::string content_type);
Response empty_response(int status);  // for 204 and 304
// RFC 9457. The header Location of `moved` is the address of the node.
Response problem_response(const Error& problem);
// Returns a download. Keeps the file until it has been sent.
Response file_response(std::shared_ptr<const TemporaryFile> file);
// Adds the header for a file that browsers save instead of display. The file name may contain any
// characters.
void name_download(Response& response, const std::string& filename);
std::string_view reason_phrase(int status);

// The only response to a request. May be called from any thread. Calls after the first one have no
// effect. If the last copy is destroyed without a call, the client gets a 500.
class Respond {
 public:
  explicit Respond(std::function<void(Response)> send);
  void operator()(Response response) const;
  void operator()(const Error& problem) const { (*this)(problem_response(problem)); }

 private:
  struct State;
  std::shared_ptr<State> state_;
};

// The end of the query of some redirects to another node (net/api/node_redirect.h). No route has
// this parameter.
constexpr std::string_view kMovedMark = "moved=1";

// Splits and decodes a request target. Refuses invalid percent escapes, NUL, invalid UTF-8, and
// repeated query parameters.
Result<void> parse_target(std::string_view target, Request& request);

// Returns the language tag in `lang` in lower case. An empty text means any language. Refuses a tag
// that is too long (422, `lang`).
Result<std::string> requested_language(const Request& request);

}  // namespace strata::net
