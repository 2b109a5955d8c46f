#include "mesh/repair/uv_faults.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/texels/texel_raster.h"

namespace strata::mesh {
namespace {

constexpr float kRoundingOutside = 1.f / 65536;  // some writers round 1 up slightly

double surface_of(const TriangleMesh& mesh, std::size_t t) {
  const auto a = mesh.positions[mesh.triangles[3 * t]];
  return glm::length(glm::cross(mesh.positions[mesh.triangles[3 * t + 1]] - a,
                                mesh.positions[mesh.triangles[3 * t + 2]] - a)) /
         2;
}

UvFault fault_of(std::span<const glm::vec2> uvs) {
  for (const glm::vec2 uv : uvs)
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) return UvFault::not_finite;
  for (const glm::vec2 uv : uvs)
    if (std::min(uv.x, uv.y) < -kRoundingOutside || std::max(uv.x, uv.y) > 1 + kRoundingOutside)
      return UvFault::outside;
  const glm::dvec2 a = uvs[0], ab = glm::dvec2(uvs[1]) - a, ac = glm::dvec2(uvs[2]) - a;
  return ab.x * ac.y == ab.y * ac.x ? UvFault::no_area : UvFault::none;
}

template <class Visit>
void for_each_texel(std::span<const glm::vec2> corner_uvs, std::size_t t, int resolution,
                    Visit visit) {
  const auto snapped = [&](std::size_t k) {
    const glm::dvec2 uv =
        glm::dvec2(glm::clamp(corner_uvs[3 * t + k], glm::vec2(0), glm::vec2(1))) *
        double(resolution);
    return snap_to_subtexels(uv.x, uv.y);
  };
  CoverageRaster(snapped(0), snapped(1), snapped(2))
      .for_each_span(0, resolution, 0, resolution, [&](int y, int begin, int end) {
        const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(resolution);
        for (int x = begin; x < end; ++x) visit(row + static_cast<std::size_t>(x));
        return true;
      });
}

}  // namespace

std::string_view words_of(UvFault fault) {
  switch (fault) {
    case UvFault::not_finite: return "are not finite numbers";
    case UvFault::outside: return "lie outside the unit square";
    case UvFault::no_area: return "have no area in the texture";
    case UvFault::overlap: return "overlap others in the texture";
    case UvFault::none: break;
  }
  return "are good";
}

void UvFaults::set(std::size_t triangle, UvFault fault, double surface_area) {
  of_triangle[triangle] = fault;
  ++count[static_cast<std::size_t>(fault)];
  area += surface_area;
}

UvFaults find_single_faults(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs) {
  UvFaults faults;
  faults.of_triangle.assign(mesh.triangle_count(), UvFault::none);
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const UvFault fault = fault_of(corner_uvs.subspan(3 * t, 3));
    if (fault == UvFault::none) continue;
    if (const double area = surface_of(mesh, t); area > 0 || fault != UvFault::no_area)
      faults.set(t, fault, area);
  }
  return faults;
}

void find_overlaps(const TriangleMesh& mesh, std::span<const glm::vec2> corner_uvs, int resolution,
                   UvFaults& faults) {
  constexpr std::uint16_t kMany = std::numeric_limits<std::uint16_t>::max();
  std::vector<std::uint16_t> owners(
      static_cast<std::size_t>(resolution) * static_cast<std::size_t>(resolution), 0);
  const std::size_t count = mesh.triangle_count();
  for (std::size_t t = 0; t < count; ++t)
    if (faults.of_triangle[t] == UvFault::none)
      for_each_texel(corner_uvs, t, resolution,
                     [&](std::size_t at) { owners[at] += owners[at] != kMany; });
  const auto shared_texels = [&](std::size_t t) {
    std::uint32_t shared = 0;
    for_each_texel(corner_uvs, t, resolution, [&](std::size_t at) { shared += owners[at] > 1; });
    return shared;
  };
  struct Sharer {
    std::uint32_t texels, triangle;
  };
  std::vector<Sharer> sharers;
  for (std::size_t t = 0; t < count; ++t)
    if (faults.of_triangle[t] == UvFault::none)
      if (const std::uint32_t shared = shared_texels(t); shared > 0)
        sharers.push_back({shared, static_cast<std::uint32_t>(t)});
  std::sort(sharers.begin(), sharers.end(), [](const Sharer& a, const Sharer& b) {
    return a.texels != b.texels ? a.texels > b.texels : a.triangle > b.triangle;
  });
  for (const Sharer& sharer : sharers) {
    if (shared_texels(sharer.triangle) == 0) continue;
    for_each_texel(corner_uvs, sharer.triangle, resolution,
                   [&](std::size_t at) { owners[at] -= owners[at] != kMany; });
    faults.set(sharer.triangle, UvFault::overlap, surface_of(mesh, sharer.triangle));
  }
}

}  // namespace strata::mesh
