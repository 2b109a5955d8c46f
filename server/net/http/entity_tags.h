#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "net/http/http_types.h"

// Entity tags (RFC 9110, 8.8.3): a client that sends back the tag of what it has read gets 304
// without a body while the answer is the same.
namespace strata::net {

struct RouteContext;

// Whether the request's If-None-Match names the tag. Compared weakly; lists and `*` count.
bool names_tag(std::string_view if_none_match, std::string_view etag);

// The answer that nothing changed. Of the headers those stay that describe more than a body.
Response not_modified(const Response& response);

// Of an answer that was made: of its bytes. Nothing: it is sent as a file or while it is made, is
// too large to be hashed on the way, must not be kept, or has a tag already.
std::optional<std::string> tag_of_body(const Response& response);

// Of an answer before it is made: of who asks for what, and of the state that it depends on. Tags
// of an earlier run of the server never fit: its database may have been restored since.
std::string tag_of_state(const Request& request, std::string_view state);

// What the answer to a request depends on besides the request, as text, known without making the
// answer. Nothing: not known just now, as while edits are shown that are not durable, since these
// may be taken back and their sequences be given to others.
using StateOf = std::function<std::optional<std::string>(const Request&)>;

// Of questions about the model of the address: what its room shows, and what is stored of its
// project. With a past sequence as `at` the edits after it do not count.
StateOf state_of_model(const RouteContext& context);
// Of records: what is stored of the project of the address' table, or of its model and layer.
StateOf state_of_records(const RouteContext& context);
// Of questions over all layers that hold the keys of the address' table.
StateOf state_of_painted_table(const RouteContext& context);
// Of the picture of a look, which never changes.
StateOf state_of_surface_image(const RouteContext& context);

}  // namespace strata::net
