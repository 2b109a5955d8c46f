#include "mesh/surface/face_neighbours.h"

#include "mesh/surface/connectivity.h"

namespace strata::mesh {

std::vector<std::uint32_t> face_neighbours(const Connectivity& connectivity) {
  std::vector<std::uint32_t> neighbours(3 * connectivity.n_faces());
  for (std::uint32_t triangle = 0; triangle < connectivity.n_faces(); ++triangle) {
    std::uint32_t* entry = &neighbours[3 * std::size_t{triangle}];
    for (const auto side : connectivity.sides_of(triangle)) {
      const auto face = connectivity.opposite_face_handle(side);
      *entry++ = face.is_valid() ? static_cast<std::uint32_t>(face.idx()) : kNoTriangle;
    }
  }
  return neighbours;
}

}  // namespace strata::mesh
