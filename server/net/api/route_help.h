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

// Shared by the route files.
namespace strata::net {

// A handler that answers at once.
Handler answering(std::function<Result<Response>(const Request&)> answer);

// 415: the body says that it is something else than JSON. Without a Content-Type it is taken for
// what the address takes.
Result<void> check_json_type(const Request& request);

template <class T>
Result<T> body_of(const Request& request, std::uint64_t max_bytes = 1u << 20) {
  STRATA_TRY(check_json_type(request));
  return protocol::parse<T>(request.body, {static_cast<std::size_t>(max_bytes), 32});
}

// Metadata versions: "v7". `If-None-Match` of a read, `If-Match` of a change (absent: any version;
// stale: 412).
std::string etag_of(std::int64_t version);
Response with_etag(Response response, const Request& request, std::int64_t version);
Result<void> check_if_match(const Request& request, std::int64_t version);

// Strata-Sequence: what a read shows; Strata-Durable-Sequence: what is safe.
void add_sequences(Response& response, std::int64_t shown, std::int64_t durable);

// The edit's id: from the Idempotency-Key, so that a repeat gets the journal's first answer; random
// without one. `operation` is the kind of call; a layer is the same by whatever address it was
// reached.
Uuid edit_id(const Request& request, const Layer& layer, std::string_view operation);
// Hands the edit to the room and answers once it is durable or refused. A key of another edit is
// refused. `body_of` makes the answer's body of the edit's.
void apply_edit(
    const RouteContext& context, const Request& request, const std::shared_ptr<room::Room>& room,
    room::EditRequest edit, const Respond& respond,
    std::function<nlohmann::json(nlohmann::json)> body_of = [](const nlohmann::json& of_edit) {
      return of_edit;
    });

// Layers by id or slug; the Error of one that is not there names `field`.
Result<std::vector<Layer>> find_layers(const room::Room& room, const std::vector<std::string>& refs,
                                       const std::string& field);
std::vector<std::string> split_list(const std::string& text);  // at commas, without empty parts

// As `GET /me` tells it; the second with the cookie of a session that was just opened.
Result<Response> who_is_signed_in(const RouteContext& context, const std::string& user, Role role);
Result<Response> signed_in(const RouteContext& context, const Request& request,
                           const std::string& session);
// 403: what a token does must not outlive it, so that scripts change no accounts.
Result<void> check_no_script(const Request& request);
// Nothing is remembered of what they might do, and their live connections end; those who may stay
// come back by themselves.
void roles_changed(const RouteContext& context, const std::vector<std::string>& people);
// Their live connections are over, and the links are looked up anew.
void end_kiosks(const RouteContext& context, const std::vector<KioskId>& kiosks,
                const std::string& reason);
// Who made something, as who asks is told: kiosks hear no names.
std::string told_name(const Request& request, const std::string& user);
// What the browser calls itself, for its person to know the session by.
std::string agent_of(const Request& request);

// 403: the role is less than the model's `source_download`, which guards the scan's files and what
// is as good as they are.
Result<void> check_source_download(const Request& request, const Model& model);

// 202 with the job and its address.
Response job_response(const RouteContext& context, JobId job);

// Slug of a wish or of the name; a wished slug of digits only is refused.
Result<std::string> slug_of(const std::optional<std::string>& wish, const std::string& name);

}  // namespace strata::net
