#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/atlas/unit_mesh.h"

namespace strata::mesh {

// Connected faces that lie in one plane and end at creases or rims. Examples are the sides of a
// cube and the cap of a cylinder. Faces of a curved surface are in no piece, even with small angles
// between them.
struct FlatPieces {
  static constexpr std::uint32_t kNone = 0xffffffffu;

  // number of the piece of each face, or kNone; empty if there are no pieces
  std::vector<std::uint32_t> of_face;
  // the faces of piece i are faces[begin[i]] up to faces[begin[i + 1]]
  std::vector<std::uint32_t> faces, begin;
  std::vector<glm::vec3> normals;  // of each piece

  std::size_t count() const { return normals.size(); }
  std::uint32_t piece_of(std::uint32_t face) const {
    return of_face.empty() ? kNone : of_face[face];
  }
  std::span<const std::uint32_t> faces_of(std::uint32_t piece) const {
    return {faces.data() + begin[piece], faces.data() + begin[piece + 1]};
  }
};

// Returns the pieces of at least two faces, ordered by area, largest first. `neighbours` is the
// result of `face_neighbours`.
FlatPieces find_flat_pieces(const UnitMesh& mesh, std::span<const std::uint32_t> neighbours,
                            const FaceFrames& frames);

}  // namespace strata::mesh
