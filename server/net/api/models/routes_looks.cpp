#include <algorithm>
#include <span>
#include <vector>

#include "core/mapped_file.h"
#include "core/memory_ledger.h"
#include "domain/people/role.h"
#include "domain/scene/look.h"
#include "media/picture.h"
#include "media/thumbnail.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/transport/server_options.h"
#include "room/looks.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/content/looks.h"
#include "store/content/models.h"
#include "store/store.h"

namespace strata::net {
namespace {

constexpr std::uint64_t kLargestLook_bytes = std::uint64_t{256} << 20;

Result<Look> stored_look(const RouteContext& context, const Request& request) {
  auto model = STRATA_TRY(context.store.models().find(request.param("model")));
  return context.store.looks().find(model.id, request.param("look"));
}

Result<Response> list_looks(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request, kMaxPage));
  auto model = STRATA_TRY(context.store.models().find(request.param("model")));
  auto looks = STRATA_TRY(context.store.looks().of_model(model.id));
  const auto part = STRATA_TRY(slice_by(page, looks, [](const Look& look) {
    return NumberKey{look.order, look.id};
  }));
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = part.begin; i < part.end; ++i) list.push_back(to_json(looks[i]));
  Response response = json_response({{"looks", list}, {"total", looks.size()}});
  add_page_links(response, request, page, part.last);
  return response;
}

// All but the picture, from the query.
Result<Look> new_look(const Request& request) {
  Look look;
  look.name = request.query_or("name", {});
  if (look.name.empty() || look.name.size() > 200)
    return fail(ErrorCode::invalid, "Name missing", "A look has a name of 1 to 200 bytes.", "name");
  look.description = request.query_or("description", {});
  const std::string visible = request.query_or("visible", "false");
  if (visible != "true" && visible != "false")
    return fail(ErrorCode::invalid, "Neither true nor false", "`visible` is true or false.",
                "visible");
  look.visible = visible == "true";
  return look;
}

Result<Response> create_look(const RouteContext& context, const Request& request) {
  auto look = STRATA_TRY(new_look(request));
  const auto body = MappedFile::open(request.body_file);
  if (!body || body->bytes().empty())
    return fail(ErrorCode::malformed, "Empty body",
                "Send a picture as the body: JPEG, PNG, TIFF, WebP, BMP or TGA.", "body");
  std::span<const std::uint8_t> picture = body->bytes();
  const auto info = STRATA_TRY(inspect_picture(picture));
  look.width = info.width;
  look.height = info.height;
  const bool stays = is_look_format(info.format);
  look.media_type = media_type(stays ? info.format : PictureFormat::png);
  // Whole, so that what cannot be shown is told now.
  const auto memory = STRATA_TRY(context.rooms.memory().reserve(
      std::uint64_t{stays ? 4u : 8u} * static_cast<std::uint64_t>(info.width) *
          static_cast<std::uint64_t>(info.height),
      "the picture of a new look"));
  auto decoded = STRATA_TRY(decode_picture(picture));
  std::vector<std::uint8_t> as_png;
  if (!stays) {
    as_png = encode_png(decoded.rgba, decoded.width, decoded.height);
    picture = as_png;
  }
  decoded.rgba = {};
  auto room = STRATA_TRY(context.rooms.open(request.param("model"), request.role()));
  const auto looks = room->looks().all();
  look.order = looks.empty() ? 0 : looks.back().order + 1;
  const auto answer = [model = room->model().slug](const Look& made) {
    return json_response(to_json(made), 201)
        .with("Location", "/api/v1/models/" + model + "/looks/" + made.slug)
        .with("ETag", etag_of(made.version));
  };
  auto created =
      room->looks().create(std::move(look), picture, first_answer<Look>(request, answer));
  if (!created) return tl::unexpected(created.error());
  return answer(*created);
}

Result<Response> change_look(const RouteContext& context, const Request& request) {
  auto asked = STRATA_TRY(body_of<protocol::LookPatch>(request));
  auto look = STRATA_TRY(stored_look(context, request));
  auto room = STRATA_TRY(context.rooms.open(request.param("model"), request.role()));
  STRATA_TRY(check_if_match(request, look.version));
  if (asked.name) look.name = *asked.name;
  if (asked.description) look.description = *asked.description;
  if (asked.opacity) look.opacity = *asked.opacity;
  if (asked.visible) look.visible = *asked.visible;
  if (asked.order) look.order = *asked.order;
  const auto answer = [](const Look& now) {
    return json_response(to_json(now)).with("ETag", etag_of(now.version));
  };
  auto changed = room->looks().update(look, first_answer<Look>(request, answer));
  if (!changed) return tl::unexpected(changed.error());
  return answer(*changed);
}

Result<Response> delete_look(const RouteContext& context, const Request& request) {
  auto look = STRATA_TRY(stored_look(context, request));
  auto room = STRATA_TRY(context.rooms.open(request.param("model"), request.role()));
  STRATA_TRY(check_if_match(request, look.version));
  auto gone =
      room->looks().erase(look.id, first_answer<>(request, [] { return empty_response(204); }));
  if (!gone) return tl::unexpected(gone.error());
  return empty_response(204);
}

Result<Response> look_picture(const RouteContext& context, const Request& request) {
  auto model = STRATA_TRY(context.store.models().find(request.param("model")));
  auto look = STRATA_TRY(context.store.looks().find(model.id, request.param("look")));
  std::optional<int> side;
  if (const std::string text = request.query_or("thumbnail", {}); !text.empty()) {
    auto number = STRATA_TRY(parse_integer(text, 16, 1024, "thumbnail"));
    side = static_cast<int>(number);
  }
  // In full the pictures of a scan are as good as its files.
  if (!side) STRATA_TRY(check_source_download(request, model));
  auto bytes = STRATA_TRY(context.store.looks().picture(look.id));
  if (!side) return bytes_response(std::move(bytes), look.media_type);
  constexpr std::int64_t kAnyLook = std::int64_t{kLargestPictureSide} * kLargestPictureSide;
  auto picture = STRATA_TRY(make_thumbnail(bytes, *side, {kAnyLook, kAnyLook}));
  return bytes_response(std::move(picture), "image/jpeg");
}

}  // namespace

void add_look_routes(Router& router, const RouteContext& context) {
  const std::string looks = "/api/v1/models/{model}/looks";
  router.add({.method = Method::get,
              .pattern = looks,
              .handler = answering(
                  [&context](const Request& request) { return list_looks(context, request); }),
              .query = {"limit", "offset", "after"}});
  router.add({.method = Method::post,
              .pattern = looks,
              .handler = answering(
                  [&context](const Request& request) { return create_look(context, request); }),
              .role = Role::curator,
              .query = {"name", "description", "visible"},
              .check = [](const Request& request) -> Result<void> {
                auto look = new_look(request);
                return look ? Result<void>{} : tl::unexpected(look.error());
              },
              .body = BodyKind::file,
              .max_body = std::min(kLargestLook_bytes, context.options.max_upload_bytes),
              .keeps_answer = true});
  router.add({.method = Method::get,
              .pattern = looks + "/{look}",
              .handler = answering([&context](const Request& request) -> Result<Response> {
                auto look = STRATA_TRY(stored_look(context, request));
                return with_etag(json_response(to_json(look)), request, look.version);
              })});
  router.add({.method = Method::patch,
              .pattern = looks + "/{look}",
              .handler = answering(
                  [&context](const Request& request) { return change_look(context, request); }),
              .role = Role::curator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .keeps_answer = true,
              .needs_version = true});
  router.add({.method = Method::remove,
              .pattern = looks + "/{look}",
              .handler = answering(
                  [&context](const Request& request) { return delete_look(context, request); }),
              .role = Role::curator,
              .keeps_answer = true,
              .needs_version = true});
  router.add({.method = Method::get,
              .pattern = looks + "/{look}/picture",
              .handler = answering(
                  [&context](const Request& request) { return look_picture(context, request); }),
              .query = {"thumbnail"},
              .state = state_of_look(context)});
}

}  // namespace strata::net
