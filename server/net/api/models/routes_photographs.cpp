// Photographs of a model with the poses of their cameras.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/trigonometric.hpp>
#include <string>

#include "app/deposit/identifiers.h"
#include "app/photographs/photograph_cameras.h"
#include "app/photographs/pose_files.h"
#include "app/photographs/undistort.h"
#include "core/mapped_file.h"
#include "core/memory_ledger.h"
#include "core/text/utf8.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "media/jpeg_facts.h"
#include "media/photographs/match_pictures.h"
#include "media/picture.h"
#include "media/thumbnail.h"
#include "mesh/surface/geometry.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/api/stored_file.h"
#include "net/auth/project_authorization.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/http/upload.h"
#include "net/transport/server_options.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/rooms.h"
#include "room/surface.h"
#include "store/content/photographs.h"
#include "store/store.h"
#include "store/tables/attachments.h"

namespace strata::net {
namespace {

constexpr const char* kPoseUpload =
    "Send the export of the camera poses as the body: a single file, a zip, or a "
    "multipart/form-data form.";
constexpr const char* kPictureUpload = "Send the photograph as the body: JPEG, PNG or TIFF.";
constexpr std::uint64_t kMaxOriginalBytes = std::uint64_t{512} << 20;
constexpr std::size_t kMaxListed = 100;
constexpr std::size_t kMaxUnusedName = 1024;
constexpr std::size_t kMaxSearch = 200;  // characters
constexpr int kMinUndistorted = 16;
constexpr int kUsualThumbnail = 256;  // is made before the page asks for it
constexpr int kJpegQuality = 90;
constexpr double kMmPerMeter = 1000;
constexpr const char* kPhotographs = "/api/v1/models/{model}/photographs";

// --- the form in the contract

// Makes the objects of the contract for photographs of one model.
class Shown {
 public:
  explicit Shown(const Model& model) : model_(model) {}

  protocol::Photograph of(const store::Photograph& photograph) {
    protocol::Photograph shown;
    shown.id = photograph.id.number();
    shown.name = photograph.posed.name;
    shown.center = photograph.posed.pose.center;
    if (const auto size = app::size_of(photograph)) {
      shown.width = size->x;
      shown.height = size->y;
    }
    if (const app::Pinhole* pinhole = cameras_.pinhole_of(photograph))
      shown.camera =
          app::view_of(*pinhole, photograph.posed.pose, model_.bounds_min, model_.bounds_max);
    if (const auto& original = photograph.original) {
      shown.has_picture = true;
      shown.bytes = static_cast<std::int64_t>(original->bytes);
      shown.media_type = original->media_type;
    }
    if (!photograph.rights_uri.empty()) shown.rights_uri = photograph.rights_uri;
    if (!photograph.rights_holder.empty()) shown.rights_holder = photograph.rights_holder;
    return shown;
  }

  // Returns nothing for a photograph without a pinhole camera.
  std::optional<protocol::SeeingPhotograph> of(const app::SeeingPhotograph& seeing) {
    const app::Pinhole* pinhole = cameras_.pinhole_of(seeing.photograph);
    if (!pinhole) return std::nullopt;
    protocol::SeeingPhotograph shown;
    shown.pixel = seeing.place.pixel;
    shown.undistorted_pixel = app::pixel_of(*pinhole, seeing.place.direction);
    shown.mm_per_pixel = seeing.place.units_per_pixel * model_.metres() * kMmPerMeter;
    shown.angle = glm::degrees(std::acos(std::min(seeing.place.cos_angle, 1.0)));
    shown.distance_m = seeing.place.distance * model_.metres();
    shown.photograph = of(seeing.photograph);
    return shown;
  }

 private:
  const Model model_;
  app::PhotographCameras cameras_;
};

nlohmann::json photograph_json(const Model& model, const store::Photograph& photograph) {
  return protocol::to_json(Shown(model).of(photograph));
}

// --- poses

Result<Unit> unit_of(const Request& request, const Model& model) {
  const std::string text = request.query_or("unit", {});
  if (text.empty()) return model.unit;
  const auto unit = parse_unit(text);
  if (!unit) return fail(ErrorCode::invalid, "Unknown unit", "`unit` must be mm, cm or m.", "unit");
  return *unit;
}

nlohmann::json report_json(const photo::PosedPhotographs& read,
                           const store::MergedPhotographs& merged) {
  protocol::PosesReport report;
  using Format = protocol::PosesReportFormat;
  switch (read.format) {
    case photo::PoseFormat::colmap: report.format = Format::colmap; break;
    case photo::PoseFormat::metashape: report.format = Format::metashape; break;
    case photo::PoseFormat::realitycapture: report.format = Format::realitycapture; break;
    case photo::PoseFormat::bundler: report.format = Format::bundler; break;
  }
  report.added = static_cast<int>(merged.added);
  report.updated = static_cast<int>(merged.updated);
  report.total = static_cast<int>(merged.total);
  for (const auto* refused : {&read.refused, &merged.refused}) {
    report.refused_total += static_cast<int>(refused->size());
    for (const auto& [name, reason] : *refused)
      if (report.refused.size() < kMaxListed) report.refused.push_back({name, reason.detail});
  }
  report.without_pose = static_cast<int>(read.without_pose);
  report.in_other_components = static_cast<int>(read.in_other_components);
  report.coordinate_system = read.coordinate_system;
  for (const std::string& name : read.unused_files)
    if (report.unused_files.size() < kMaxListed && name.size() <= kMaxUnusedName)
      report.unused_files.push_back(name);
  return protocol::to_json(report);
}

Result<Response> import_poses(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  const Unit unit = STRATA_TRY(unit_of(request, model));
  const auto uploads = STRATA_TRY(take_upload(request, context.options.upload_dir, kPoseUpload));
  const UploadedFiles cut_out(uploads, request.body_file);
  std::vector<app::PoseUpload> files;
  for (const Upload& upload : uploads) files.push_back({upload.file, upload.filename});
  if (const std::string name = request.query_or("filename", {}); !name.empty() && files.size() == 1)
    files.front().name = name;
  const auto read =
      STRATA_TRY(app::read_pose_files(files, context.options.upload_dir, unit, model.unit));
  const auto answer = [&read](const store::MergedPhotographs& merged) {
    return json_response(report_json(read, merged));
  };
  const auto merged = STRATA_TRY(context.store.photographs().merge(
      model.id, read.photographs, idempotent_response<store::MergedPhotographs>(request, answer)));
  return answer(merged);
}

// --- lists

Result<store::Photograph> stored_photograph(const RouteContext& context, const Request& request,
                                            const Model& model) {
  const auto id = STRATA_TRY(id_of<store::PhotographId>(request, "photograph"));
  return context.store.photographs().find(model.id, id);
}

Result<Response> list_photographs(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request, kMaxPage));
  const auto model = STRATA_TRY(stored_model(context, request));
  store::Photographs::PageRequest wanted{.limit = page.limit + 1, .offset = page.offset};
  if (page.after) {
    if (page.after->size() != 1 || !page.after->front().is_string()) return wrong_place();
    wanted.after = page.after->front().get<std::string>();
  }
  wanted.text = request.query_or("q", {});
  if (character_count(wanted.text) > kMaxSearch)
    return fail(ErrorCode::invalid, "Text too long",
                "`q` can have at most " + std::to_string(kMaxSearch) + " characters.", "q");
  if (const std::string has = request.query_or("has_picture", {}); !has.empty()) {
    if (has != "true" && has != "false")
      return fail(ErrorCode::invalid, "Invalid value", "`has_picture` must be true or false.",
                  "has_picture");
    wanted.with_original = has == "true";
  }
  auto found = STRATA_TRY(context.store.photographs().page(model.id, wanted));
  const auto last = end_page(found.photographs, page, [](const store::Photograph& photograph) {
    return ListPlace::array({photograph.posed.name});
  });
  protocol::PhotographList list;
  list.total = static_cast<int>(found.total);
  list.with_picture = static_cast<int>(found.with_original);
  Shown shown(model);
  for (const auto& photograph : found.photographs) list.photographs.push_back(shown.of(photograph));
  Response response = json_response(protocol::to_json(list));
  add_page_links(response, request, page, last);
  return response;
}

Result<Response> get_photograph(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto photograph = STRATA_TRY(stored_photograph(context, request, model));
  return json_response(photograph_json(model, photograph));
}

Result<Response> photographs_seeing(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::PhotographsSeeingRequest>(request));
  auto room = STRATA_TRY(open_room(context, request));
  const Model model = room->model();
  const auto point =
      body.at.point ? STRATA_TRY(room->queries().position(*body.at.point, {}))
                    : STRATA_TRY(room->queries().pick(*body.at.camera, *body.at.x, *body.at.y, {}));
  protocol::PhotographsSeeing answer;
  if (!point.hit) return json_response(protocol::to_json(answer));
  answer.position = point.position;
  answer.normal = glm::dvec3(point.normal);
  auto photographs = STRATA_TRY(context.store.photographs().of_model(model.id));
  if (body.with_picture)
    std::erase_if(photographs,
                  [](const store::Photograph& photograph) { return !photograph.original; });
  const auto tree = room->surface().search_tree();
  const app::PlaceView place(*tree, room->surface().geometry()->origin,
                             glm::distance(model.bounds_min, model.bounds_max),
                             {point.position, *answer.normal});
  const auto found =
      app::photographs_seeing(place, std::move(photographs), static_cast<std::size_t>(body.limit));
  answer.total = static_cast<int>(found.total);
  answer.unknown_size = static_cast<int>(found.unknown_size);
  Shown shown(model);
  for (const app::SeeingPhotograph& seeing : found.best)
    if (auto entry = shown.of(seeing)) answer.photographs.push_back(std::move(*entry));
  return json_response(protocol::to_json(answer));
}

// --- images

// Checks an uploaded image, and returns it with a thumbnail, which also shows that it can be read.
struct CheckedOriginal {
  store::NewOriginal original;
  std::vector<std::uint8_t> thumbnail;
};

Result<CheckedOriginal> checked_original(const RouteContext& context,
                                         const std::filesystem::path& file) {
  const auto mapped = STRATA_TRY(MappedFile::open(file));
  const auto info = STRATA_TRY(inspect_picture(mapped.bytes()));
  using Format = PictureFormat;
  if (info.format != Format::jpeg && info.format != Format::png && info.format != Format::tiff)
    return fail(ErrorCode::unsupported, "Format not accepted",
                "A photograph must be a JPEG, PNG or TIFF file. This file is " +
                    std::string(media_type(info.format)) + ".",
                "body");
  // Other files are decoded as a whole.
  const bool is_reduced =
      info.format == Format::jpeg && !read_jpeg_facts(mapped.bytes()).progressive;
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(info.width) * static_cast<std::uint64_t>(info.height);
  const auto memory = STRATA_TRY(context.rooms.memory().reserve(is_reduced ? pixels : 8 * pixels,
                                                                "the thumbnail of a photograph"));
  constexpr std::int64_t kAny = std::int64_t{kMaxPictureSide} * kMaxPictureSide;
  auto thumbnail = STRATA_TRY(make_thumbnail(mapped.bytes(), kUsualThumbnail, {kAny, kAny}));
  return CheckedOriginal{{file, std::string(media_type(info.format)), info.width, info.height},
                         std::move(thumbnail)};
}

// Returns the only photograph that has the name of the file.
Result<store::PhotographId> photograph_named(const RouteContext& context, const Model& model,
                                             const std::string& filename) {
  const auto all = STRATA_TRY(context.store.photographs().names(model.id));
  std::vector<std::string> names;
  names.reserve(all.size());
  for (const auto& [id, name] : all) names.push_back(name);
  const std::array pictures{filename};
  const auto matches = photo::match_pictures(names, pictures);
  for (std::size_t i = 0; i < matches.size(); ++i)
    if (matches[i]) return all[i].first;
  return fail(ErrorCode::invalid, "No such photograph",
              "Not exactly one photograph of the model has the name of this file. Import its "
              "camera pose first, or add the file to a photograph that you choose.",
              "filename");
}

Result<Response> set_picture(const RouteContext& context, const Request& request,
                             const Model& model, store::PhotographId id) {
  const auto uploads = STRATA_TRY(take_upload(request, context.options.upload_dir, kPictureUpload));
  const UploadedFiles cut_out(uploads, request.body_file);
  if (uploads.size() != 1)
    return fail(ErrorCode::invalid, "Too many files", "Send one photograph at a time.", "body");
  const auto checked = STRATA_TRY(checked_original(context, uploads.front().file));
  const auto answer = [&model](const store::Photograph& photograph) {
    return json_response(photograph_json(model, photograph));
  };
  auto changed = context.store.photographs().set_original(
      model.id, id, checked.original, idempotent_response<store::Photograph>(request, answer));
  if (!changed) {
    Error problem = changed.error();
    if (problem.code == ErrorCode::invalid) problem.field = "body";
    return tl::unexpected(std::move(problem));
  }
  // Without it, the first request for the thumbnail makes it.
  (void)context.store.attachments().keep_thumbnail(changed->original->sha256, kUsualThumbnail,
                                                   checked.thumbnail);
  return answer(*changed);
}

Result<Response> add_picture(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  const std::string filename = request.query_or("filename", {});
  if (filename.empty())
    return fail(ErrorCode::invalid, "Name missing", "Send the name of the file.", "filename");
  const auto id = STRATA_TRY(photograph_named(context, model, filename));
  return set_picture(context, request, model, id);
}

Result<Response> put_picture(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto photograph = STRATA_TRY(stored_photograph(context, request, model));
  return set_picture(context, request, model, photograph.id);
}

tl::unexpected<Error> no_picture() {
  return fail(ErrorCode::not_found, "No image", "The photograph has no image yet.");
}

std::string file_name_of(const store::Photograph& photograph) {
  const std::string& name = photograph.posed.name;
  return name.substr(name.rfind('/') + 1);
}

Result<Response> get_picture(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto photograph = STRATA_TRY(stored_photograph(context, request, model));
  if (!request.query.contains("thumbnail")) STRATA_TRY(check_source_download(request, model));
  if (!photograph.original) return no_picture();
  const store::Original& original = *photograph.original;
  return stored_file_response(context, request,
                              {file_name_of(photograph), original.media_type, original.sha256,
                               original.bytes, original.media_type != "image/tiff"});
}

Result<Response> get_undistorted(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto photograph = STRATA_TRY(stored_photograph(context, request, model));
  if (!photograph.original) return no_picture();
  const store::Original& original = *photograph.original;
  const auto camera =
      STRATA_TRY(photo::camera_for(photograph.posed.calibration, original.width, original.height));
  const auto pinhole = STRATA_TRY(app::pinhole_of(camera));
  int width = pinhole.width;
  if (const std::string text = request.query_or("width", {}); !text.empty()) {
    const auto number =
        STRATA_TRY(parse_integer(text, kMinUndistorted, app::kMaxUndistortedSide, "width"));
    width = std::min(width, static_cast<int>(number));
  }
  const int side = app::side_for(camera, pinhole, width);
  // The file, the decoded pixels with as much again while they are decoded, and the result.
  const std::uint64_t pixels =
      static_cast<std::uint64_t>(original.width) * static_cast<std::uint64_t>(original.height);
  const auto memory = STRATA_TRY(context.rooms.memory().reserve(
      original.bytes + 8 * pixels + 4ull * app::kMaxUndistortedSide * app::kMaxUndistortedSide,
      "an undistorted photograph"));
  std::vector<std::uint8_t> bytes;
  bytes.reserve(original.bytes);
  STRATA_TRY(context.store.attachments().read(
      original.sha256, 0, original.bytes, [&](std::span<const std::uint8_t> piece) {
        bytes.insert(bytes.end(), piece.begin(), piece.end());
        return true;
      }));
  auto decoded = STRATA_TRY(decode_coarse(bytes, side));
  bytes = {};
  const Picture reduced = app::halved_to(std::move(decoded), side);
  const Picture picture = app::undistorted(reduced, camera, pinhole, width);
  return bytes_response(
      encode_jpeg(picture.rgba, picture.width, picture.height, {.quality = kJpegQuality}),
      std::string(media_type(PictureFormat::jpeg)));
}

StateOf state_of_photograph(const RouteContext& context) {
  return [&context](const Request& request) -> std::optional<std::string> {
    const auto model = stored_model(context, request);
    if (!model) return std::nullopt;
    const auto photograph = stored_photograph(context, request, *model);
    if (!photograph) return std::nullopt;
    return to_string(photograph->id) + " " + std::to_string(photograph->version);
  };
}

// --- deletion

Result<Response> delete_photograph(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto id = STRATA_TRY(id_of<store::PhotographId>(request, "photograph"));
  STRATA_TRY(context.store.photographs().remove(
      model.id, id, idempotent_response<>(request, [] { return empty_response(204); })));
  return empty_response(204);
}

Result<Response> set_rights(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::PhotographRights>(request));
  const auto model = STRATA_TRY(stored_model(context, request));
  if (!body.rights_uri.empty() && !app::is_license(body.rights_uri))
    return fail(ErrorCode::invalid, "Unknown license",
                "Send an SPDX identifier such as CC-BY-4.0, or the address of a license or of a "
                "statement of rightsstatements.org.",
                "rights_uri");
  std::vector<store::PhotographId> ids;
  for (const auto id : body.photographs.value_or(std::vector<std::int64_t>{})) ids.emplace_back(id);
  const auto answer = [](const std::int64_t& changed) {
    return json_response({{"changed", changed}});
  };
  const auto changed = STRATA_TRY(
      context.store.photographs().set_rights(model.id, ids, body.rights_uri, body.rights_holder,
                                             idempotent_response<std::int64_t>(request, answer)));
  return answer(changed);
}

Result<Response> delete_photographs(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  STRATA_TRY(context.store.photographs().remove_all(
      model.id, idempotent_response<>(request, [] { return empty_response(204); })));
  return empty_response(204);
}

}  // namespace

void add_photograph_routes(Router& router, const RouteContext& context) {
  using Answer = Result<Response> (*)(const RouteContext&, const Request&);
  const auto handler = [&context](Answer answer) {
    return answering(
        [&context, answer](const Request& request) { return answer(context, request); });
  };
  const std::string all = kPhotographs, one = all + "/{photograph}";
  const std::uint64_t picture_bytes = std::min(kMaxOriginalBytes, context.options.max_upload_bytes);
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/photograph-poses",
              .handler = handler(import_poses),
              .role = Role::curator,
              .query = {"filename", "unit"},
              .body = BodyKind::file,
              .max_body = context.options.max_upload_bytes,
              .keeps_answer = true});
  router.add({.method = Method::get,
              .pattern = all,
              .handler = handler(list_photographs),
              .query = {"limit", "offset", "after", "q", "has_picture"}});
  router.add({.method = Method::post,
              .pattern = all,
              .handler = handler(add_picture),
              .role = Role::curator,
              .query = {"filename"},
              .body = BodyKind::file,
              .max_body = picture_bytes,
              .keeps_answer = true});
  router.add({.method = Method::remove,
              .pattern = all,
              .handler = handler(delete_photographs),
              .role = Role::curator,
              .keeps_answer = true});
  router.add({.method = Method::post,
              .pattern = all + "/seeing",
              .handler = handler(photographs_seeing),
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .is_question = true});
  router.add({.method = Method::put,
              .pattern = all + "/rights",
              .handler = handler(set_rights),
              .role = Role::curator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .keeps_answer = true});
  router.add({.method = Method::get, .pattern = one, .handler = handler(get_photograph)});
  router.add({.method = Method::remove,
              .pattern = one,
              .handler = handler(delete_photograph),
              .role = Role::curator,
              .keeps_answer = true});
  router.add({.method = Method::get,
              .pattern = one + "/picture",
              .handler = handler(get_picture),
              .query = {"thumbnail"}});
  router.add({.method = Method::put,
              .pattern = one + "/picture",
              .handler = handler(put_picture),
              .role = Role::curator,
              .body = BodyKind::file,
              .max_body = picture_bytes,
              .keeps_answer = true});
  router.add({.method = Method::get,
              .pattern = one + "/undistorted",
              .handler = handler(get_undistorted),
              .query = {"width"},
              .is_question = true,
              .state = state_of_photograph(context)});
}

}  // namespace strata::net
