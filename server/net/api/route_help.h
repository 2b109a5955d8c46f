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

// Functions that the files with routes share.
namespace strata::net {

// Returns a handler that calls `answer` and sends its result.
Handler answering(std::function<Result<Response>(const Request&)> answer);

// Returns 415 if the body declares a type other than JSON. Without a Content-Type, the server
// assumes the type that the route accepts.
Result<void> check_json_type(const Request& request);

template <class T>
Result<T> body_of(const Request& request, std::uint64_t max_bytes = 1u << 20) {
  STRATA_TRY(check_json_type(request));
  return protocol::parse<T>(request.body, {static_cast<std::size_t>(max_bytes), 32});
}

// ETags for versions of metadata, such as "v7". `with_etag` evaluates `If-None-Match` of a read.
// `check_if_match` evaluates `If-Match` of a change: an absent header allows any version, and an
// old version causes 412.
std::string etag_of(std::int64_t version);
Response with_etag(Response response, const Request& request, std::int64_t version);
Result<void> check_if_match(const Request& request, std::int64_t version);

// Adds the headers Strata-Sequence, the sequence that a read shows, and Strata-Durable-Sequence,
// the last durable sequence.
void add_sequences(Response& response, std::int64_t shown, std::int64_t durable);

// Returns the id of the edit. It is derived from the Idempotency-Key, so a repeated call gets the
// first result from the journal. Without a key, the id is random. `operation` is the kind of call.
// The result is the same for the id and the slug of the layer in the address.
Uuid edit_id(const Request& request, const Layer& layer, std::string_view operation);
// Submits the edit to the room and responds when the edit is durable or refused. Refuses a key that
// belongs to another edit. `body_of` converts the result of the edit to the body of the response.
void apply_edit(
    const RouteContext& context, const Request& request, const std::shared_ptr<room::Room>& room,
    room::EditRequest edit, const Respond& respond,
    std::function<nlohmann::json(nlohmann::json)> body_of = [](const nlohmann::json& of_edit) {
      return of_edit;
    });

// Finds layers by id or slug. The error for a missing layer names `field`.
Result<std::vector<Layer>> find_layers(const room::Room& room, const std::vector<std::string>& refs,
                                       const std::string& field);
std::vector<std::string> split_list(const std::string& text);  // splits at commas; no empty parts

// Return the same response as `GET /me`. The second function adds the cookie of a new session.
Result<Response> who_is_signed_in(const RouteContext& context, const std::string& user, Role role);
Result<Response> signed_in(const RouteContext& context, const Request& request,
                           const std::string& session);
// Returns 403 for a token for scripts. Such a token must not change accounts because its effects
// must end with the token.
Result<void> check_no_script(const Request& request);
// Clears the cached roles of these users and closes their live connections. Clients that still have
// access reconnect automatically.
void roles_changed(const RouteContext& context, const std::vector<std::string>& people);
// Closes the live connections of the kiosks and clears their cached links.
void end_kiosks(const RouteContext& context, const std::vector<KioskId>& kiosks,
                const std::string& reason);
// Returns 403 if the site has no local accounts, whose users sign in with passwords.
Result<void> check_local_accounts(const RouteContext& context);
// Returns the author's name if the caller may see it. A kiosk gets an empty name.
std::string visible_name(const Request& request, const std::string& user);
// Returns the browser's User-Agent, which helps users to recognize their sessions.
std::string agent_of(const Request& request);

// Returns 403 if the role is lower than the model's `source_download`, which protects the files of
// the scan and equivalent data.
Result<void> check_source_download(const Request& request, const Model& model);

// Returns 202 with the job and the address of the job.
Response job_response(const RouteContext& context, JobId job);

// Returns the time in a parameter of the query as UTC (core/text/timestamp.h), and nothing if the
// parameter is absent.
Result<std::optional<std::string>> time_of(const Request& request, const std::string& name);

// Returns the requested slug, or a slug made from the name. Refuses a requested slug that contains
// only digits.
Result<std::string> slug_of(const std::optional<std::string>& requested, const std::string& name);

}  // namespace strata::net
