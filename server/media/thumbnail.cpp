#include "media/thumbnail.h"

#include <algorithm>
#include <array>

#include "media/jpeg_facts.h"
#include "media/picture.h"
#include "media/turned.h"

namespace strata {
namespace {

constexpr int kQuality = 85;

Picture shrunk(const Picture& picture, int largest_side) {
  const double scale =
      std::min(1.0, double(largest_side) / std::max(picture.width, picture.height));
  Picture small;
  small.width = std::max(1, static_cast<int>(picture.width * scale));
  small.height = std::max(1, static_cast<int>(picture.height * scale));
  small.rgba.reserve(std::size_t{4} * static_cast<std::size_t>(small.width) *
                     static_cast<std::size_t>(small.height));
  const auto edge = [](int i, int count, int of) {
    return static_cast<std::size_t>(std::int64_t{i} * of / count);
  };
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      std::array<std::uint64_t, 3> sum{};
      std::uint64_t count = 0;
      for (auto row = edge(y, small.height, picture.height);
           row < edge(y + 1, small.height, picture.height); ++row)
        for (auto column = edge(x, small.width, picture.width);
             column < edge(x + 1, small.width, picture.width); ++column) {
          const std::uint8_t* pixel =
              &picture.rgba[4 * (row * static_cast<std::size_t>(picture.width) + column)];
          for (std::size_t c = 0; c < 3; ++c)
            sum[c] += pixel[c] * pixel[3] + 255u * (255u - pixel[3]);
          ++count;
        }
      for (std::size_t c = 0; c < 3; ++c)
        small.rgba.push_back(static_cast<std::uint8_t>(sum[c] / (255 * count)));
      small.rgba.push_back(255);
    }
  }
  return small;
}

}  // namespace

Result<std::vector<std::uint8_t>> make_thumbnail(std::span<const std::uint8_t> bytes,
                                                 int largest_side, ThumbnailLimits limits) {
  const auto info = STRATA_TRY(inspect_picture(bytes));
  const bool is_jpeg = info.format == PictureFormat::jpeg;
  const JpegFacts facts = is_jpeg ? read_jpeg_facts(bytes) : JpegFacts();
  const std::int64_t pixels = std::int64_t{info.width} * info.height;
  const std::int64_t most = is_jpeg && !facts.progressive ? limits.coarse : limits.whole;
  if (pixels > most)
    return fail(ErrorCode::invalid, "Picture too large",
                "The picture has " + std::to_string(pixels / 1'000'000) +
                    " million pixels. The server can make thumbnails only of pictures with at "
                    "most " +
                    std::to_string(most / 1'000'000) + " million pixels.");
  auto picture = STRATA_TRY(decode_coarse(bytes, largest_side));
  const Picture small = turned(shrunk(picture, largest_side), facts.orientation);
  return encode_jpeg(small.rgba, small.width, small.height, {kQuality, false});
}

}  // namespace strata
