#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "net/http/http_types.h"

// Entity tags (RFC 9110, 8.8.3): a client that sends the tag of its copy gets 304 without a body as
// long as the answer is the same.
namespace strata::net {

struct RouteContext;

// Whether the request's If-None-Match contains the tag. Weak comparison; supports lists and `*`.
bool names_tag(std::string_view if_none_match, std::string_view etag);

// Returns a 304. Keeps the headers that do not only describe the body.
Response not_modified(const Response& response);

// Returns a tag of the answer's bytes. Nothing: the answer is sent from a file or streamed, is too
// large to hash, must not be stored, or has a tag already.
std::optional<std::string> tag_of_body(const Response& response);

// Returns a tag before the answer is made: a hash of caller, request and state. Tags of an earlier
// run of the server never match: its database may have been restored since then.
std::string tag_of_state(const Request& request, std::string_view state);

// Returns the state on which the answer depends in addition to the request, as text, without making
// the answer. Nothing: the state is unknown, for example while edits are shown that are not
// durable: they may be undone and their sequences reused.
using StateOf = std::function<std::optional<std::string>(const Request&)>;

// For routes of a model: the state of its room and the stored state of its project. With a past
// sequence as `at`, later edits do not count.
StateOf state_of_model(const RouteContext& context);
// For records: the stored state of the project of the addressed table, or model and layer.
StateOf state_of_records(const RouteContext& context);
// For routes about all layers that hold the keys of the addressed table.
StateOf state_of_painted_table(const RouteContext& context);
// For the picture of a surface image, which never changes.
StateOf state_of_surface_image(const RouteContext& context);

}  // namespace strata::net
