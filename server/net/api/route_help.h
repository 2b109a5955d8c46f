#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/ids.h"
#include "core/uuid.h"
#include "net/api/route_context.h"
#include "net/http/router.h"
#include "protocol/parse.h"

namespace strata {
struct Layer;
struct Model;
}  // namespace strata
namespace strata::room {
class Room;
struct EditRequest;
}  // namespace strata::room

// Helpers that the route files share.
namespace strata::net {

// Returns a handler that answers at once.
Handler answering(std::function<Result<Response>(const Request&)> answer);

// 415 if the body declares another type than JSON. Without a Content-Type the server assumes the
// type that the address accepts.
Result<void> check_json_type(const Request& request);

template <class T>
Result<T> body_of(const Request& request, std::uint64_t max_bytes = 1u << 20) {
  STRATA_TRY(check_json_type(request));
  return protocol::parse<T>(request.body, {static_cast<std::size_t>(max_bytes), 32});
}

// Metadata versions: "v7". Handle `If-None-Match` of a read and `If-Match` of a change (absent: any
// version; stale: 412).
std::string etag_of(std::int64_t version);
Response with_etag(Response response, const Request& request, std::int64_t version);
Result<void> check_if_match(const Request& request, std::int64_t version);

// Strata-Sequence: the sequence that a read shows; Strata-Durable-Sequence: the last durable one.
void add_sequences(Response& response, std::int64_t shown, std::int64_t durable);

// Returns the edit's id: from the Idempotency-Key, so that a repeat gets the first answer of the
// journal; random without a key. `operation` is the kind of call. The layer's id or slug in the
// address makes no difference.
Uuid edit_id(const Request& request, const Layer& layer, std::string_view operation);
// Submits the edit to the room and answers once it is durable or refused. Refuses a key that
// belongs to another edit. `body_of` converts the edit's answer to the body of the response.
void apply_edit(
    const RouteContext& context, const Request& request, const std::shared_ptr<room::Room>& room,
    room::EditRequest edit, const Respond& respond,
    std::function<nlohmann::json(nlohmann::json)> body_of = [](const nlohmann::json& of_edit) {
      return of_edit;
    });

// Finds layers by id or slug; the Error for a missing layer names `field`.
Result<std::vector<Layer>> find_layers(const room::Room& room, const std::vector<std::string>& refs,
                                       const std::string& field);
std::vector<std::string> split_list(const std::string& text);  // at commas, without empty parts

// Answer as `GET /me` does; the second adds the cookie of a new session.
Result<Response> who_is_signed_in(const RouteContext& context, const std::string& user, Role role);
Result<Response> signed_in(const RouteContext& context, const Request& request,
                           const std::string& session);
// 403: a script's token must not change accounts, so that its effects end with the token.
Result<void> check_no_script(const Request& request);
// Clears the cached roles of these people and closes their live connections. Clients that still
// have access reconnect automatically.
void roles_changed(const RouteContext& context, const std::vector<std::string>& people);
// Closes the live connections of the kiosks, and reads their links from the database again.
void end_kiosks(const RouteContext& context, const std::vector<KioskId>& kiosks,
                const std::string& reason);
// Returns the author's name as the caller may see it: kiosks get no names.
std::string visible_name(const Request& request, const std::string& user);
// Returns the browser's User-Agent, which helps a person to recognize the session.
std::string agent_of(const Request& request);

// 403: the role is lower than the model's `source_download`, which protects the scan's files and
// equivalent data.
Result<void> check_source_download(const Request& request, const Model& model);

// Returns 202 with the job and its address.
Response job_response(const RouteContext& context, JobId job);

// Returns the requested slug, or one made from the name. Refuses a requested slug of digits only.
Result<std::string> slug_of(const std::optional<std::string>& requested, const std::string& name);

}  // namespace strata::net
