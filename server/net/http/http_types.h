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
#include "domain/people/role.h"

namespace strata::net {

// HTTP as the routes see it. Includes no socket library: routes compile fast, and tests need no
// socket.

enum class Method { get, head, post, put, patch, remove, options, unknown };
std::string_view name(Method method);

// The ids of a kiosk's content.
struct KioskPass {
  KioskId id = 0;
  ModelId model = 0;
  NamedPartId tour = 0;
};

// The sender of a request. `role`: the role in the addressed project. `by_cookie`: the browser
// added the secret automatically, so calls that change something must prove their origin.
struct Principal {
  std::string user;
  Role role = Role::viewer;
  bool by_cookie = false;
  bool is_script = false;  // identified by a token for scripts
  TokenId secret = 0;      // id of the session or token; 0: the owner's token from the environment
  Roles roles{};
  std::optional<KioskPass> kiosk{};  // set for a screen that shows a tour, which is not a user

  bool sees(ProjectId project) const { return roles.in(project) >= Role::viewer; }
};

using Headers = std::vector<std::pair<std::string, std::string>>;

struct Request {
  Method method = Method::get;
  std::string target;                         // as sent
  std::string path;                           // decoded, without the query
  std::vector<std::string> segments;          // of the path, each decoded
  std::map<std::string, std::string> query;   // decoded
  std::map<std::string, std::string> params;  // parameters of the route's pattern
  Headers headers;                            // names in lower case
  std::string body;                           // in memory, otherwise in
  // `body_file`, removed after the answer unless a handler moves it
  std::filesystem::path body_file;
  std::uint64_t body_bytes = 0;
  std::optional<Principal> principal;
  std::string peer;     // address of the other end of the connection
  bool by_tls = false;  // the connection uses TLS
  // original If-None-Match; `headers` has it without codings (net/http/compression.h)
  std::string known_tags{};
  // the query has `as=kiosk`: only the kiosk's cookie counts, which is ignored otherwise
  bool as_kiosk = false;

  std::string_view header(std::string_view lower_case_name) const;  // empty when absent
  const std::string& param(const std::string& name) const { return params.at(name); }
  std::string query_or(const std::string& name, const std::string& fallback) const;
  // set for routes that require a principal
  const std::string& user() const { return principal->user; }
  Role role() const { return principal->role; }                         // likewise
  Author author() const { return {principal->user, principal->role}; }  // likewise
};

struct Response {
  int status = 200;
  Headers headers;
  std::string body;
  std::vector<std::uint8_t> bytes;   // sent instead of `body` if not empty
  std::filesystem::path file;        // likewise
  std::shared_ptr<const void> held;  // released once the answer is sent
  // Bytes made while they are sent, instead of `body`. `write` runs on a worker, stops when the
  // sink returns false, and returns whether it wrote everything; otherwise the connection is
  // closed, so that the client detects the failure.
  using Sink = std::function<bool(std::span<const std::uint8_t>)>;
  struct Stream {
    std::optional<std::uint64_t> length;  // nothing: known only at the end
    std::function<bool(const Sink&)> write;
  };
  std::optional<Stream> stream;
  // Server-sent events (HTML, section 9.2), until the client disconnects. A worker calls `next`
  // about once a second; nothing ends the stream. The client reconnects automatically.
  struct Events {
    std::function<std::optional<std::string>()> next;
  };
  std::optional<Events> events;

  Response& with(std::string header_name, std::string value);
  std::string_view header(std::string_view name) const;  // name as in `with`; empty when absent
};

Response json_response(const nlohmann::json& json, int status = 200);
Response bytes_response(std::vector<std::uint8_t> bytes, std::string content_type);
Response text_response(std::string text, std::string content_type);
Response empty_response(int status);              // 204, 304
Response problem_response(const Error& problem);  // RFC 9457
// Returns a download, and keeps the file while it is sent.
Response file_response(std::shared_ptr<const TemporaryFile> file);
// For a file that browsers save instead of showing it; accepts any characters.
void name_download(Response& response, const std::string& filename);
std::string_view reason_phrase(int status);

// The one answer to a request; may be called from any thread. Only the first call counts. If the
// last copy is destroyed without a call, the client gets a 500.
class Respond {
 public:
  explicit Respond(std::function<void(Response)> send);
  void operator()(Response response) const;
  void operator()(const Error& problem) const { (*this)(problem_response(problem)); }

 private:
  struct State;
  std::shared_ptr<State> state_;
};

// Splits and decodes a request target. Refuses bad percent escapes, NUL, invalid UTF-8, and a query
// parameter given twice.
Result<void> parse_target(std::string_view target, Request& request);

// `lang`, a language tag in lower case; empty: any. Refuses one that is too long (422, `lang`).
Result<std::string> requested_language(const Request& request);

}  // namespace strata::net
