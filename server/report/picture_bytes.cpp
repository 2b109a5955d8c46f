#include "report/picture_bytes.h"

#include <fstream>
#include <system_error>

#include "media/jpeg_facts.h"
#include "media/turned.h"

namespace strata::report {
namespace {

using Bytes = std::shared_ptr<const std::vector<std::uint8_t>>;

tl::unexpected<Error> too_large(const std::string& what, const std::string& place) {
  return fail(ErrorCode::too_large, "Picture too large",
              "A picture of the report has " + what +
                  ", which is too large. Use a smaller version of the picture.",
              place);
}

tl::unexpected<Error> missing(const std::string& place) {
  return fail(ErrorCode::damaged, "Picture missing",
              "The file of a picture of the report does not exist or cannot be read.", place);
}

tl::unexpected<Error> too_many_bytes(std::uintmax_t bytes, const std::string& place) {
  return too_large(std::to_string(bytes / 1024 / 1024) + " MiB", place);
}

Result<Bytes> read_file(const std::filesystem::path& file, const std::string& place) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);  // fails for a folder
  if (error) return missing(place);
  if (size > kMaxPictureBytes) return too_many_bytes(size, place);
  auto bytes = std::make_shared<std::vector<std::uint8_t>>(size);
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(reinterpret_cast<char*>(bytes->data()), static_cast<std::streamsize>(size)))
    return missing(place);
  return bytes;
}

// Returns an error of the module media with the place of the picture.
tl::unexpected<Error> at(Error error, const std::string& place) {
  error.field = place;
  return tl::unexpected(std::move(error));
}

// Returns the number of color channels of a JPEG, or 0 if it has no frame header. Source: ITU-T
// T.81, annex B.
int jpeg_channels(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kChannels = 9;  // from the marker
  for (std::size_t i = 2; i + kChannels < bytes.size();) {
    const std::uint8_t marker = bytes[i + 1];
    if (bytes[i] != 0xff) return 0;
    if (marker == 0xff) {  // padding
      ++i;
      continue;
    }
    if (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc)
      return bytes[i + kChannels];
    i += 2 + (std::size_t{bytes[i + 2]} << 8 | bytes[i + 3]);
  }
  return 0;
}

}  // namespace

Result<Bytes> read_bytes(const PictureSource& source, const std::string& place) {
  if (const auto* file = std::get_if<std::filesystem::path>(&source))
    return read_file(*file, place);
  const Bytes& bytes = std::get<Bytes>(source);
  if (!bytes) return missing(place);
  if (bytes->size() > kMaxPictureBytes) return too_many_bytes(bytes->size(), place);
  return bytes;
}

Result<PictureBytes> read_picture(const PictureSource& source, const std::string& place) {
  const Bytes bytes = STRATA_TRY(read_bytes(source, place));
  const auto info = inspect_picture(*bytes);
  if (!info) return at(info.error(), place);
  if (info->format != PictureFormat::jpeg && info->format != PictureFormat::png)
    return fail(ErrorCode::unsupported, "Unsupported picture format",
                "The pictures of a report must be JPEG or PNG files. Convert the picture.", place);
  const std::int64_t pixels = std::int64_t{info->width} * info->height;
  if (pixels > kMaxPicturePixels)
    return too_large(std::to_string(pixels / 1'000'000) + " million pixels", place);
  auto picture = decode_picture(*bytes);
  if (!picture) return at(picture.error(), place);
  constexpr int kUpright = 1, kInks = 4;
  if (info->format == PictureFormat::png)
    return PictureBytes{info->format, info->width, info->height, bytes, true};
  const int orientation = read_jpeg_facts(*bytes).orientation;
  if (orientation == kUpright && jpeg_channels(*bytes) < kInks)
    return PictureBytes{info->format, info->width, info->height, bytes, true};
  const strata::Picture upright = turned(std::move(*picture), orientation);
  constexpr JpegSettings kPrint{95, true};
  auto encoded = std::make_shared<const std::vector<std::uint8_t>>(
      encode_jpeg(upright.rgba, upright.width, upright.height, kPrint));
  return PictureBytes{info->format, upright.width, upright.height, std::move(encoded), false};
}

}  // namespace strata::report
