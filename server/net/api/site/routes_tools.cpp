#include "core/mapped_file.h"
#include "core/text/slug.h"
#include "domain/people/role.h"
#include "domain/scene/tool.h"
#include "media/picture.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/live/live_sockets.h"
#include "net/transport/server_options.h"
#include "store/content/projects.h"
#include "store/content/tools.h"
#include "store/store.h"

namespace strata::net {
namespace {

constexpr std::uint64_t kMaxPicture_bytes = std::uint64_t{8} << 20;
constexpr int kMaxPictureSide_px = 2048;
constexpr std::size_t kMaxToolNameLength = 200;

using Event = protocol::ToolEventEvent;

void tell_everyone(const RouteContext& context, Event event, const Tool& tool) {
  protocol::ToolEvent message;
  message.event = event;
  message.tool_id = tool.id.number();
  if (event != Event::deleted) message.tool = to_json(tool);
  context.live_sockets.tell_all(message);
}

Result<Response> list_tools(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request, kMaxPage));
  auto tools = STRATA_TRY(context.store.tools().all());
  const auto part = STRATA_TRY(slice_by_name(page, tools, context.store, [](const Tool& tool) {
    return store::NamedId{tool.name, tool.id.number()};
  }));
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = part.begin; i < part.end; ++i) list.push_back(to_json(tools[i]));
  Response response = json_response({{"tools", list}, {"total", tools.size()}});
  add_page_links(response, request, page, part.last);
  return response;
}

Result<std::string> name_of(const Request& request) {
  std::string name = request.query_or("name", {});
  if (name.empty() || name.size() > kMaxToolNameLength)
    return fail(ErrorCode::invalid, "Invalid name",
                "The name of a tool must be 1 to 200 bytes long.", "name");
  return name;
}

Result<std::optional<ShapePart>> part_of(const Request& request) {
  const std::string part = request.query_or("part", {});
  if (part.empty()) return std::nullopt;
  if (part == "opaque") return ShapePart::opaque;
  if (part == "light") return ShapePart::light;
  if (part == "dark") return ShapePart::dark;
  return fail(ErrorCode::invalid, "Unknown part", "`part` must be opaque, light or dark.", "part");
}

Result<Response> create_tool(const RouteContext& context, const Request& request) {
  Tool tool;
  auto name = STRATA_TRY(name_of(request));
  tool.name = std::move(name);
  const auto part = STRATA_TRY(part_of(request));
  const auto body = MappedFile::open(request.body_file);
  if (!body || body->bytes().empty())
    return fail(ErrorCode::malformed, "Empty body",
                "The request has no body. Send a picture as the body: PNG, JPEG, TIFF, WebP, "
                "BMP or TGA.",
                "body");
  const auto picture = decode_picture(body->bytes(), kMaxPictureSide_px);
  if (!picture) return tl::unexpected(picture.error());
  const auto shape = STRATA_TRY(shape_of(*picture, part));
  const auto answer = [](const Tool& made) {
    return json_response(to_json(made), 201)
        .with("Location", "/api/v1/tools/" + made.slug)
        .with("ETag", etag_of(made.version));
  };
  auto created = STRATA_TRY(
      context.store.tools().create(tool, shape, idempotent_response<Tool>(request, answer)));
  tell_everyone(context, Event::created, created);
  return answer(created);
}

// Returns a tool that is not deleted and can therefore be changed.
Result<Tool> present_tool(const RouteContext& context, const Request& request) {
  auto tool = context.store.tools().find(request.param("tool"));
  if (tool && tool->deleted)
    return fail(ErrorCode::not_found, "Tool deleted",
                "The tool `" + tool->name +
                    "` was deleted. You can still read it, but you cannot change it.");
  if (!tool) return tool;
  STRATA_TRY(check_if_match(request, tool->version));
  return tool;
}

Result<Response> rename_tool(const RouteContext& context, const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::ToolPatch>(request));
  auto tool = STRATA_TRY(present_tool(context, request));
  tool.name = body.name;
  const auto answer = [](const Tool& now) {
    return json_response(to_json(now)).with("ETag", etag_of(now.version));
  };
  auto changed =
      STRATA_TRY(context.store.tools().update(tool, idempotent_response<Tool>(request, answer)));
  tell_everyone(context, Event::changed, changed);
  return answer(changed);
}

Result<Response> delete_tool(const RouteContext& context, const Request& request) {
  auto tool = STRATA_TRY(present_tool(context, request));
  STRATA_TRY(context.store.tools().remove(
      tool.id, idempotent_response<>(request, [] { return empty_response(204); })));
  tell_everyone(context, Event::deleted, tool);
  return empty_response(204);
}

Result<Response> tool_picture(const RouteContext& context, const Request& request) {
  auto tool = STRATA_TRY(context.store.tools().find(request.param("tool")));
  auto shape = STRATA_TRY(context.store.tools().shape(tool.id));
  const Picture picture = picture_of(shape);
  Response response =
      bytes_response(encode_png(picture.rgba, picture.width, picture.height), "image/png");
  // An id always refers to the same brush shape. A slug may later refer to another shape.
  if (is_all_digits(request.param("tool")))
    response.with("Cache-Control", "private, max-age=31536000, immutable");
  return response;
}

}  // namespace

void add_tool_routes(Router& router, const RouteContext& context) {
  const std::string tools = "/api/v1/tools";
  router.add({.method = Method::get,
              .pattern = tools,
              .handler = answering(
                  [&context](const Request& request) { return list_tools(context, request); }),
              .role = Role::guest,
              .query = {"limit", "offset", "after"}});
  router.add({.method = Method::post,
              .pattern = tools,
              .handler = answering(
                  [&context](const Request& request) { return create_tool(context, request); }),
              .role = Role::annotator,
              .query = {"name", "part"},
              .check = [](const Request& request) -> Result<void> {
                STRATA_TRY(name_of(request));
                STRATA_TRY(part_of(request));
                return {};
              },
              .body = BodyKind::file,
              .max_body = std::min(kMaxPicture_bytes, context.options.max_upload_bytes),
              .keeps_answer = true});
  router.add({.method = Method::get,
              .pattern = tools + "/{tool}",
              .handler = answering([&context](const Request& request) -> Result<Response> {
                auto tool = STRATA_TRY(context.store.tools().find(request.param("tool")));
                return with_etag(json_response(to_json(tool)), request, tool.version);
              }),
              .role = Role::guest});
  router.add({.method = Method::patch,
              .pattern = tools + "/{tool}",
              .handler = answering(
                  [&context](const Request& request) { return rename_tool(context, request); }),
              .role = Role::curator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .keeps_answer = true});
  router.add({.method = Method::remove,
              .pattern = tools + "/{tool}",
              .handler = answering(
                  [&context](const Request& request) { return delete_tool(context, request); }),
              .role = Role::curator,
              .keeps_answer = true});
  router.add({.method = Method::get,
              .pattern = tools + "/{tool}/picture",
              .handler = answering(
                  [&context](const Request& request) { return tool_picture(context, request); }),
              .role = Role::guest});
}

}  // namespace strata::net
