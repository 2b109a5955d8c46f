#include "net/api/route_help.h"

#include "app/records/painted_keys.h"
#include "core/digest.h"
#include "core/text/slug.h"
#include "core/text/timestamp.h"
#include "core/uuid.h"
#include "jobs/job_queue.h"
#include "net/api/metrics.h"
#include "net/http/edit_idempotency.h"
#include "net/serialization/job_serialization.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/room.h"
#include "store/store.h"

namespace strata::net {
namespace {
constexpr int kMaxTries = 50;  // exceeds the simultaneous changes to one entity
constexpr std::size_t kDigitsOfBody = 16;
}  // namespace

Handler answering(std::function<Result<Response>(const Request&)> answer) {
  return [answer = std::move(answer)](const Request& request, const Respond& respond) {
    auto response = answer(request);
    // A change without a version applies to the newest version. If other users change the entity at
    // the same time, the change is tried again. At each try, one of the simultaneous changes
    // succeeds.
    const auto if_match = request.header("if-match");
    const bool means_any = (request.method == Method::patch || request.method == Method::remove) &&
                           (if_match.empty() || if_match == "*");
    for (int tries = 1;
         means_any && tries < kMaxTries && !response && response.error().code == ErrorCode::stale;
         ++tries)
      response = answer(request);
    if (response)
      respond(std::move(*response));
    else
      respond(response.error());
  };
}

Result<void> check_json_type(const Request& request) {
  const auto sent = request.header("content-type");
  std::string type = to_lower(sent.substr(0, sent.find(';')));
  while (!type.empty() && type.back() == ' ') type.pop_back();
  if (type.empty() || type == "application/json" ||
      (type.starts_with("application/") && type.ends_with("+json")))
    return {};
  return fail(ErrorCode::unsupported, "Not JSON",
              "This address accepts only JSON. Send JSON with `Content-Type: application/json`.",
              "Content-Type");
}

std::string etag_of(std::int64_t version) { return "\"v" + std::to_string(version) + "\""; }

Response with_etag(Response response, const Request& request, std::int64_t version) {
  std::string etag = etag_of(version);
  if (request.method != Method::get && request.method != Method::head)
    return response.with("ETag", etag);
  // The content of one version differs between roles, and it changes after the first edit.
  etag.insert(etag.size() - 1, "." + sha256_hex(response.body).substr(0, kDigitsOfBody));
  if (names_tag(request.header("if-none-match"), etag))
    return empty_response(304).with("ETag", etag);
  return response.with("ETag", etag);
}

namespace {
// Also accepts the ETags of `with_etag`, which have a suffix after the version.
bool names_version(std::string_view etag, std::int64_t version) {
  const std::string own = etag_of(version), beginning = own.substr(0, own.size() - 1) + ".";
  return etag == own || (etag.starts_with(beginning) && etag.ends_with('"'));
}
}  // namespace

Result<void> check_if_match(const Request& request, std::int64_t version) {
  const auto if_match = request.header("if-match");
  if (if_match.empty() || if_match == "*" || names_version(if_match, version)) return {};
  return fail(ErrorCode::stale, "Changed by somebody else",
              "Somebody changed this after you read it. Read it again and repeat your change.",
              "If-Match");
}

void add_sequences(Response& response, std::int64_t shown, std::int64_t durable) {
  response.with("Strata-Sequence", std::to_string(shown))
      .with("Strata-Durable-Sequence", std::to_string(durable));
}

Uuid edit_id(const Request& request, const Layer& layer, std::string_view operation) {
  const auto key = request.header("idempotency-key");
  if (key.empty()) return random_uuid();
  return uuid_of_text(request.user() + '\n' + to_string(layer.id) + '\n' + std::string(operation) +
                      '\n' + std::string(key));
}

void apply_edit(const RouteContext& context, const Request& request,
                const std::shared_ptr<room::Room>& room, room::EditRequest edit,
                const Respond& respond, std::function<nlohmann::json(nlohmann::json)> body_of) {
  const auto layer = room->layers().find(to_string(edit.layer_id));
  if (!layer) return respond(layer.error());
  if (auto known = app::check_keys(context.store, *layer, room::painted_by(*layer, edit)); !known)
    return respond(known.error());
  if (Question* question = Question::current()) edit.question = question->shared_from_this();
  edit.trace = request.trace.trace;
  const bool keyed = !request.header("idempotency-key").empty();
  if (keyed)
    if (auto same = context.edit_idempotency.begin(room->model().id, edit); !same)
      return respond(same.error());
  const Uuid id = edit.id;
  room->edits().submit(
      std::move(edit),
      [&metrics = context.metrics](const room::EditAnswer& answer) {
        if (!answer.repeated) ++metrics.edits.applied;
      },
      [&context, keyed, id, respond,
       body_of = std::move(body_of)](Result<room::EditAnswer> answer) {
        if (keyed) context.edit_idempotency.end(id);
        if (!answer) {
          ++context.metrics.edits.refused;
          return respond(answer.error());
        }
        if (!answer->repeated) ++context.metrics.edits.saved;
        respond(json_response(body_of(room::to_json(*answer)))
                    .with("Strata-Sequence", std::to_string(answer->sequence)));
      });
}

Result<std::vector<Layer>> find_layers(const room::Room& room, const std::vector<std::string>& refs,
                                       const std::string& field) {
  std::vector<Layer> layers;
  for (const auto& ref : refs) {
    auto layer = room.layers().find(ref);
    if (!layer) {
      Error problem = layer.error();
      problem.field = field;
      return tl::unexpected(std::move(problem));
    }
    layers.push_back(std::move(*layer));
  }
  return layers;
}

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (end > begin) parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

Result<void> check_source_download(const Request& request, const Model& model) {
  if (request.role() >= model.source_download) return {};
  return fail(
      ErrorCode::forbidden, "Download not allowed",
      "To download the files of this scan, you need the role " +
          std::string(name(model.source_download)) +
          " or a higher role in its project. Curators can allow other roles (`source_download`).");
}

Response job_response(const RouteContext& context, JobId job) {
  const auto status = context.jobs.status(job);
  return json_response(status ? to_json(*status)
                              : nlohmann::json{{"id", job},
                                               {"state", "queued"},
                                               {"progress", 0},
                                               {"message", ""}},
                       202)
      .with("Location", "/api/v1/jobs/" + to_string(job));
}

Result<std::optional<std::string>> time_of(const Request& request, const std::string& name) {
  const auto found = request.query.find(name);
  if (found == request.query.end()) return std::nullopt;
  auto utc = utc_timestamp(found->second);
  if (!utc)
    return fail(ErrorCode::invalid, "Invalid time",
                "`" + name +
                    "` must be a time such as 2026-05-04T12:00:00Z. "
                    "Write the + of a time zone as %2B.",
                name);
  return utc;
}

Result<std::string> slug_of(const std::optional<std::string>& requested, const std::string& text) {
  if (!requested) return make_slug(text);
  if (is_all_digits(*requested))
    return fail(ErrorCode::invalid, "Slug of digits",
                "A slug cannot consist of digits only, because the server would read it as an "
                "id. Add a letter.",
                "slug");
  return *requested;
}

}  // namespace strata::net
