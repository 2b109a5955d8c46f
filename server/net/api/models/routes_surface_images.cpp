#include <algorithm>
#include <span>
#include <vector>

#include "core/mapped_file.h"
#include "core/memory_ledger.h"
#include "domain/people/role.h"
#include "domain/scene/surface_image.h"
#include "media/picture.h"
#include "media/thumbnail.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/transport/server_options.h"
#include "room/room.h"
#include "room/rooms.h"
#include "room/surface_images.h"
#include "store/content/surface_images.h"
#include "store/store.h"

namespace strata::net {
namespace {

constexpr std::uint64_t kMaxLook_bytes = std::uint64_t{256} << 20;

Result<SurfaceImage> stored_surface_image(const RouteContext& context, const Request& request) {
  auto model = STRATA_TRY(stored_model(context, request));
  return context.store.surface_images().find(model.id, request.param("look"));
}

Result<Response> list_surface_images(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request, kMaxPage));
  auto model = STRATA_TRY(stored_model(context, request));
  auto images = STRATA_TRY(context.store.surface_images().of_model(model.id));
  const auto part = STRATA_TRY(slice_by(page, images, [](const SurfaceImage& image) {
    return NumberKey{image.order, image.id.number()};
  }));
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = part.begin; i < part.end; ++i) list.push_back(to_json(images[i]));
  Response response = json_response({{"looks", list}, {"total", images.size()}});
  add_page_links(response, request, page, part.last);
  return response;
}

// Reads all properties except the image itself from the query.
Result<SurfaceImage> new_surface_image(const Request& request) {
  SurfaceImage image;
  image.name = request.query_or("name", {});
  if (image.name.empty() || image.name.size() > 200)
    return fail(ErrorCode::invalid, "Invalid name",
                "The name of a surface image must be 1 to 200 bytes long.", "name");
  image.description = request.query_or("description", {});
  const std::string visible = request.query_or("visible", "false");
  if (visible != "true" && visible != "false")
    return fail(ErrorCode::invalid, "Not true or false", "`visible` must be true or false.",
                "visible");
  image.visible = visible == "true";
  return image;
}

Result<Response> create_surface_image(const RouteContext& context, const Request& request) {
  auto image = STRATA_TRY(new_surface_image(request));
  const auto body = MappedFile::open(request.body_file);
  if (!body || body->bytes().empty())
    return fail(ErrorCode::malformed, "Empty body",
                "The request has no body. Send a picture as the body: JPEG, PNG, TIFF, WebP, "
                "BMP or TGA.",
                "body");
  std::span<const std::uint8_t> picture = body->bytes();
  const auto info = STRATA_TRY(inspect_picture(picture));
  image.width = info.width;
  image.height = info.height;
  const bool stays = is_surface_image_format(info.format);
  image.media_type = media_type(stays ? info.format : PictureFormat::png);
  // Decodes the whole image to refuse an image that cannot be shown.
  const auto memory = STRATA_TRY(context.rooms.memory().reserve(
      std::uint64_t{stays ? 4u : 8u} * static_cast<std::uint64_t>(info.width) *
          static_cast<std::uint64_t>(info.height),
      "the picture of a new surface image"));
  auto decoded = STRATA_TRY(decode_picture(picture));
  std::vector<std::uint8_t> as_png;
  if (!stays) {
    as_png = encode_png(decoded.rgba, decoded.width, decoded.height);
    picture = as_png;
  }
  decoded.rgba = {};
  auto room = STRATA_TRY(open_room(context, request));
  const auto images = room->surface_images().all();
  image.order = images.empty() ? 0 : images.back().order + 1;
  const auto answer = [model = room->model().slug](const SurfaceImage& made) {
    return json_response(to_json(made), 201)
        .with("Location", "/api/v1/models/" + model + "/looks/" + made.slug)
        .with("ETag", etag_of(made.version));
  };
  auto created = room->surface_images().create(std::move(image), picture,
                                               idempotent_response<SurfaceImage>(request, answer));
  if (!created) return tl::unexpected(created.error());
  return answer(*created);
}

Result<Response> change_surface_image(const RouteContext& context, const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::LookPatch>(request));
  auto image = STRATA_TRY(stored_surface_image(context, request));
  auto room = STRATA_TRY(open_room(context, request));
  STRATA_TRY(check_if_match(request, image.version));
  if (body.name) image.name = *body.name;
  if (body.description) image.description = *body.description;
  if (body.opacity) image.opacity = *body.opacity;
  if (body.visible) image.visible = *body.visible;
  if (body.order) image.order = *body.order;
  const auto answer = [](const SurfaceImage& now) {
    return json_response(to_json(now)).with("ETag", etag_of(now.version));
  };
  auto changed =
      room->surface_images().update(image, idempotent_response<SurfaceImage>(request, answer));
  if (!changed) return tl::unexpected(changed.error());
  return answer(*changed);
}

Result<Response> delete_surface_image(const RouteContext& context, const Request& request) {
  auto image = STRATA_TRY(stored_surface_image(context, request));
  auto room = STRATA_TRY(open_room(context, request));
  STRATA_TRY(check_if_match(request, image.version));
  auto gone = room->surface_images().erase(
      image.id, idempotent_response<>(request, [] { return empty_response(204); }));
  if (!gone) return tl::unexpected(gone.error());
  return empty_response(204);
}

Result<Response> surface_image_picture(const RouteContext& context, const Request& request) {
  auto model = STRATA_TRY(stored_model(context, request));
  auto image = STRATA_TRY(context.store.surface_images().find(model.id, request.param("look")));
  std::optional<int> side;
  if (const std::string text = request.query_or("thumbnail", {}); !text.empty()) {
    auto number = STRATA_TRY(parse_integer(text, 16, 1024, "thumbnail"));
    side = static_cast<int>(number);
  }
  // A full-size image of a scan contains the same data as its file.
  if (!side) STRATA_TRY(check_source_download(request, model));
  auto bytes = STRATA_TRY(context.store.surface_images().picture(image.id));
  if (!side) return bytes_response(std::move(bytes), image.media_type);
  constexpr std::int64_t kAnySurfaceImage = std::int64_t{kMaxPictureSide} * kMaxPictureSide;
  auto picture = STRATA_TRY(make_thumbnail(bytes, *side, {kAnySurfaceImage, kAnySurfaceImage}));
  return bytes_response(std::move(picture), "image/jpeg");
}

}  // namespace

void add_surface_image_routes(Router& router, const RouteContext& context) {
  const std::string images = "/api/v1/models/{model}/looks";
  router.add({.method = Method::get,
              .pattern = images,
              .handler = answering([&context](const Request& request) {
                return list_surface_images(context, request);
              }),
              .query = {"limit", "offset", "after"}});
  router.add({.method = Method::post,
              .pattern = images,
              .handler = answering([&context](const Request& request) {
                return create_surface_image(context, request);
              }),
              .role = Role::curator,
              .query = {"name", "description", "visible"},
              .check = [](const Request& request) -> Result<void> {
                auto image = new_surface_image(request);
                return image ? Result<void>{} : tl::unexpected(image.error());
              },
              .body = BodyKind::file,
              .max_body = std::min(kMaxLook_bytes, context.options.max_upload_bytes),
              .keeps_answer = true});
  router.add({.method = Method::get,
              .pattern = images + "/{look}",
              .handler = answering([&context](const Request& request) -> Result<Response> {
                auto image = STRATA_TRY(stored_surface_image(context, request));
                return with_etag(json_response(to_json(image)), request, image.version);
              })});
  router.add({.method = Method::patch,
              .pattern = images + "/{look}",
              .handler = answering([&context](const Request& request) {
                return change_surface_image(context, request);
              }),
              .role = Role::curator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .keeps_answer = true,
              .needs_version = true});
  router.add({.method = Method::remove,
              .pattern = images + "/{look}",
              .handler = answering([&context](const Request& request) {
                return delete_surface_image(context, request);
              }),
              .role = Role::curator,
              .keeps_answer = true,
              .needs_version = true});
  router.add({.method = Method::get,
              .pattern = images + "/{look}/picture",
              .handler = answering([&context](const Request& request) {
                return surface_image_picture(context, request);
              }),
              .query = {"thumbnail"},
              .state = state_of_surface_image(context)});
}

}  // namespace strata::net
