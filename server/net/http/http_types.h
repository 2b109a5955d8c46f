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

// What routes see of HTTP: no socket library in here, so that they compile fast and can be tested
// without a socket.

enum class Method { get, head, post, put, patch, remove, options, unknown };
std::string_view name(Method method);

// What the link of a kiosk leads to, by ids.
struct KioskPass {
  KioskId id = 0;
  ModelId model = 0;
  NamedPartId tour = 0;
};

// Who asks. `role`: what they may do where the address leads. `by_cookie`: the browser sent the
// secret by itself, so changing calls must prove where they come from.
struct Principal {
  std::string user;
  Role role = Role::viewer;
  bool by_cookie = false;
  bool is_script = false;  // it came with a token for scripts
  TokenId secret = 0;      // id of the session or token; 0: the owner's token of the environment
  Roles roles{};
  std::optional<KioskPass> kiosk{};  // it is none of the people, but a screen that shows a tour

  bool sees(ProjectId project) const { return roles.in(project) >= Role::viewer; }
};

using Headers = std::vector<std::pair<std::string, std::string>>;

struct Request {
  Method method = Method::get;
  std::string target;                         // as sent
  std::string path;                           // decoded, without the query
  std::vector<std::string> segments;          // of the path, each decoded
  std::map<std::string, std::string> query;   // decoded
  std::map<std::string, std::string> params;  // what the route's pattern caught
  Headers headers;                            // names in lower case
  std::string body;                           // in memory, or…
  // …in a file that is removed after the answer unless a handler moves it
  std::filesystem::path body_file;
  std::uint64_t body_bytes = 0;
  std::optional<Principal> principal;
  std::string peer;     // address at the other end of the connection
  bool by_tls = false;  // the connection speaks TLS
  // If-None-Match as sent, where `headers` has it without codings (net/http/compression.h)
  std::string known_tags{};
  // the query had `as=kiosk`: of all cookies that of the kiosk counts, which otherwise does not
  bool as_kiosk = false;

  std::string_view header(std::string_view lower_case_name) const;  // empty when absent
  const std::string& param(const std::string& name) const { return params.at(name); }
  std::string query_or(const std::string& name, const std::string& fallback) const;
  // routes that need a principal have one
  const std::string& user() const { return principal->user; }
  Role role() const { return principal->role; }                         // the same
  Author author() const { return {principal->user, principal->role}; }  // the same
};

struct Response {
  int status = 200;
  Headers headers;
  std::string body;
  std::vector<std::uint8_t> bytes;   // sent in place of `body` when not empty
  std::filesystem::path file;        // the same
  std::shared_ptr<const void> held;  // let go once the answer is sent
  // Bytes made while they are sent, in place of `body`. `write` runs on a worker, stops when the
  // sink says false, and says whether all was written: otherwise the connection ends, which tells
  // the client.
  using Sink = std::function<bool(std::span<const std::uint8_t>)>;
  struct Stream {
    std::optional<std::uint64_t> length;  // nothing: known only at the end
    std::function<bool(const Sink&)> write;
  };
  std::optional<Stream> stream;
  // Server-sent events (HTML, section 9.2), until the client goes: asked about once a second, on a
  // worker, what there is to send; nothing: it ends. The client comes back by itself.
  struct Events {
    std::function<std::optional<std::string>()> next;
  };
  std::optional<Events> events;

  Response& with(std::string header_name, std::string value);
  std::string_view header(std::string_view name) const;  // as written by `with`; empty when absent
};

Response json_response(const nlohmann::json& json, int status = 200);
Response bytes_response(std::vector<std::uint8_t> bytes, std::string content_type);
Response text_response(std::string text, std::string content_type);
Response empty_response(int status);              // 204, 304
Response problem_response(const Error& problem);  // RFC 9457
// A download. The file is kept while it is sent.
Response file_response(std::shared_ptr<const TemporaryFile> file);
// For a file that is kept and not shown; any characters will do.
void name_download(Response& response, const std::string& filename);
std::string_view reason_phrase(int status);

// The one answer to a request; may be called from any thread. The first call counts; when the last
// copy goes without one, the client gets a 500 rather than silence.
class Respond {
 public:
  explicit Respond(std::function<void(Response)> send);
  void operator()(Response response) const;
  void operator()(const Error& problem) const { (*this)(problem_response(problem)); }

 private:
  struct State;
  std::shared_ptr<State> state_;
};

// Splits and decodes a request target. Refused: bad percent escapes, NUL, what is not UTF-8, a
// query parameter given twice.
Result<void> parse_target(std::string_view target, Request& request);

// `lang`, a language tag in lower case; empty: any. Refused (422, `lang`): one that is too long.
Result<std::string> asked_language(const Request& request);

}  // namespace strata::net
