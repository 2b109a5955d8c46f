#include "mesh/texture/gutter_fill.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace strata::mesh {
namespace {

constexpr std::array<std::array<int, 2>, 4> kBeside{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

std::uint8_t* pixel(Picture& picture, int x, int y) {
  return &picture.rgba[(static_cast<std::size_t>(y) * picture.width + x) * 4];
}

template <class Visit>
void for_each_empty_beside(Picture& picture, std::uint32_t at, Visit visit) {
  const int x = static_cast<int>(at % picture.width), y = static_cast<int>(at / picture.width);
  for (const auto& [dx, dy] : kBeside) {
    if (x + dx < 0 || x + dx >= picture.width || y + dy < 0 || y + dy >= picture.height) continue;
    std::uint8_t* beside = pixel(picture, x + dx, y + dy);
    if (beside[3] == 0) visit(beside, static_cast<std::uint32_t>(at + dx + dy * picture.width));
  }
}

// Fills ring by ring. Only the pixels filled last have empty neighbors.
void grow_rings(Picture& picture, int ring) {
  std::vector<std::uint32_t> last, next;
  const auto count = static_cast<std::uint32_t>(picture.rgba.size() / 4);
  for (std::uint32_t at = 0; at < count; ++at) {
    if (picture.rgba[std::size_t{at} * 4 + 3] == 0) continue;
    bool at_edge = false;
    for_each_empty_beside(picture, at, [&](std::uint8_t*, std::uint32_t) { at_edge = true; });
    if (at_edge) last.push_back(at);
  }
  for (int round = 0; round < ring && !last.empty(); ++round) {
    next.clear();
    for (const std::uint32_t at : last)
      for_each_empty_beside(picture, at, [&](std::uint8_t* empty, std::uint32_t where) {
        std::memcpy(empty, &picture.rgba[std::size_t{at} * 4], 3);
        empty[3] = 255;
        next.push_back(where);
      });
    last.swap(next);
  }
}

Picture mean_of_filled(Picture& fine) {
  Picture coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
  coarse.rgba.resize(std::size_t(coarse.width) * coarse.height * 4);
  for (int y = 0; y < coarse.height; ++y)
    for (int x = 0; x < coarse.width; ++x) {
      int sum[3] = {}, filled = 0;
      for (int k = 0; k < 4; ++k) {
        const int fx = 2 * x + k % 2, fy = 2 * y + k / 2;
        if (fx >= fine.width || fy >= fine.height) continue;
        const std::uint8_t* p = pixel(fine, fx, fy);
        if (p[3] == 0) continue;
        for (int c = 0; c < 3; ++c) sum[c] += p[c];
        ++filled;
      }
      if (filled == 0) continue;
      std::uint8_t* out = pixel(coarse, x, y);
      for (int c = 0; c < 3; ++c)
        out[c] = static_cast<std::uint8_t>((sum[c] + filled / 2) / filled);
      out[3] = 255;
    }
  return coarse;
}

void fill_from(Picture& fine, Picture& coarse) {
  for (int y = 0; y < fine.height; ++y)
    for (int x = 0; x < fine.width; ++x) {
      std::uint8_t* p = pixel(fine, x, y);
      if (p[3] == 0) std::memcpy(p, pixel(coarse, x / 2, y / 2), 3);
      p[3] = 255;
    }
}

}  // namespace

void fill_gutter(Picture& picture, int ring) {
  grow_rings(picture, ring);
  std::vector<Picture> coarser;
  for (Picture* level = &picture; level->width > 1 || level->height > 1; level = &coarser.back())
    coarser.push_back(mean_of_filled(*level));
  for (std::size_t i = coarser.size(); i-- > 0;)
    fill_from(i == 0 ? picture : coarser[i - 1], coarser[i]);
  for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = 255;
}

}  // namespace strata::mesh
