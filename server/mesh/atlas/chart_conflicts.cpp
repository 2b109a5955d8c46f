#include "mesh/atlas/chart_conflicts.h"

#include <algorithm>
#include <array>
#include <limits>

#include "mesh/atlas/bits.h"
#include "mesh/parallel.h"
#include "mesh/texels/texel_raster.h"

namespace strata::mesh {
namespace {

// The texels of a chart's window as bits.
class Window {
 public:
  void reset(glm::ivec2 size) {
    stride_ = (size.x + 63) / 64;
    bits_.assign(static_cast<std::size_t>(stride_) * size.y, 0);
  }
  bool is_free(int y, int begin, int end) const {
    for (int word = begin / 64; word <= (end - 1) / 64; ++word)
      if (bits_[static_cast<std::size_t>(y) * stride_ + word] & bits_between(word, begin, end))
        return false;
    return true;
  }
  void take(int y, int begin, int end) {
    for (int word = begin / 64; word <= (end - 1) / 64; ++word)
      bits_[static_cast<std::size_t>(y) * stride_ + word] |= bits_between(word, begin, end);
  }

 private:
  int stride_ = 0;
  std::vector<std::uint64_t> bits_;
};

void find_conflicts(const Chart& chart, std::span<const glm::vec2> uvs, int resolution,
                    Window& window, std::vector<std::uint8_t>& is_shared) {
  using Corners = std::array<SnappedPoint, 3>;
  const auto snapped = [&](std::uint32_t face) {
    const auto corner = [&](std::size_t k) {
      const glm::vec2 uv = uvs[3 * std::size_t{face} + k];
      return snap_to_subtexels(double{uv.x} * resolution, double{uv.y} * resolution);
    };
    return Corners{corner(0), corner(1), corner(2)};
  };
  SnappedPoint low(std::numeric_limits<int>::max()), high(std::numeric_limits<int>::min());
  for (const auto face : chart.faces)
    for (const auto& p : snapped(face)) low = glm::min(low, p), high = glm::max(high, p);
  const glm::ivec2 origin = low / kSubtexels, size = high / kSubtexels - origin + 1;
  window.reset(size);
  for (std::size_t i = 0; i < chart.faces.size(); ++i) {
    if (is_shared[i]) continue;
    auto p = snapped(chart.faces[i]);
    for (auto& corner : p) corner -= origin * kSubtexels;
    const CoverageRaster raster(p[0], p[1], p[2]);
    const bool is_free = raster.for_each_span(0, size.x, 0, size.y, [&](int y, int begin, int end) {
      return window.is_free(y, begin, end);
    });
    if (is_free)
      raster.for_each_span(0, size.x, 0, size.y, [&](int y, int begin, int end) {
        return window.take(y, begin, end), true;
      });
    else
      is_shared[i] = 1;
  }
}

}  // namespace

std::vector<std::uint32_t> faces_in_conflict(std::span<const Chart> charts,
                                             std::span<const glm::vec2> uvs,
                                             std::span<const int> resolutions, int threads) {
  std::vector<std::vector<std::uint32_t>> of_chart(charts.size());
  parallel_for(threads, static_cast<int>(charts.size()), [&](int c) {
    const Chart& chart = charts[c];
    if (chart.faces.size() == 1) return;
    Window window;
    std::vector<std::uint8_t> is_shared(chart.faces.size(), 0);
    for (const int resolution : resolutions)
      find_conflicts(chart, uvs, resolution, window, is_shared);
    for (std::size_t i = 0; i < is_shared.size(); ++i)
      if (is_shared[i]) of_chart[c].push_back(chart.faces[i]);
  });
  std::vector<std::uint32_t> faces;
  for (const auto& some : of_chart) faces.insert(faces.end(), some.begin(), some.end());
  return faces;
}

}  // namespace strata::mesh
