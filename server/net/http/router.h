#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "net/http/entity_tags.h"
#include "net/http/http_types.h"

namespace strata::net {

// Handlers run on a worker thread and may block; they call `respond` at once or later.
using Handler = std::function<void(const Request& request, const Respond& respond)>;

// How the session reads the body before the handler runs.
enum class BodyKind { none, memory, file };

struct Route {
  Method method = Method::get;
  std::string pattern;  // "/api/v1/models/{model}/texels.{format}": one {name} per segment
  Handler handler;
  // Least role that may call it, in the addressed project or in general. Empty: public.
  std::optional<Role> role = Role::viewer;
  std::vector<std::string> query{};  // accepted parameters; others are refused
  bool any_query = false;
  bool project_in_query = false;  // the query names the project
  // Refuses by the address, before the body is read.
  std::function<Result<void>(const Request& request)> check{};
  BodyKind body = BodyKind::none;
  std::uint64_t max_body = 0;  // bytes
  // The handler stores its answer with its effect (`idempotent_response`); a repeat of its
  // Idempotency-Key gets that answer without the handler,
  bool keeps_answer = false;
  // or the answer that this function makes from it.
  std::function<Result<Response>(const Request& request, const nlohmann::json& stored)> replay{};
  // An edit that may take long: ends with its client's connection, within the limits of a question,
  // but does not wait for a turn.
  bool is_long_edit = false;
  // May take long: the question desk (net/http/question_desk.h) answers it, in turns and within
  // limits.
  bool is_question = false;
  // Changes an entity with a version: a project may require If-Match (net/http/precondition.h).
  bool needs_version = false;
  // For expensive reads: the state that the answer depends on (net/http/entity_tags.h). Their
  // handlers answer before they return.
  StateOf state{};
};

// Finds the route of a request. Routes are added before the server starts; afterwards it is
// read-only and so thread-safe.
class Router {
 public:
  void add(Route route);

  struct Match {
    const Route* route = nullptr;  // null: see `allowed`
    std::map<std::string, std::string> params;
    std::vector<Method> allowed;  // methods of the path; empty: the path does not exist
  };
  // HEAD finds the route of GET.
  Match find(Method method, const std::vector<std::string>& segments) const;

 private:
  struct Segment {
    std::string prefix, param, suffix;  // without a parameter `prefix` is the whole segment
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
