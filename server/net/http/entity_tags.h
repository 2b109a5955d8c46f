#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "net/http/http_types.h"

// Entity tags (RFC 9110, 8.8.3). A client that sends the tag of its copy gets a 304 without a body
// if the response has not changed.
namespace strata::net {

struct RouteContext;

// Returns whether the request's If-None-Match contains the tag. Uses weak comparison and supports
// lists and `*`.
bool names_tag(std::string_view if_none_match, std::string_view etag);

// Returns a 304. Keeps all headers except those that only describe the body.
Response not_modified(const Response& response);

// Returns a tag that is computed from the bytes of the response. Returns nothing if the response is
// sent from a file or streamed, is too large to hash, must not be stored, or already has a tag.
std::optional<std::string> tag_of_body(const Response& response);

// Returns a tag without creating the response. The tag is a hash of the caller, the request and the
// state. Tags from an earlier run of the server never match because its database may have been
// restored since then.
std::string tag_of_state(const Request& request, std::string_view state);

// Returns, as text, the state that determines the response in addition to the request. Does not
// create the response. Returns nothing if the state is unknown. For example, the response may
// contain edits that are not durable: they may be undone and their sequences reused.
using StateOf = std::function<std::optional<std::string>(const Request&)>;

// For routes of a model. Returns the state of its room and the stored state of its project. If `at`
// selects a past sequence, later edits have no effect on the state.
StateOf state_of_model(const RouteContext& context);
// For routes of records. Returns the stored state of the project that contains the addressed table,
// or the addressed model and layer.
StateOf state_of_records(const RouteContext& context);
// For routes that read all layers with keys of the addressed table.
StateOf state_of_painted_table(const RouteContext& context);
// For the statistics of the addressed object. Opens no room. Returns nothing while a room shows
// other edits than the database.
StateOf state_of_surveys(const RouteContext& context);
// For the file of a surface image, which never changes.
StateOf state_of_surface_image(const RouteContext& context);

}  // namespace strata::net
