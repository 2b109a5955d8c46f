#include "net/api/stored_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <mutex>

#include "core/text/filename.h"
#include "core/text/percent.h"
#include "media/media_type.h"
#include "media/picture.h"
#include "media/thumbnail.h"
#include "net/api/route_help.h"
#include "net/http/byte_range.h"
#include "store/store.h"
#include "store/tables/attachments.h"

namespace strata::net {
namespace {

constexpr std::size_t kHeadBytes = 1u << 20;
constexpr std::uint64_t kAtOnceBytes = 4u << 20;  // larger files are streamed
constexpr std::uint64_t kThumbnailFileBytes = 128u << 20;

// Prevents a file from running scripts in the server's origin, even if a browser displays it as a
// page.
constexpr const char* kSandbox = "sandbox; default-src 'none'";

Result<int> thumbnail_side(const Request& request) {
  static constexpr std::array kSides = {64, 128, 256, 512, 1024};
  const std::string& text = request.query.at("thumbnail");
  for (const int side : kSides)
    if (text == std::to_string(side)) return side;
  return fail(ErrorCode::invalid, "Invalid thumbnail size",
              "`thumbnail` must be 64, 128, 256, 512 or 1024.", "thumbnail");
}

Result<Response> thumbnail(const RouteContext& context, const StoredFile& file, int side) {
  // Decodes only one image at a time to limit the memory, because decoded images are large.
  static std::mutex decoding;
  auto stored = STRATA_TRY(context.store.attachments().thumbnail(file.sha256, side));
  if (stored) return bytes_response(std::move(*stored), "image/jpeg");
  constexpr std::array<std::string_view, 5> kTypes{"image/jpeg", "image/png", "image/tiff",
                                                   "image/webp", "image/bmp"};
  if (std::find(kTypes.begin(), kTypes.end(), file.media_type) == kTypes.end())
    return fail(ErrorCode::unsupported, "No thumbnail",
                "The server can make thumbnails only of JPEG, PNG, TIFF, WebP and BMP pictures. "
                "This file is " +
                    file.media_type + ".",
                "thumbnail");
  if (file.bytes > kThumbnailFileBytes)
    return fail(ErrorCode::invalid, "Picture too large",
                "The server can make thumbnails only of files of at most " +
                    std::to_string(kThumbnailFileBytes >> 20) + " MiB.",
                "thumbnail");
  const std::lock_guard lock(decoding);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(file.bytes);
  STRATA_TRY(context.store.attachments().read(
      file.sha256, 0, file.bytes, [&](std::span<const std::uint8_t> piece) {
        bytes.insert(bytes.end(), piece.begin(), piece.end());
        return true;
      }));
  auto picture = make_thumbnail(bytes, side);
  if (!picture) {
    picture.error().field = "thumbnail";
    return tl::unexpected(picture.error());
  }
  // Ignores errors, such as a full disk or a busy database. The next request creates the thumbnail
  // again.
  (void)context.store.attachments().keep_thumbnail(file.sha256, side, *picture);
  return bytes_response(std::move(*picture), "image/jpeg");
}

Result<Response> content(const RouteContext& context, const StoredFile& file,
                         const RequestedRange& requested) {
  Response response;
  response.status = requested.is_part ? 206 : 200;
  response.with("Content-Type", file.media_type);
  if (requested.is_part)
    response.with("Content-Range", "bytes " + std::to_string(requested.range.begin) + "-" +
                                       std::to_string(requested.range.end - 1) + "/" +
                                       std::to_string(file.bytes));
  const std::uint64_t length = requested.range.end - requested.range.begin;
  if (length > kAtOnceBytes) {
    response.stream = Response::Stream{
        length, [&store = context.store, sha256 = file.sha256,
                 range = requested.range](const Response::Sink& sink) {
          return store.attachments().read(sha256, range.begin, range.end, sink).has_value();
        }};
    return response;
  }
  response.bytes.reserve(length);
  STRATA_TRY(context.store.attachments().read(
      file.sha256, requested.range.begin, requested.range.end,
      [&](std::span<const std::uint8_t> piece) {
        response.bytes.insert(response.bytes.end(), piece.begin(), piece.end());
        return true;
      }));
  return response;
}

}  // namespace

std::vector<std::uint8_t> head_of(const std::filesystem::path& file) {
  std::vector<std::uint8_t> head(kHeadBytes);
  std::ifstream in(file, std::ios::binary);
  in.read(reinterpret_cast<char*>(head.data()), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(in.gcount()));
  return head;
}

InspectedFile inspect_file(const std::filesystem::path& file, const std::string& name) {
  InspectedFile found;
  found.name = base_filename(name);
  if (found.name.empty()) found.name = "unnamed";
  const auto head = head_of(file);
  found.media_type = sniff_media_type(head, found.name);
  // Accepts images of unknown size because the server stores any file of a user.
  const bool is_picture = is_raster_picture(found.media_type);
  if (const auto info = inspect_picture(head, 1 << 16); is_picture && info) {
    found.width = info->width;
    found.height = info->height;
  }
  return found;
}

Result<Response> stored_file_response(const RouteContext& context, const Request& request,
                                      const StoredFile& file) {
  const bool small = request.query.contains("thumbnail");
  int side = 0;
  if (small) {
    auto requested = STRATA_TRY(thumbnail_side(request));
    side = requested;
  }
  const std::string etag = "\"" + file.sha256 + (small ? "-" + std::to_string(side) : "") + "\"";
  if (names_tag(request.header("if-none-match"), etag))
    return empty_response(304).with("ETag", etag);
  Result<Response> response;
  if (small) {
    response = thumbnail(context, file, side);
    if (!response) return response;
  } else {
    const auto if_range = request.header("if-range");
    const auto range =
        if_range.empty() || if_range == etag ? request.header("range") : std::string_view();
    const auto requested = requested_range(range, file.bytes);
    if (!requested) {
      Response refusal =
          problem_response({ErrorCode::range_not_satisfied, "Range not available",
                            "The file has " + std::to_string(file.bytes) + " bytes.", "Range"});
      return refusal.with("Content-Range", "bytes */" + std::to_string(file.bytes));
    }
    response = content(context, file, *requested);
    if (!response) return response;
    const char* way = file.in_place ? "inline" : "attachment";
    response->with("Content-Disposition", way + ("; filename*=UTF-8''" + percent_encode(file.name)))
        .with("Accept-Ranges", "bytes");
  }
  response->with("ETag", etag).with("Content-Security-Policy", kSandbox);
  return response;
}

}  // namespace strata::net
