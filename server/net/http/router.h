#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "net/http/entity_tags.h"
#include "net/http/http_types.h"

namespace strata::net {

// Handlers run on a worker thread and may block; they answer at once or later through `respond`.
using Handler = std::function<void(const Request& request, const Respond& respond)>;

// How the session takes the body in before the handler runs.
enum class BodyKind { none, memory, file };

struct Route {
  Method method = Method::get;
  std::string pattern;  // "/api/v1/models/{model}/texels.{format}": one {name} per segment
  Handler handler;
  // Least role that may call it: in the project that it leads into, or everywhere. Empty: open to
  // everyone.
  std::optional<Role> role = Role::viewer;
  std::vector<std::string> query{};  // parameters it knows; others are refused
  bool any_query = false;
  bool project_in_query = false;  // leads into the project that the query names
  // Refuses by what stands in the address, before the body is read.
  std::function<Result<void>(const Request& request)> check{};
  BodyKind body = BodyKind::none;
  std::uint64_t max_body = 0;  // bytes
  // The handler keeps its answer with what it does (`idempotent_response`); a repeat of its
  // Idempotency-Key gets it without the handler…
  bool keeps_answer = false;
  // …or what this makes of what was kept.
  std::function<Result<Response>(const Request& request, const nlohmann::json& kept)> replay{};
  // An edit that may take long: ends with its client, within the limits of a question, but waits
  // for no turn.
  bool is_long_edit = false;
  // may take long: answered by the question desk (net/http/question_desk.h), in turns, within
  // limits
  bool is_question = false;
  // Changes what has a version: a project may demand If-Match (net/http/precondition.h).
  bool needs_version = false;
  // Of reads that cost: what the answer depends on (net/http/entity_tags.h). Their handlers answer
  // before they return.
  StateOf state{};
};

// Finds the route of a request. Filled before the server starts, read-only (so thread-safe)
// afterwards.
class Router {
 public:
  void add(Route route);

  struct Match {
    const Route* route = nullptr;  // null: see `allowed`
    std::map<std::string, std::string> params;
    std::vector<Method> allowed;  // methods of the path; empty: no such path
  };
  // HEAD finds the route of GET.
  Match find(Method method, const std::vector<std::string>& segments) const;

 private:
  struct Segment {
    std::string prefix, param, suffix;  // without a param: `prefix` is the whole segment
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
