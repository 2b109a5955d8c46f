// Files of tours: images, sounds and videos at stops, subtitles, and logos.
#include <algorithm>
#include <array>

#include "core/text/filename.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "media/picture.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/api/stored_file.h"
#include "net/auth/project_authorization.h"
#include "net/http/idempotency_store.h"
#include "net/http/upload.h"
#include "net/serialization/tour_files.h"
#include "net/transport/server_options.h"
#include "store/content/named_parts.h"
#include "store/content/tour_files.h"
#include "store/store.h"

namespace strata::net {
namespace {

using Kind = protocol::TourFileKind;

constexpr const char* kTourFile =
    "Send the file as the body, with its `name` in the address. A tour accepts pictures (JPEG, "
    "PNG, WebP), sounds (MP3, M4A, WAV, FLAC, Ogg), videos (MP4, WebM) and subtitles (WebVTT).";
constexpr int kMaxSide = 8192;  // browsers decode complete images

std::uint64_t max_bytes(Kind kind) {
  switch (kind) {
    case Kind::picture: return 32u << 20;
    case Kind::sound: return 64u << 20;
    case Kind::video: return 512u << 20;
    case Kind::subtitles: return 1u << 20;
  }
  return 0;
}

Result<store::NamedPart> find_tour(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  return context.store.tours().find(model.id, request.param("tour"));
}

// A WebVTT file begins with its signature, followed by a line end or a comment (W3C WebVTT, 4).
bool is_webvtt(const std::vector<std::uint8_t>& head) {
  std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  if (!text.starts_with("WEBVTT")) return false;
  return text.size() == 6 || std::string_view(" \t\r\n").find(text[6]) != std::string_view::npos;
}

std::string playable_type(const InspectedFile& found, const std::filesystem::path& file) {
  if (found.media_type == "application/ogg") return "audio/ogg";
  if (found.media_type.starts_with("text/") && is_webvtt(head_of(file))) return "text/vtt";
  return found.media_type;
}

Result<store::NewTourFile> accepted(const Upload& upload, const std::string& requested_name) {
  const InspectedFile found =
      inspect_file(upload.file, requested_name.empty() ? upload.filename : requested_name);
  store::NewTourFile file{found.name, upload.file, playable_type(found, upload.file), found.width,
                          found.height};
  const auto kind = tour_file_kind(file.media_type);
  if (!kind)
    return fail(ErrorCode::unsupported, "Format not accepted",
                "Browsers cannot show or play this file (" + found.media_type + "). " +
                    "A tour accepts JPEG, PNG and WebP, MP3, M4A, WAV, FLAC and Ogg, MP4 and WebM, "
                    "and WebVTT.");
  std::error_code unreadable;
  const auto bytes = std::filesystem::file_size(upload.file, unreadable);
  if (unreadable || bytes > max_bytes(*kind))
    return fail(ErrorCode::invalid, "File too large",
                "A " + std::string(protocol::name(*kind)) + " file of a tour can be at most " +
                    std::to_string(max_bytes(*kind) >> 20) + " MiB large. Use a smaller file.");
  if (*kind == Kind::picture && !(file.width && file.height))
    return fail(ErrorCode::invalid, "Picture not readable",
                "The picture is damaged. Save it again in another program.");
  if (*kind == Kind::picture && std::max(*file.width, *file.height) > kMaxSide)
    return fail(ErrorCode::invalid, "Picture too large",
                "Each side of a picture can be at most " + std::to_string(kMaxSide) +
                    " pixels long. Reduce the picture.");
  return file;
}

Result<Response> add_file(const RouteContext& context, const Request& request) {
  const auto tour = STRATA_TRY(find_tour(context, request));
  const auto uploads = STRATA_TRY(take_upload(request, context.options.upload_dir, kTourFile));
  const UploadedFiles cut_out(uploads, request.body_file);
  if (uploads.size() != 1)
    return fail(ErrorCode::invalid, "Too many files", "Send one file at a time.");
  const auto file = STRATA_TRY(accepted(uploads.front(), request.query_or("name", {})));
  const std::string own = "/api/v1/models/" + request.param("model") + "/tours/" + tour.slug;
  const auto answer = [own](const store::TourFile& made) {
    return json_response(to_json(made), 201).with("Location", own + "/files/" + to_string(made.id));
  };
  const auto made = STRATA_TRY(context.store.tour_files().add(
      tour.id, file, request.user(), idempotent_response<store::TourFile>(request, answer)));
  return answer(made);
}

Result<Response> get_file(const RouteContext& context, const Request& request) {
  const auto tour = STRATA_TRY(find_tour(context, request));
  const auto id = STRATA_TRY(id_of<store::TourFileId>(request, "file"));
  const auto file = STRATA_TRY(context.store.tour_files().find(tour.id, id));
  return stored_file_response(context, request,
                              {file.name, file.media_type, file.sha256, file.bytes, true});
}

}  // namespace

void add_tour_file_routes(Router& router, const RouteContext& context) {
  const std::string files = "/api/v1/models/{model}/tours/{tour}/files";
  router.add({.method = Method::post,
              .pattern = files,
              .handler = answering(
                  [&context](const Request& request) { return add_file(context, request); }),
              .role = Role::curator,
              .query = {"name"},
              .body = BodyKind::file,
              .max_body = std::min<std::uint64_t>(context.options.max_upload_bytes, 513u << 20),
              .keeps_answer = true});
  router.add({.method = Method::get,
              .pattern = files + "/{file}",
              .handler = answering(
                  [&context](const Request& request) { return get_file(context, request); }),
              .query = {"thumbnail"}});
}

}  // namespace strata::net
