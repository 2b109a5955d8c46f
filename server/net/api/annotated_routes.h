#pragma once

#include <string>
#include <utility>
#include <vector>

#include "net/api/route_help.h"
#include "net/transport/server_options.h"

namespace strata::net {

// Adds the routes of entities that all viewers can read and that annotators or higher roles can
// change. The bodies are JSON. Responses to changes are stored for repeated calls.
class AnnotatedRoutes {
 public:
  using Answer = Result<Response> (*)(const RouteContext&, const Request&);

  AnnotatedRoutes(Router& router, const RouteContext& context, Role least = Role::annotator)
      : router_(router), context_(context), least_(least) {}

  void read(std::string pattern, Answer answer, std::vector<std::string> query = {},
            StateOf state = {}) {
    router_.add({.method = Method::get,
                 .pattern = std::move(pattern),
                 .handler = handler(answer),
                 .query = std::move(query),
                 .state = std::move(state)});
  }
  void change(Method method, std::string pattern, Answer answer) {
    const bool has_body = method != Method::remove;
    router_.add({.method = method,
                 .pattern = std::move(pattern),
                 .handler = handler(answer),
                 .role = least_,
                 .body = has_body ? BodyKind::memory : BodyKind::none,
                 .max_body = has_body ? context_.options.max_json_bytes : 0,
                 .keeps_answer = true,
                 .needs_version = method != Method::post});
  }

 private:
  Handler handler(Answer answer) const {
    return answering(
        [&context = context_, answer](const Request& request) { return answer(context, request); });
  }

  Router& router_;
  const RouteContext& context_;
  const Role least_;
};

}  // namespace strata::net
