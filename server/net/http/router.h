#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "net/http/entity_tags.h"
#include "net/http/http_types.h"

namespace strata::net {

// Handlers run on a worker thread and may block. They call `respond` before or after they return.
using Handler = std::function<void(const Request& request, const Respond& respond)>;

// Determines how the session reads the body before the handler runs.
enum class BodyKind { none, memory, file };

struct Route {
  Method method = Method::get;
  // "/api/v1/models/{model}/texels.{format}". Two {names} in a segment are separated by text.
  std::string pattern;
  Handler handler;
  // Lowest role that may call the route, in the addressed project or on the site. Empty for public
  // routes.
  std::optional<Role> role = Role::viewer;
  std::vector<std::string> query{};  // accepted parameters; all others are refused
  bool any_query = false;
  bool project_in_query = false;  // a query parameter names the project
  // Can refuse the request before the body is read.
  std::function<Result<void>(const Request& request)> check{};
  BodyKind body = BodyKind::none;
  std::uint64_t max_body = 0;  // bytes
  // The handler stores its response together with its effect (`idempotent_response`). A call with a
  // repeated Idempotency-Key gets this response, and the handler does not run. A call is refused
  // while another call with its key runs. If the handler stores nothing, as for jobs
  // (JobIdempotency), this is the only effect.
  bool keeps_answer = false;
  // If set, creates the response to a repeated call from the stored one.
  std::function<Result<Response>(const Request& request, const nlohmann::json& stored)> replay{};
  // The edit may take a long time. It ends when the client disconnects, and it has the limits of a
  // question. It does not wait for a turn.
  bool is_long_edit = false;
  // The request may take a long time. The question desk (net/http/question_desk.h) runs it in turns
  // and with limits.
  bool is_question = false;
  // Changes an entity that has a version. A project may require If-Match (net/http/precondition.h).
  bool needs_version = false;
  // For expensive reads: returns the state that determines the response (net/http/entity_tags.h).
  // The handlers of these routes respond before they return.
  StateOf state{};
};

// Finds the route of a request. Add all routes before the server starts. Afterwards the router is
// read-only and therefore thread-safe.
class Router {
 public:
  void add(Route route);

  struct Match {
    const Route* route = nullptr;  // null: see `allowed`
    std::map<std::string, std::string> params;
    std::vector<Method> allowed;  // methods of the path; empty: the path does not exist
  };
  // For HEAD, returns the route of GET.
  Match find(Method method, const std::vector<std::string>& segments) const;

 private:
  // A parameter ends where the first text after it begins, and the last one at the end.
  struct Segment {
    struct Param {
      std::string name, after;  // the text after it
    };
    std::string before;  // without parameters, the whole segment
    std::vector<Param> params;
    bool matches(const std::string& text, std::map<std::string, std::string>& values) const;
  };
  struct Entry {
    Route route;
    std::vector<Segment> segments;
  };
  static bool matches(const Entry& entry, const std::vector<std::string>& segments,
                      std::map<std::string, std::string>& params);
  std::vector<Entry> entries_;
};

std::string allow_header(const std::vector<Method>& methods);
Result<void> check_query(const Route& route, const Request& request);

}  // namespace strata::net
