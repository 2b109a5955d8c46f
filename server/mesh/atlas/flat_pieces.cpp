#include "mesh/atlas/flat_pieces.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mesh/surface/face_neighbours.h"

namespace strata::mesh {
namespace {

// The largest distance from the plane, as a share of the largest side of the mesh. It covers the
// rounding of float positions and of text files with few digits.
constexpr float kOffPlane = 1e-5f;
constexpr float kFlatCosine = 0.99999f;    // 0.26°: between the normals of faces of one piece
constexpr float kCreaseCosine = 0.99985f;  // 1°: to a face beyond the edge of the piece
constexpr float kMaxSmoothEdge = 0.25f;    // largest share of a piece's edge that is not a crease

class Finder {
 public:
  Finder(const UnitMesh& mesh, std::span<const std::uint32_t> neighbours, const FaceFrames& frames)
      : mesh_(mesh), neighbours_(neighbours), frames_(frames) {}

  FlatPieces find() {
    std::vector<std::uint32_t> seeds = faces_with_a_flat_edge();
    if (seeds.empty()) return {};
    // Large faces come first, because they have the most exact normals.
    std::stable_sort(seeds.begin(), seeds.end(),
                     [&](auto a, auto b) { return frames_.areas[a] > frames_.areas[b]; });
    of_face_.assign(mesh_.triangle_count(), FlatPieces::kNone);
    was_tried_.assign(mesh_.triangle_count(), 0);
    for (const auto seed : seeds)
      if (of_face_[seed] == FlatPieces::kNone && !was_tried_[seed]) collect(seed);
    return sorted();
  }

 private:
  struct Piece {
    std::vector<std::uint32_t> faces;
    glm::vec3 normal;
    double area = 0;
  };

  std::vector<std::uint32_t> faces_with_a_flat_edge() const {
    std::vector<std::uint32_t> faces;
    for (std::uint32_t face = 0; face < mesh_.triangle_count(); ++face)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t next = neighbours_[3 * std::size_t{face} + k];
        if (next == kNoTriangle ||
            glm::dot(frames_.normals[face], frames_.normals[next]) < kFlatCosine)
          continue;
        faces.push_back(face);
        break;
      }
    return faces;
  }

  // Makes a piece of the faces around `seed` in its plane if they end at creases.
  void collect(std::uint32_t seed) {
    const auto number = static_cast<std::uint32_t>(pieces_.size());
    Piece piece;
    piece.normal = frames_.normals[seed];
    const glm::vec3 origin = mesh_.corner(seed, 0);
    const auto lies_in_plane = [&](std::uint32_t face) {
      // The normal of a sliver is inexact, so only its corners are tested.
      const float cosine = glm::dot(frames_.normals[face], piece.normal);
      if (frames_.areas[face] > 0 && cosine < kFlatCosine) return false;
      for (int k = 0; k < 3; ++k)
        if (std::abs(glm::dot(mesh_.corner(face, k) - origin, piece.normal)) > kOffPlane)
          return false;
      return true;
    };
    piece.faces.push_back(seed);
    of_face_[seed] = number;
    for (std::size_t i = 0; i < piece.faces.size(); ++i) {
      piece.area += double{frames_.areas[piece.faces[i]]};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t next = neighbours_[3 * std::size_t{piece.faces[i]} + k];
        if (next == kNoTriangle || of_face_[next] != FlatPieces::kNone || !lies_in_plane(next))
          continue;
        of_face_[next] = number;
        piece.faces.push_back(next);
      }
    }
    if (piece.faces.size() > 1 && ends_at_creases(piece, number)) {
      pieces_.push_back(std::move(piece));
    } else {
      // Skips other seeds on this smooth surface, because their pieces would be almost the same.
      for (const auto face : piece.faces) of_face_[face] = FlatPieces::kNone, was_tried_[face] = 1;
    }
  }

  bool ends_at_creases(const Piece& piece, std::uint32_t number) const {
    double edge = 0, smooth = 0;
    for (const auto face : piece.faces)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t next = neighbours_[3 * std::size_t{face} + static_cast<std::size_t>(k)];
        if (next != kNoTriangle && of_face_[next] == number) continue;
        const double length = glm::length(mesh_.corner(face, (k + 1) % 3) - mesh_.corner(face, k));
        edge += length;
        if (next != kNoTriangle && glm::dot(frames_.normals[next], piece.normal) > kCreaseCosine)
          smooth += length;
      }
    return smooth <= kMaxSmoothEdge * edge;
  }

  FlatPieces sorted() {
    std::vector<std::uint32_t> order(pieces_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](auto a, auto b) { return pieces_[a].area > pieces_[b].area; });
    FlatPieces result;
    if (order.empty()) return result;
    result.of_face = std::move(of_face_);
    result.begin.push_back(0);
    for (const auto i : order) {
      for (const auto face : pieces_[i].faces)
        result.of_face[face] = static_cast<std::uint32_t>(result.count());
      result.faces.insert(result.faces.end(), pieces_[i].faces.begin(), pieces_[i].faces.end());
      result.begin.push_back(static_cast<std::uint32_t>(result.faces.size()));
      result.normals.push_back(pieces_[i].normal);
    }
    return result;
  }

  const UnitMesh& mesh_;
  std::span<const std::uint32_t> neighbours_;
  const FaceFrames& frames_;
  std::vector<std::uint32_t> of_face_;
  std::vector<std::uint8_t> was_tried_;
  std::vector<Piece> pieces_;
};

}  // namespace

FlatPieces find_flat_pieces(const UnitMesh& mesh, std::span<const std::uint32_t> neighbours,
                            const FaceFrames& frames) {
  return Finder(mesh, neighbours, frames).find();
}

}  // namespace strata::mesh
