#pragma once

#include <nlohmann/json.hpp>

#include "net/api/route_context.h"
#include "net/http/http_types.h"
#include "vocabulary/linked_document.h"

namespace strata::net {

// Returns the document in the format of the query parameter `f` (jsonld, turtle, html), or else in
// the format that `Accept` prefers: JSON-LD, Turtle, or a page for browsers with the same content.
// Adds `@context`. `page` is the address of the entity on the page of the site; may be empty.
// Returns 406 for other formats.
Result<Response> linked_response(const RouteContext& context, const Request& request,
                                 nlohmann::json document, const LinkedContext& terms,
                                 const std::string& page = {});

}  // namespace strata::net
