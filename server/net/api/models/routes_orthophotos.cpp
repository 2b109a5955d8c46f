// Orthophotos that are added as surface images.
#include <algorithm>
#include <bit>

#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "domain/scene/surface_image.h"
#include "jobs/job_queue.h"
#include "jobs/orthophoto.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/job_idempotency.h"
#include "net/serialization/map_query.h"
#include "net/transport/server_options.h"
#include "room/room.h"
#include "room/surface.h"
#include "room/surface_images.h"
#include "store/content/idempotent_response.h"
#include "store/store.h"

namespace strata::net {
namespace {

struct OrthophotoRequest {
  SurfaceImage image;
  app::MapAxis axis;
  int resolution = 0;
};

Result<OrthophotoRequest> orthophoto_request(const Request& request) {
  const auto axis = STRATA_TRY(map_axis(request));
  OrthophotoRequest requested{{}, axis, 0};
  requested.image.name = request.query_or("name", {});
  if (requested.image.name.empty() || requested.image.name.size() > 200)
    return fail(ErrorCode::invalid, "Invalid name",
                "The name of a surface image must be 1 to 200 bytes long.", "name");
  requested.image.description = request.query_or("description", {});
  if (const std::string text = request.query_or("resolution", {}); !text.empty()) {
    const auto resolution =
        STRATA_TRY(parse_integer(text, 1, jobs::kMaxOrthophotoSurfaceImage, "resolution"));
    requested.resolution = static_cast<int>(resolution);
    if (!std::has_single_bit(static_cast<unsigned>(requested.resolution)))
      return fail(ErrorCode::invalid, "Invalid resolution", "`resolution` must be a power of two.",
                  "resolution");
  }
  return requested;
}

Result<SurfaceImage> bake(room::Room& room, const OrthophotoRequest& requested,
                          const app::MapPicture& map,
                          const store::IdempotentResponse<SurfaceImage>& answer,
                          Progress& progress) {
  progress.report(0, "Finding the visible surface");
  const jobs::OrthophotoSampler sampler(map.picture, map.world,
                                        app::texel_area(room.model(), requested.resolution));
  if (progress.cancelled()) return cancelled_problem();
  Layer colors;  // temporary; its numbers are RGBA values
  colors.type = ValueType::u32;
  colors.resolution = requested.resolution;
  const auto tiles =
      room.surface().project(colors, requested.axis.direction, [&](const glm::dvec3& world) {
        return progress.cancelled() ? std::nullopt : sampler.color_at(requested.axis.on_map(world));
      });
  if (progress.cancelled()) return cancelled_problem();
  if (!tiles) return tl::unexpected(tiles.error());
  if (tiles->empty())
    return fail(ErrorCode::invalid, "Picture outside the model",
                "The picture does not cover any part of the model. Check its position, the "
                "direction and the unit.",
                "world");
  progress.report(0.4, "Painting the surface image");
  const auto map_of_surface = STRATA_TRY(room.surface().map(requested.resolution));
  const Picture picture = jobs::orthophoto_surface_image(*tiles, *map_of_surface);
  if (progress.cancelled()) return cancelled_problem();
  progress.report(0.6, "Packing the surface image");
  const auto png = encode_png(picture.rgba, picture.width, picture.height);
  if (progress.cancelled()) return cancelled_problem();
  progress.report(0.9, "Saving");
  SurfaceImage image = requested.image;
  image.visible = false;
  image.media_type = media_type(PictureFormat::png);
  image.width = picture.width;
  image.height = picture.height;
  const auto images = room.surface_images().all();
  image.order = images.empty() ? 0 : images.back().order + 1;
  return room.surface_images().create(std::move(image), png, answer);
}

Result<Response> start_orthophoto(const RouteContext& context, JobIdempotency& book,
                                  ByteBudget& budget, const Request& request) {
  auto known = STRATA_TRY(book.find(request));
  if (known) return std::move(job_response(context, *known).with("Idempotency-Replayed", "true"));
  auto requested = orthophoto_request(request);
  if (!requested) return tl::unexpected(requested.error());
  auto room = open_room(context, request);
  if (!room) return tl::unexpected(room.error());
  const Model model = (*room)->model();
  if (requested->resolution != 0 && requested->resolution < model.atlas.lowest_resolution)
    return fail(ErrorCode::invalid, "Resolution too low",
                "Surface images of this model must have at least " +
                    std::to_string(model.atlas.lowest_resolution) + " texels on each side.",
                "resolution");
  const auto files = STRATA_TRY(take_map(request, context.options.upload_dir));
  const auto options = STRATA_TRY(map_options(request));
  auto map = app::map_picture(options, files, model, budget);
  if (!map) return tl::unexpected(map.error());
  if (requested->resolution == 0)
    requested->resolution = jobs::orthophoto_resolution(model, map->world);

  const store::IdempotentResponse<SurfaceImage> answer{
      scoped_key(request),
      [print = fingerprint(request), model = model.id](const SurfaceImage& image) {
        return nlohmann::json{{"request", print}, {"model", model}, {"look", image.id}};
      },
      request.user()};
  auto job = context.jobs.add(
      model.project_id,
      [room = *room, requested = std::move(*requested), answer,
       map = std::make_shared<const app::MapPicture>(std::move(*map))](
          Progress& progress) -> Result<jobs::JobResult> {
        store::IdempotentResponse<SurfaceImage> stored_answer = answer;
        stored_answer.job = progress.job();
        auto image = STRATA_TRY(bake(*room, requested, *map, stored_answer, progress));
        jobs::JobResult result(image.model_id);
        result.image = image.id;
        return result;
      },
      {}, jobs::JobKind::image);
  if (!job) return tl::unexpected(job.error());
  book.started(request, *job);
  return job_response(context, *job);
}

Result<Response> repeat_orthophoto(const RouteContext& context, JobIdempotency& book,
                                   const Request& request, const nlohmann::json& stored) {
  auto known = STRATA_TRY(book.find(request));
  if (known) return job_response(context, *known);
  jobs::JobResult result(stored.at("model").get<ModelId>());
  result.image = stored.at("look").get<SurfaceImageId>();
  const auto model = STRATA_TRY(stored_model(context, request));
  auto job =
      STRATA_TRY(book.finished(request, model.project_id, std::move(result), jobs::JobKind::image));
  return job_response(context, job);
}

}  // namespace

void add_orthophoto_routes(Router& router, const RouteContext& context) {
  const auto book = std::make_shared<JobIdempotency>(context.jobs);
  const auto budget = std::make_shared<ByteBudget>(context.options.max_rasters_at_once);
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/orthophotos",
              .handler = answering([&context, book, budget](const Request& request) {
                return start_orthophoto(context, *book, *budget, request);
              }),
              .role = Role::curator,
              .query = {"name", "description", "along", "world", "resolution", "crs"},
              .check = [](const Request& request) -> Result<void> {
                auto requested = orthophoto_request(request);
                return requested ? Result<void>{} : tl::unexpected(requested.error());
              },
              .body = BodyKind::file,
              .max_body = kMaxMapBytes,
              .keeps_answer = true,
              .replay =
                  [&context, book](const Request& request, const nlohmann::json& stored) {
                    return repeat_orthophoto(context, *book, request, stored);
                  }});
}

}  // namespace strata::net
