#include "net/http/entity_tags.h"

#include <set>

#include "core/digest.h"
#include "core/text/ascii.h"
#include "core/uuid.h"
#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "domain/scene/surface_image.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/auth/project_authorization.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/room.h"
#include "room/rooms.h"
#include "room/surface_images.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/content/objects.h"
#include "store/content/projects.h"
#include "store/content/surface_images.h"
#include "store/store.h"

namespace strata::net {
namespace {

constexpr std::size_t kMaxHashedBytes = 4u << 20;
constexpr std::size_t kTagDigits = 32;

std::string tag_of(std::string_view text) {
  return '"' + sha256_hex(text).substr(0, kTagDigits) + '"';
}

std::string_view without_weakness(std::string_view tag) {
  if (tag.starts_with("W/")) tag.remove_prefix(2);
  return tag;
}

// Writes the length before each part, so different lists of parts cannot have the same text.
void add(std::string& text, std::string_view part) {
  text.append(std::to_string(part.size())).append(":").append(part);
}
void add(std::string& text, std::int64_t number) {
  text.append(std::to_string(number)).append(",");
}
template <class Kind>
void add(std::string& text, Id<Kind> id) {
  add(text, id.number());
}

// Returns the sequence in the query parameter `at`.
std::optional<std::int64_t> past_sequence(const Request& request) {
  const auto at = request.query.find("at");
  if (at == request.query.end()) return std::nullopt;
  const auto sequence = parse_integer(at->second, 0, INT64_MAX, "at");
  return sequence ? std::optional(*sequence) : std::nullopt;
}

// Adds the state of the room, which follows the database with a short delay. If `past` is set, the
// response shows that sequence instead of the newest one.
bool add_room(std::string& text, const room::Room& room, std::optional<std::int64_t> past = {}) {
  const std::int64_t durable = room.edits().durable_sequence();
  const bool is_past = past && *past <= durable;
  if (!is_past && room.edits().sequence() != durable) return false;
  const Model model = room.model();
  add(text, model.id);
  add(text, model.version);
  add(text, is_past ? *past : durable);
  for (const Layer& layer : room.layers().all()) {
    add(text, layer.id);
    add(text, layer.version);
    // The palette may depend on terms, and their records change independently of the layer.
    add(text, to_json(layer).at("palette").dump());
  }
  text += ';';
  for (const SurfaceImage& image : room.surface_images().all()) {
    add(text, image.id);
    add(text, image.version);
  }
  text += ';';
  return true;
}

bool add_project(std::string& text, const RouteContext& context, ProjectId project) {
  const auto state = context.store.projects().state(project);
  if (!state) return false;
  add(text, *state);
  return true;
}

std::optional<std::string> model_state(const RouteContext& context, const Request& request,
                                       std::optional<std::int64_t> past = {}) {
  const auto room = open_room(context, request);
  std::string text;
  if (!room || !add_room(text, **room, past) ||
      !add_project(text, context, (*room)->model().project_id))
    return std::nullopt;
  return text;
}

}  // namespace

bool names_tag(std::string_view if_none_match, std::string_view etag) {
  if (etag.empty()) return false;
  while (!if_none_match.empty()) {
    const auto comma = if_none_match.find(',');
    const auto one = trimmed(if_none_match.substr(0, comma));
    if (one == "*" || without_weakness(one) == without_weakness(etag)) return true;
    if_none_match.remove_prefix(comma == std::string_view::npos ? if_none_match.size() : comma + 1);
  }
  return false;
}

Response not_modified(const Response& response) {
  Response unchanged = empty_response(304);
  for (const auto& [name, value] : response.headers) {
    const std::string lower = to_lower(name);
    if (!lower.starts_with("content-") && lower != "accept-ranges") unchanged.with(name, value);
  }
  return unchanged;
}

std::optional<std::string> tag_of_body(const Response& response) {
  const bool is_in_memory = response.file.empty() && !response.stream && !response.events;
  const std::size_t size = response.bytes.empty() ? response.body.size() : response.bytes.size();
  if (!is_in_memory || size == 0 || size > kMaxHashedBytes) return std::nullopt;
  if (!response.header("ETag").empty() || !response.header("Cache-Control").empty())
    return std::nullopt;
  if (response.bytes.empty()) return tag_of(response.body);
  return tag_of({reinterpret_cast<const char*>(response.bytes.data()), size});
}

std::string tag_of_state(const Request& request, std::string_view state) {
  static const std::string run = to_string(random_uuid());
  std::string text = run;
  if (request.principal) {
    add(text, request.principal->user);
    add(text, name(request.principal->role));
    add(text, request.principal->kiosk ? request.principal->kiosk->id : KioskId());
  }
  for (const std::string& segment : request.segments) add(text, segment);
  text += '?';
  for (const auto& [key, value] : request.query) {
    add(text, key);
    add(text, value);
  }
  add(text, request.header("accept"));
  add(text, state);
  return tag_of(text);
}

StateOf state_of_model(const RouteContext& context) {
  return [&context](const Request& request) {
    return model_state(context, request, past_sequence(request));
  };
}

StateOf state_of_records(const RouteContext& context) {
  return [&context](const Request& request) -> std::optional<std::string> {
    if (request.params.contains("layer")) return model_state(context, request);
    const auto table = stored_table(context, request);
    std::string text;
    if (!table || !add_project(text, context, table->project_id)) return std::nullopt;
    return text;
  };
}

StateOf state_of_painted_table(const RouteContext& context) {
  return [&context](const Request& request) -> std::optional<std::string> {
    const auto table = stored_table(context, request);
    if (!table) return std::nullopt;
    const auto layers = context.store.layers().of_table(table->id, request.role());
    if (!layers) return std::nullopt;
    std::set<ModelId> models;
    std::string text;
    for (const Layer& layer : *layers) {
      add(text, layer.id);
      if (layer.sequence > 0) models.insert(layer.model_id);  // only painted layers
    }
    for (const ModelId model : models) {
      const auto room = context.rooms.open(to_string(model), request.role());
      if (!room || !add_room(text, **room)) return std::nullopt;
    }
    return add_project(text, context, table->project_id) ? std::optional(std::move(text))
                                                         : std::nullopt;
  };
}

StateOf state_of_surveys(const RouteContext& context) {
  return [&context](const Request& request) -> std::optional<std::string> {
    const auto project = stored_project(context, request);
    const auto id = id_of<ObjectId>(request, "object");
    if (!project || !id) return std::nullopt;
    const auto object = context.store.objects().find(project->id, *id);
    if (!object) return std::nullopt;
    std::string text;
    add(text, object->id);
    add(text, object->version);
    for (const Survey& survey : object->surveys) {
      const auto model = context.store.models().find(to_string(survey.model));
      if (!model) return std::nullopt;
      const auto shown = context.rooms.shown_sequence(to_string(survey.model));
      if (shown.value_or(model->sequence) != model->sequence) return std::nullopt;
      add(text, model->id);
      add(text, model->version);
      add(text, model->sequence);
    }
    return add_project(text, context, project->id) ? std::optional(std::move(text)) : std::nullopt;
  };
}

StateOf state_of_surface_image(const RouteContext& context) {
  return [&context](const Request& request) -> std::optional<std::string> {
    const auto model = stored_model(context, request);
    if (!model) return std::nullopt;
    const auto image = context.store.surface_images().find(model->id, request.param("look"));
    if (!image) return std::nullopt;
    std::string text;
    add(text, model->id);
    add(text, model->version);
    add(text, image->id);
    return text;
  };
}

}  // namespace strata::net
